"""The building on twelve days: patrols that always drive the same way, or each day another (`lanes`, `far_lanes`)."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from benchmarks.changes.days import day_by_day
from benchmarks.changes.places import read_events
from benchmarks.changes.recordings import Replayed, folder_of, make, replayed, timemap_json
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.scores import score
from benchmarks.changes.table import days_table, events_table, recordings_table
from benchmarks.changes.truth import Truth, building_truth
from benchmarks.changes.truth_json import from_json, to_json
from benchmarks.changes.visits import paces
from benchmarks.changes.worlds import building as world
from benchmarks.changes.worlds import clearance, lanes, patrols
from benchmarks.changes.worlds.clearance import Point
from benchmarks.changes.worlds.patrols import Patrol
from timemap_cli.results.reader import ResultReader

QUICK_DAYS = 6  # the door, the furniture and the pallet's coming
_LANES = (world, patrols, clearance, lanes)


def same_lanes(work: Work) -> str:
    """Figures of patrols that all go the same way."""
    return _measured(work, recordings_folder(work.folder), world.route)


def other_lanes(work: Work) -> str:
    """Figures of patrols that go another way each day."""
    return _measured(work, folder_of(work.folder, "lanes", _LANES), lanes.LANES.route)


def far_lanes(work: Work) -> str:
    """The same of ways that lie as far apart as there is room."""
    return _measured(work, folder_of(work.folder, "far_lanes", _LANES), lanes.FAR_LANES.route)


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
        nodes = len(reader.nodes)
        unknown = {level: unknown_share(reader, level) for level in reader.levels}
    parts = [recordings_table(truth.recordings) + f", {nodes} nodes, {replay.lost}"]
    try:
        document = timemap_json("changes", str(result))
    except RuntimeError as error:
        parts.append(f"no events: {error}")
    else:
        parts.append(events_table(score(read_events(document), truth, paces(result, planned))))
    days = [day_by_day(result, level, truth, nodes) for level in unknown]
    return "\n\n".join([*parts, days_table(days, unknown)])
