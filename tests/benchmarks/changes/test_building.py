"""The simulated building: what stands where on which day, and what the robot can see of it."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.changes.worlds.building import (
    DAYS,
    building,
    door_open,
    morning,
    route,
    things,
)
from benchmarks.changes.worlds.clearance import clearance
from benchmarks.changes.worlds.lanes import standing_on
from benchmarks.changes.worlds.patrols import SCANNER, patrols
from sample_logs.recorder import ScanEvent
from sample_logs.robot import Motion, compose
from sample_logs.world import World

NOON = 43200.0


def standing(day: int) -> list[str]:
    now = morning(day) + NOON
    return sorted(t.name for t in things() if t.since <= now < t.until)


def ranges(world: World, motion: Motion) -> np.ndarray:
    """What a coarse scanner sees, once a second."""
    scanner = replace(SCANNER, beams=136, step_deg=2.0)
    times = np.arange(0.5, motion.duration - 0.5, 1.0)
    poses = motion.at(times)[:, None].repeat(scanner.beams, axis=1)
    origins, bearings = scanner.rays(poses)
    return world.ranges(times, origins, bearings, 25.0)


def test_there_is_a_patrol_for_each_of_twelve_days():
    begins = [p.begins for p in patrols()]
    assert [int(b // 86400) for b in begins] == list(range(12))
    assert all(60.0 < p.motion.duration < 240.0 for p in patrols(DAYS))


def test_the_door_is_open_on_even_days_and_only_then():
    assert ["door" not in standing(day) for day in range(1, 13)] == [False, True] * 6


def test_the_pallet_stands_on_days_6_and_7_only():
    assert [day for day in range(1, 13) if "pallet" in standing(day)] == [6, 7]


def test_furniture_is_moved_in_the_night_before_day_4():
    def outlines(day: int) -> dict[str, tuple[float, ...]]:
        now = morning(day) + NOON
        there = [t for t in things() if t.since <= now < t.until and t.name not in ("door", "pallet")]
        return {t.name: t.bounds for t in there}

    days = [outlines(day) for day in range(1, 13)]
    assert all(day == days[0] for day in days[:3])
    assert all(day == days[3] for day in days[3:])
    assert sorted(days[0].keys() - days[3].keys()) == ["armchair"]
    assert sorted(days[3].keys() - days[0].keys()) == ["cabinet"]
    moved = [name for name in days[0].keys() & days[3].keys() if days[0][name] != days[3][name]]
    assert sorted(moved) == ["bin", "bookcase", "crates", "table", "trolley"]


@pytest.mark.parametrize("day", range(1, 9))
def test_the_route_stays_clear_of_all_that_stands_there(day):
    assert clearance(route(day), standing_on(day)) > 0.3


@pytest.mark.parametrize("day", [2, 6])
def test_the_robot_sees_everything_that_changes_in_the_rooms_it_visits(day):
    """Without the thing a good many beams would go on for another 0.3 m at least."""
    world, motion = building(morning(day) + NOON), patrols(day)[-1].motion
    seen = ranges(world, motion)
    changing = [t for t in world.things if (np.isfinite(t.since) or np.isfinite(t.until))]
    for thing in changing:
        if thing.since <= 0.0 < thing.until and (thing.name not in ("crates", "cabinet") or door_open(day)):
            without = replace(world, things=[t for t in world.things if t is not thing])
            assert np.sum(ranges(without, motion) > seen + 0.3) > 50, thing.name


@pytest.mark.parametrize(("day", "beyond"), [(1, False), (2, True)])
def test_only_an_open_door_lets_beams_into_the_store(day, beyond):
    before_it = np.array([[[13.0, 5.2]]])
    seen = building(morning(day) + NOON).ranges(np.zeros(1), before_it, np.full((1, 1), np.pi / 2), 25.0)
    assert (seen[0, 0] > 2.0) == beyond


def test_poses_are_off_by_some_centimetres_and_each_day_by_others():
    offsets = []
    for one in patrols(4):
        drive = one.drive()
        sent = [t for e in (*drive._localisation(), *drive._odometry()) for t in e.transforms]
        motions = [motion(sent, parent, drive.start_ns) for parent in ("map", "odom")]
        times = np.arange(1.0, drive.motion.duration - 1.0, 0.1)
        error = compose(*(m.at(times) for m in motions))[:, :2] - drive.motion.at(times)[:, :2]
        assert 0.015 < error.std(axis=0).max() < 0.05
        offsets.append(error.mean(axis=0))
    assert 0.01 < np.std(offsets, axis=0).max() < 0.06


def motion(sent, parent: str, start_ns: int) -> Motion:
    mine = [t for t in sent if t.parent == parent]
    yaw = np.unwrap([2 * np.arctan2(t.rotation[2], t.rotation[3]) for t in mine])
    times = np.array([t.stamp_ns - start_ns for t in mine]) / 1e9
    return Motion(times, np.column_stack([[t.translation[:2] for t in mine], yaw]))


def test_somebody_stands_in_a_room_for_16_s_on_every_day():
    for one in patrols():
        (colleague,) = [w for w in one.walks if w.name == "colleague"]
        stops = np.all(np.diff(colleague.positions, axis=0) == 0, axis=1)
        assert np.diff(colleague.times)[stops].sum() == pytest.approx(16.0)


def test_the_same_scans_come_out_every_time():
    def first() -> ScanEvent:
        return next(e for e in patrols(3)[2].drive().events() if isinstance(e, ScanEvent))

    assert first().ranges.tobytes() == first().ranges.tobytes()
