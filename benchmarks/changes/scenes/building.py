"""The building on twelve days: patrols that always drive the same way, or each day another (`lanes`, `far_lanes`)."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.changes.days import Days, day_by_day, judged
from benchmarks.changes.lasting import lasting
from benchmarks.changes.maps import MapScore, maps_of_day, walls_left
from benchmarks.changes.places import places_of_transitions, read_events
from benchmarks.changes.recordings import Replayed, folder_of, make, replayed, timemap_json
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.scores import score
from benchmarks.changes.table import days_table, events_table, maps_table, recordings_table
from benchmarks.changes.truth import Truth, building_truth
from benchmarks.changes.truth_json import from_json, to_json
from benchmarks.changes.visits import Pace, paces
from benchmarks.changes.worlds import building as world
from benchmarks.changes.worlds import clearance, lanes, patrols
from benchmarks.changes.worlds.clearance import Point
from benchmarks.changes.worlds.patrols import Patrol
from timemap_cli.results.reader import ResultReader

MAP_DAYS = (5, 8, 12)  # the day after the furniture was moved, that after the pallet went, and the last
QUICK_DAYS = 6  # the door, the furniture and the pallet's coming
_LANES = (world, patrols, clearance, lanes)


def same_lanes(work: Work) -> Iterator[str]:
    """Figures of patrols that all go the same way."""
    yield _measured(work, recordings_folder(work.folder), world.route)


def other_lanes(work: Work) -> Iterator[str]:
    """Figures of patrols that go another way each day."""
    yield _measured(work, folder_of(work.folder, "lanes", _LANES), lanes.LANES.route)


def far_lanes(work: Work) -> Iterator[str]:
    """The same of ways that lie as far apart as there is room."""
    yield _measured(work, folder_of(work.folder, "far_lanes", _LANES), lanes.FAR_LANES.route)


def recordings_folder(folder: Path) -> Path:
    """Where recordings of the patrols on the same lanes belong, made by the scripts as they are now."""
    return folder_of(folder, "building", (world, patrols, clearance))


def _measured(work: Work, made: Path, way: Callable[[int], list[Point]]) -> str:
    days = QUICK_DAYS if work.quick else world.DAYS
    planned = patrols.patrols(days, way)
    recordings = make(made, {one.file: one.drive() for one in planned})
    truth = made / f"truth_{days}.json"
    truth.write_text(to_json(building_truth(planned)), encoding="utf-8")
    result = replayed(recordings, made / f"days_{days}.timemap.mcap", again=work.again)
    return report(result, from_json(truth.read_text(encoding="utf-8")), planned)


def unknown_share(reader: ResultReader, level: str) -> float:
    """Share of all angle bins of all nodes of which a level knows nothing at the end."""
    known = sum(int(np.sum(~np.isnan(e.ranges))) for e in reader.estimates(level).values())
    return 1 - known / (len(reader.nodes) * reader.angle_bins)


def report(replay: Replayed, truth: Truth, planned: Sequence[Patrol]) -> str:
    """All figures of a result of patrols."""
    result = replay.result
    with ResultReader(result) as reader:
        nodes = [(node.x, node.y) for node in reader.nodes]
        unknown = {level: unknown_share(reader, level) for level in reader.levels}
    document, pace = timemap_json("changes", str(result)), paces(result, planned)
    left = {level: walls_left(result, document, level) for level in unknown}
    return "\n\n".join([
        recordings_table(truth.recordings) + f", {len(nodes)} nodes, {replay.lost}",
        events_table(score(read_events(document), truth, pace)),
        days_table(_days(result, truth, pace, nodes), unknown),
        maps_table(_maps(result, planned), left),
    ])  # fmt: skip


def _days(
    result: Path, truth: Truth, pace: Mapping[str, Pace], nodes: Sequence[tuple[float, float]]
) -> list[Days]:
    """Each level's differences from day to day; the slowest's once more with what lasts its half-life alone."""
    days = []
    for level in pace:
        told = day_by_day(result, level, truth, len(nodes))
        days.append(judged(told[0], level, truth, told[1]))
    lasts = lasting(places_of_transitions(truth), pace[level], nodes, world.walls(), truth.end_ns)
    return [*days, judged(told[0], level, truth, told[1], lasts)]


def _maps(result: Path, planned: Sequence[Patrol]) -> dict[int, dict[str, MapScore]]:
    """Each level's map at the end of some days."""
    drives = [one.drive() for one in planned]
    return {day: maps_of_day(result, drives, day) for day in MAP_DAYS if day <= len(drives)}
