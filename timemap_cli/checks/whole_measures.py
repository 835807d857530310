"""What differs of a result as a whole: settings, scans, nodes."""

from collections.abc import Iterator, Mapping

from timemap_cli.checks.matching import Matched
from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.tolerances import TOLERANCES
from timemap_cli.checks.verdict import Measure, Spot

_SHOWN = 5
_RARE = 0.005  # share of a kind of beam that may as well be twice or half of it
_KINDS = {"hit": "hits", "no_return": "missing returns", "invalid": "invalid", "too_close": "too close"}


def whole_measures(
    expected: Snapshot, found: Snapshot, nodes: Matched, allowed: Mapping[str, float]
) -> Iterator[Measure]:
    """The figures that belong to no level."""
    changed = changed_settings(expected.settings, found.settings)
    yield _measure(
        "settings.changed", len(changed), "; ".join(changed) or "the settings are the same", allowed
    )
    read, expected_read = found.scans.read, expected.scans.read
    yield _measure(
        "scans.read",
        abs(read - expected_read) / max(1, expected_read),
        f"{read} scans read, {expected_read} expected",
        allowed,
    )
    shares = [one.scans.used / max(1, one.scans.read) for one in (found, expected)]
    yield _measure(
        "scans.used",
        abs(shares[0] - shares[1]),
        f"{100 * shares[0]:.2f} % of the scans used{_dropped(found)}, {100 * shares[1]:.2f} % expected"
        f"{_dropped(expected)}",
        allowed,
    )
    yield from _beams(expected, found, allowed)
    for name, numbers, side, told in (
        ("nodes.missing", nodes.missing, expected, "are not there"),
        ("nodes.new", nodes.new, found, "are new"),
    ):
        spots = tuple(Spot(side.nodes[i].x, side.nodes[i].y, f"node {i}", (i,)) for i in numbers[:_SHOWN])
        text = f"{len(numbers)} of {len(side.nodes)} nodes {told}"
        yield _measure(name, len(numbers) / max(1, len(expected.nodes)), text, allowed, spots)


def _beams(expected: Snapshot, found: Snapshot, allowed: Mapping[str, float]) -> Iterator[Measure]:
    """The kind of beam whose share differs most in proportion, of the scan topics that both sides tell about."""
    told = [
        (
            abs(share - now.get(kind, 0.0)) / (max(share, now.get(kind, 0.0)) + _RARE),
            f"{100 * now.get(kind, 0.0):.2f} % of the beams of {topic} are {_KINDS.get(kind, kind)}, "
            f"{100 * share:.2f} % expected",
        )
        for topic, kinds in expected.beams.items()
        if (now := found.beams.get(topic)) is not None
        for kind, share in kinds.items()
    ]
    if told:
        value, text = max(told)
        yield _measure("beams.kinds", value, text, allowed)


def changed_settings(expected: Mapping[str, object], found: Mapping[str, object]) -> list[str]:
    """`levels.long.half_life 400obs instead of 200obs`, for each setting that differs.

    What one side alone has is a level that was added or removed, or a setting that the other version did not know:
    the latter stands at what was always done, or shows in the map.
    """
    names = [*expected, *(name for name in found if name not in expected)]
    names = [name for name in names if name.startswith("levels.") or (name in expected and name in found)]
    return [
        f"{name} {_shown(found, name)} instead of {_shown(expected, name)}"
        for name in names
        if found.get(name) != expected.get(name)
    ]


def _shown(settings: Mapping[str, object], name: str) -> str:
    return str(settings[name]) if name in settings else "nothing"


def _dropped(side: Snapshot) -> str:
    dropped = ", ".join(f"{reason} {count}" for reason, count in sorted(side.scans.dropped.items()))
    return f" ({dropped})" if dropped else ""


def _measure(
    name: str, value: float, text: str, allowed: Mapping[str, float], spots: tuple[Spot, ...] = ()
) -> Measure:
    return Measure(name, None, float(value), allowed[name], TOLERANCES[name].unit, text, spots)
