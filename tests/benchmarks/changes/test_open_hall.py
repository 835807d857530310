"""Open halls: what stands where, and what the laser sees of it."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.changes.truth import recorded, truth_of
from benchmarks.changes.worlds.clearance import clearance
from benchmarks.changes.worlds.open_hall import BETWEEN, LAYOUTS, MOVED, SCANNER, Hall, hall
from sample_logs.world import Thing, World, outline_segments

REACH_M = 10.0


def places(one: Hall) -> list[Thing]:
    """Every place of every piece that is moved."""
    return [t for t in one.things if np.isfinite(t.since) or np.isfinite(t.until)]


def beams_on(one: Hall, place: Thing, run: int) -> int:
    """How many beams of a coarse scanner, four times a second, would end 0.3 m earlier if a place were taken."""
    scanner = replace(SCANNER, beams=121, step_deg=2.0)
    world, motion = one.world(BETWEEN - 1 if run == 1 else BETWEEN + 1), one.motion(run)
    times = np.arange(0.3, motion.duration - 0.3, 0.25)
    origins, bearings = scanner.rays(motion.at(times)[:, None].repeat(scanner.beams, axis=1))
    others = [t for t in world.things if t.since <= 0 < t.until and t.name != place.name]
    now = np.zeros(len(times))
    free, taken = (
        World(world.walls, there).ranges(now, origins, bearings, REACH_M)
        for there in (others, [*others, Thing("taken", place.outline)])
    )
    return int(np.sum(taken + 0.3 < free))


@pytest.mark.parametrize("seed", LAYOUTS)
def test_seven_of_twelve_pieces_are_moved_once(seed):
    one = hall(seed)
    names = [t.name for t in one.things]
    assert len(set(names)) == 12
    assert sorted(names.count(name) for name in set(names)) == [1] * (12 - MOVED) + [2] * MOVED
    drives = one.drives()
    truth = truth_of([recorded(n, i, d) for i, (n, d) in enumerate(drives.items(), 1)], one.things)
    assert [change.kind for change in truth.changes] == ["moved"] * MOVED
    assert truth.recordings[0].end_ns < truth.changes[0].episodes[0].since_ns < truth.recordings[1].start_ns


@pytest.mark.parametrize("seed", LAYOUTS)
def test_the_laser_sees_every_place_taken_and_free(seed):
    one = hall(seed)
    for place in places(one):
        assert min(beams_on(one, place, run) for run in (1, 2)) > 60, place.name


@pytest.mark.parametrize("seed", LAYOUTS)
def test_both_ways_keep_clear_and_make_some_450_scans(seed):
    one = hall(seed)
    edges = np.concatenate([outline_segments(t.outline) for t in one.things])
    assert min(clearance(way, edges) for way in one.ways) > 0.4
    scans = sum((one.motion(run).duration - 0.6) / SCANNER.period for run in (1, 2))
    assert 430 < scans < 470


def test_a_layout_is_the_same_every_time_and_others_differ():
    first, again, other = hall(1), hall(1), hall(2)
    assert [t.outline.tolist() for t in first.things] == [t.outline.tolist() for t in again.things]
    assert [t.bounds for t in first.things] != [t.bounds for t in other.things]
