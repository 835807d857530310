"""Open halls, driven round and then across: what of the furniture that was moved in between is told."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.changes.days import compared, refusal
from benchmarks.changes.maps import levels_of, walls_left
from benchmarks.changes.places import Event, claims, places_of_changes, places_of_transitions, read_events
from benchmarks.changes.recordings import folder_of, make, replayed, timemap_json
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.scores import Found, find
from benchmarks.changes.table import claim_line, left_line
from benchmarks.changes.truth import Truth, recorded, truth_of
from benchmarks.changes.worlds import clearance, open_hall, patrols
from benchmarks.changes.worlds.open_hall import Hall
from timemap_cli.results.reader import ResultReader

QUICK_LAYOUTS = 2


@dataclass(frozen=True, slots=True)
class Told:
    """What one way of asking tells of one hall."""

    how: str
    found: Found
    compared: float | None  # share of all angle bins of all nodes

    @property
    def by_piece(self) -> list[int]:
        """Of each piece that was moved, how many of its two places are told."""
        pieces = dict.fromkeys(place.change.what for place in self.found.places)
        told = [place.change.what for place, _ in self.found.pairs]
        return [told.count(piece) for piece in pieces]


def open_halls(work: Work) -> Iterator[str]:
    """Figures of each layout, then of all together."""
    made = folder_of(work.folder, "hall", (open_hall, clearance, patrols))
    layouts = open_hall.LAYOUTS[: QUICK_LAYOUTS if work.quick else None]
    told = []
    for seed in layouts:
        head, here = _layout(open_hall.hall(seed), made / f"layout_{seed}", work)
        told.append(here)
        yield f"{head}\n{table(here)}"
    yield together(told)


def _layout(hall: Hall, made: Path, work: Work) -> tuple[str, list[Told | str]]:
    """A headline, and what is told by all ways of asking."""
    drives = hall.drives()
    recordings = make(made, drives)
    truth = truth_of([recorded(n, i, d) for i, (n, d) in enumerate(drives.items(), 1)], hall.things)
    both = replayed(recordings, made / "both.timemap.mcap", again=work.again)
    apart = [
        replayed([one], made / f"{one.name}.timemap.mcap", again=work.again).result for one in recordings
    ]
    told = [*_of_one_result(both.result, truth), *_of_two_results(apart, truth)]
    document = timemap_json("changes", str(both.result))
    left = {level: walls_left(both.result, document, level) for level in levels_of(both.result)}
    head = f"layout {hall.seed}, {_nodes(both.result, apart[0])}, {both.lost}"
    return f"{head}\n  {left_line(left)}", told


def _nodes(both: Path, first: Path) -> str:
    """How many nodes there are, and on how many of the first run's a scan was taken in the second, in words."""
    with ResultReader(first) as reader:
        before, end_ns = len(reader.nodes), reader.end_ns
    with ResultReader(both) as reader:
        nodes = len(reader.nodes)
        again = [e for e in reader.estimates(reader.levels[0]).values() if e.stamp_ns > end_ns]
    shared = sum(estimate.node < before for estimate in again)
    return f"{nodes} nodes, {shared} shared"


def _of_one_result(result: Path, truth: Truth) -> list[Told]:
    """By the events, and by comparing the ends of both runs at each level."""
    with ResultReader(result) as reader:
        nodes, levels = len(reader.nodes), reader.levels
    events = read_events(timemap_json("changes", str(result)))
    told = [Told("changes", find(claims(events), places_of_changes(truth), truth), None)]
    first, second = truth.recordings
    ends = ("--between", str(first.end_ns), str(second.end_ns))
    for level in levels:
        differences, share = compared(level, second, nodes, str(result), *ends)
        told.append(_judged(f"diff --between, {level}", differences, share, truth))
    return told


def _of_two_results(results: Sequence[Path], truth: Truth) -> list[Told | str]:
    """By comparing two results of one run each, or why that is refused."""
    with ResultReader(results[0]) as reader:
        nodes, levels = len(reader.nodes), reader.levels
    told: list[Told | str] = []
    for level in levels:
        how = f"diff of two results, {level}"
        try:
            differences, share = compared(level, truth.recordings[1], nodes, *map(str, results))
        except RuntimeError as error:
            told.append(f"{how}: {refusal(error)}")
        else:
            told.append(_judged(how, differences, share, truth))
    return told


def _judged(how: str, differences: Sequence[Event], share: float, truth: Truth) -> Told:
    return Told(how, find(claims(differences), places_of_transitions(truth), truth), share)


def table(told: Sequence[Told | str]) -> str:
    """A line for each way of asking, then every place that is missed and every other that is told."""
    lines = [f"  {'':28}{'pieces':>8}{'wholly':>8}{'places':>8}{'others':>8}{'compared':>10}"]
    for one in told:
        if isinstance(one, str):
            lines.append(f"  {one}")
            continue
        pieces, found = one.by_piece, one.found
        share = "-" if one.compared is None else f"{one.compared:.1%}"
        lines.append(
            f"  {one.how:28}{f'{sum(n > 0 for n in pieces)}/{len(pieces)}':>8}"
            f"{f'{pieces.count(2)}/{len(pieces)}':>8}{f'{len(found.match)}/{len(found.places)}':>8}"
            f"{len(found.false):>8}{share:>10}"
        )
    for one in told:
        if not isinstance(one, str):
            lines += [f"  {one.how}, other:{claim_line(c)}" for c in one.found.false]
    return "\n".join(lines)


def together(layouts: Sequence[Sequence[Told | str]]) -> str:
    """A line for each way of asking: pieces of all layouts that are told, the fewest of one, and others."""
    lines = [f"all layouts{'':19}{'pieces':>8}{'fewest':>8}{'wholly':>8}{'others':>8}{'most':>6}"]
    for column in zip(*layouts, strict=True):
        told = [one for one in column if isinstance(one, Told)]
        if len(told) < len(column):
            lines.append(f"  {next(one for one in column if isinstance(one, str))}")
            continue
        pieces = [sum(n > 0 for n in one.by_piece) for one in told]
        wholly = sum(one.by_piece.count(2) for one in told)
        others = [len(one.found.false) for one in told]
        lines.append(
            f"  {told[0].how:28}{sum(pieces):>8}{min(pieces):>8}{wholly:>8}{sum(others):>8}{max(others):>6}"
        )
    return "\n".join(lines)
