"""Experiments: a robot that is lost, one that is parked, and a world that has changed altogether."""

import numpy as np
import pytest

from tests.model.drives import GATE, OPEN_GATE, as_bytes
from tests.model.scenes import ROOM, cast, fan, pillar, pose, rectangle, seen_from, sweeps
from timemap_cli.model.estimator import estimate
from timemap_cli.model.guard import Guard
from timemap_cli.model.learner import Learner
from timemap_cli.model.levels import Level
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observer
from timemap_cli.model.schedule import Period, Schedule
from timemap_cli.model.time_map import TimeMap

LEVELS = (Level("short", 7, 5.0), Level("mid", 25, 20.0), Level("long", 50, 60.0))
NODES = (Node(0.9, 0.5), Node(-0.9, 0.5))
BINS, RADIUS = 72, 5.0
REBUILT = rectangle(-2.3, -1.7, 2.3, 2.7)  # another room at the same place
BEARINGS = fan(121, 240)
SCANS = 120  # of one patrol
ON, OFF = 0.75, 1.0


def patrol(room, number, wrong=None, *, moving=True):
    """Two rounds, an hour after the last patrol; `wrong` (SCANS, 3) is added to the poses: x, y [m], yaw [rad]."""
    noise = np.random.default_rng(number)
    angle = np.linspace(0, 4 * np.pi, SCANS) * moving
    true = np.column_stack((0.9 * np.cos(angle), 0.5 + 0.8 * np.sin(angle), angle + np.pi / 2))
    ranges = [cast(room, x, y, yaw + BEARINGS) + noise.normal(0, 0.01, 121) for x, y, yaw in true]
    believed = true if wrong is None else true + wrong
    stamps_ns = number * 3600 * 10**9 + np.arange(SCANS) * 250_000_000
    return sweeps(ranges, BEARINGS, [pose(*place) for place in believed], stamps_ns=stamps_ns)


def wandering():
    """Poses of a robot whose localisation strays: half a metre and 20 degrees, as far wrong as it gets."""
    way = np.linspace(0, 6 * np.pi, SCANS)
    return np.column_stack((0.5 * np.sin(way + 1), 0.5 * np.cos(way), np.radians(20) * np.sin(0.7 * way + 1)))


def offset():
    return np.tile((0.6, -0.5, np.radians(15)), (SCANS, 1))


def learn(patrols, max_contradiction, *, block=SCANS, gate=GATE):
    """Newest estimates by level and node, and how many scans each patrol had set aside and observed."""
    looking = Observer(gate, angle_bins=BINS, radius=RADIUS, spacing=2.0, nodes=NODES)
    time_map = TimeMap(LEVELS, lambda memory: estimate(memory, 0.1), angle_bins=BINS, nodes=NODES)
    guard = Guard(max_contradiction, angle_bins=BINS, radius=RADIUS, window=LEVELS[-1].window)
    learner = Learner(time_map, guard, Schedule(Period(10 * 10**9, in_scans=False)))
    latest, counts = {}, []
    for scans in patrols:
        lost = observed = 0
        for start in range(0, SCANS, block):
            seen = looking.observe(scans.rows(slice(start, start + block)))
            learnt = [learner.take(seen)]
            if start + block >= SCANS:
                learnt.append(learner.take(None))
            for each in learnt:
                latest |= {
                    (found.level, found.node): found for made in each.rounds for found in made.estimates
                }
            lost, observed = lost + sum(each.lost for each in learnt), observed + len(seen)
        counts.append((lost, observed))
    return latest, counts


def wrong_share(latest, level, room):
    """Share of the angle bins where the estimate is more than 0.2 m beside the room's walls."""
    wrong = []
    for node, place in enumerate(NODES):
        true, ranges = seen_from(room, place.x, place.y, BINS), latest[level, node].ranges
        seen = np.isfinite(ranges) & (true[:, 1] < RADIUS)
        wrong.append(np.maximum(true[:, 0] - ranges, ranges - true[:, 1])[seen] > 0.2)
    return float(np.concatenate(wrong).mean())


HISTORY = [patrol(ROOM, number) for number in range(4)]


def test_while_nothing_is_wrong_nothing_is_set_aside():
    assert [lost for lost, _ in learn(HISTORY, ON)[1]] == [0] * 4


@pytest.mark.parametrize("wrong", [wandering(), offset()], ids=["wandering", "offset"])
def test_what_a_lost_robot_says_is_counted_and_not_learnt(wrong):
    drives = [*HISTORY, patrol(ROOM, 4, wrong)]
    (guarded, counts), (unguarded, _) = learn(drives, ON), learn(drives, OFF)
    lost, observed = counts[-1]
    assert lost > 0.6 * observed
    for level in ("mid", "long"):
        assert wrong_share(guarded, level, ROOM) < 0.15
    assert wrong_share(unguarded, "mid", ROOM) > 0.25


def test_a_robot_that_found_itself_again_is_learnt_from_at_once():
    counts = learn([*HISTORY, patrol(ROOM, 4, offset()), patrol(ROOM, 5)], ON)[1]
    assert counts[-2][0] > 0
    assert counts[-1][0] == 0


def test_a_changed_world_is_learnt_if_later():
    """Two nodes, all that there are, tell too little to call the robot lost; whatever the first patrol makes of it."""
    rebuilt = [patrol(REBUILT, number) for number in range(4, 9)]
    latest, counts = learn([*HISTORY, *rebuilt], ON)
    later = [lost / observed for lost, observed in counts[5:]]
    assert max(later) < 0.05
    for level in ("short", "mid", "long"):
        assert wrong_share(latest, level, REBUILT) < 0.05


def test_a_robot_parked_for_a_night_where_it_is_lost_is_not_believed():
    night = [patrol(ROOM, number, offset(), moving=False) for number in range(4, 8)]
    latest, counts = learn([*HISTORY, *night], ON)
    assert all(lost == observed > 0 for lost, observed in counts[4:])
    assert wrong_share(latest, "short", ROOM) < 0.1


def test_a_robot_parked_for_a_night_does_not_wash_out_the_slow_levels():
    """Something stands beside it until the morning."""
    room = np.concatenate((ROOM, pillar(1.9, 0.5, 0.8)))
    night = [patrol(room, number, moving=False) for number in range(4, 8)]
    gated, free = (learn([*HISTORY, *night], ON, gate=gate)[0] for gate in (GATE, OPEN_GATE))
    for level in ("mid", "long"):
        assert wrong_share(gated, level, ROOM) < 0.02
        assert wrong_share(free, level, ROOM) > 0.1


@pytest.mark.parametrize("block", [1, 7, 64])
def test_blocks_do_not_matter(block):
    drives = [*HISTORY, patrol(ROOM, 4, offset()), patrol(REBUILT, 5), patrol(REBUILT, 6)]
    (whole, counts), (cut, cut_counts) = learn(drives, ON), learn(drives, ON, block=block)
    assert cut_counts == counts
    assert as_bytes(cut) == as_bytes(whole)
