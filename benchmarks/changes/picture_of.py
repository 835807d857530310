"""What `draw` shows of a world on one day."""

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.changes.truth import TrueChange, building_truth, recorded, truth_of
from benchmarks.changes.worlds import building, pallet_hall
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
WORLDS = (*_WAYS, *(f"hall{seed}" for seed in LAYOUTS), *pallet_hall.WORLDS)


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
        drives, changes = [one.drive() for one in planned], building_truth(planned).changes
    elif world in pallet_hall.WORLDS:
        drives, changes = list(pallet_hall.drives(world).values()), ()
    else:
        layout = hall(int(world.removeprefix("hall")))
        runs = layout.drives()
        drives = list(runs.values())
        known = [recorded(name, run, one) for run, (name, one) in enumerate(runs.items(), 1)]
        changes = truth_of(known, layout.things).changes
    drive = drives[day - 1]
    return Picture(f"{world}: all changes, and the scans of day {day}", drive, changes)
