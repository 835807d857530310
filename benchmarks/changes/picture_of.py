"""What `draw` shows of a world on one day."""

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.changes.truth import TrueChange, building_truth, recorded, truth_of
from benchmarks.changes.worlds import building
from benchmarks.changes.worlds.clearance import Point
from benchmarks.changes.worlds.lanes import FAR_LANES, LANES
from benchmarks.changes.worlds.open_hall import LAYOUTS, hall
from benchmarks.changes.worlds.patrols import patrols
from sample_logs.drives import Drive

_WAYS: dict[str, Callable[[int], list[Point]]] = {
    "building": building.route,
    "lanes": LANES.route,
    "far_lanes": FAR_LANES.route,
}
WORLDS = (*_WAYS, *(f"hall{seed}" for seed in LAYOUTS))


@dataclass(frozen=True, slots=True)
class Picture:
    """One recording, and the changes of all of its world."""

    title: str
    drive: Drive
    changes: tuple[TrueChange, ...]


def picture_of(world: str, day: int) -> Picture:
    """The picture of one of `WORLDS`; IndexError where it has no such day."""
    if world in _WAYS:
        planned = patrols(way=_WAYS[world])
        drive, truth = planned[day - 1].drive(), building_truth(planned)
    else:
        layout = hall(int(world.removeprefix("hall")))
        drives = layout.drives()
        drive = list(drives.values())[day - 1]
        truth = truth_of([recorded(n, i, d) for i, (n, d) in enumerate(drives.items(), 1)], layout.things)
    return Picture(f"{world}: all changes, and the scans of day {day}", drive, truth.changes)
