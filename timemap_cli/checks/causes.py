"""What probably made the difference, told from which figures are out of tolerance together."""

from collections.abc import Iterator, Sequence

from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.verdict import Measure
from timemap_cli.checks.whole_measures import changed_settings


def likely_causes(expected: Snapshot, found: Snapshot, failures: Sequence[Measure]) -> Iterator[str]:
    """Sentences, the likeliest cause first; none where nothing failed."""
    failed: dict[str, Measure] = {}
    for one in failures:  # the worst level of each
        failed.setdefault(one.name, one)
    if not failed:
        return
    for setting in changed_settings(expected.settings, found.settings):
        yield f"a setting was changed: {setting}"
    if None is not expected.laid is not found.laid is not None:
        known, laid = ("baseline", "result") if found.laid else ("result", "baseline")
        yield f"the nodes of the {known} were known from the start, those of the {laid} were made on the way"
    if expected.no_return != found.no_return:
        yield f"a missing return means '{found.no_return}' now and meant '{expected.no_return}': {_NO_RETURN}"
    if beams := failed.get("beams.kinds"):
        yield f"{beams.text}: the driver, or the code that it writes for a missing return"
    if "scans.read" in failed:
        change = found.scans.read / max(1, expected.scans.read) - 1
        which = "fewer" if change < 0 else "more"
        yield f"{100 * abs(change):.1f} % {which} scans: a part of a recording, or single scans of it"
    yield from _geometry(failed)
    if "scans.used" in failed:
        yield f"another share of the scans is dropped: {_dropped(expected, found)}"
    yield from different_inputs(expected, found)


_NO_RETURN = "input.no_return, or the code that the driver writes for one"


def different_inputs(expected: Snapshot, found: Snapshot) -> Iterator[str]:
    """What is another recording than the baseline's."""
    known = {one.name: one.sha256 for one in expected.inputs}
    now = {one.name: one.sha256 for one in found.inputs}
    others = [name for name, digest in now.items() if name in known and known[name] != digest]
    if others:
        yield f"other recordings of the same name: {', '.join(others)}"
    if missing := [name for name in known if name not in now]:
        yield f"recordings that are not replayed: {', '.join(missing)}"
    if new := [name for name in now if name not in known]:
        yield f"recordings that the baseline does not know: {', '.join(new)}"


def _geometry(failed: dict[str, Measure]) -> Iterator[str]:
    if turn := failed.get("map.turn"):
        yield f"the map is turned ({turn.text}): {turn.cause}"
    if shift := failed.get("map.shift"):
        yield f"the map is shifted ({shift.text}): the localisation, or where the map frame lies"
    if "nodes.shift" in failed and "nodes.turn" in failed:
        yield (
            "scans lie differently depending on how the robot moved: the stamps of scans and poses do not fit "
            "together (a delay of either), or the localisation is worse"
        )
    elif "nodes.shift" in failed:
        yield "scans lie differently depending on where the robot looked: the laser's place on the robot"
    elif "nodes.turn" in failed:
        yield "single nodes are turned: the localisation's heading, or a delay while turning"
    if (
        not {"map.turn", "map.shift", "nodes.shift", "nodes.turn"} & failed.keys()
        and "ranges.places" in failed
    ):
        spot = failed["ranges.places"].spots[0]
        yield f"something stands elsewhere around {spot.x:.2f}, {spot.y:.2f}: {spot.text}"


def _dropped(expected: Snapshot, found: Snapshot) -> str:
    """Counts of the reasons that changed; counts that are the same are another share of more or fewer scans."""
    was, now = expected.scans, found.scans
    told = [
        f"{reason} {now.dropped.get(reason, 0)} instead of {was.dropped.get(reason, 0)}"
        for reason in sorted({**was.dropped, **now.dropped})
        if now.dropped.get(reason, 0) != was.dropped.get(reason, 0)
    ]
    return (
        ", ".join(told)
        or f"{now.read - now.used} of {now.read} instead of {was.read - was.used} of {was.read}"
    )
