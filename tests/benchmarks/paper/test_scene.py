"""The simulated world: a laser off the robot's centre, hidden sectors, wrong poses, open space."""

import numpy as np
import pytest

from benchmarks.paper.rooms import OFFICE, OPEN_OFFICE, arc
from benchmarks.paper.scene import ANGLE_BINS, LASER, ROUND_ROOM, laser_poses, look, poses, truth
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN


def test_the_laser_is_a_fifth_of_a_metre_off_the_robots_centre():
    at = poses(50, np.random.default_rng(1))
    laser = laser_poses(at, LASER)
    assert np.hypot(*(laser - at)[:, :2].T) == pytest.approx(0.2)
    ahead = np.stack((np.cos(at[:, 2]), np.sin(at[:, 2])), axis=1)
    assert (laser - at)[:, :2] == pytest.approx(0.2 * ahead)


def test_a_round_room_is_seen_round_from_the_node():
    seen = look(ROUND_ROOM, 40, np.random.default_rng(2)).virtual()
    assert (seen != UNSEEN).mean() > 0.99
    assert np.abs(seen[seen != UNSEEN] / 1000 - 1.5).max() < 0.06
    assert np.std(seen[:, 7] / 1000.0) == pytest.approx(0.01, rel=0.4)


def test_truth_is_the_nearest_surface_of_each_angle_bin():
    assert truth(OFFICE)[0] == pytest.approx(2.9, abs=1e-3)
    assert truth(OFFICE)[90] == pytest.approx(2.2, abs=1e-3)
    assert truth(arc(20, 60))[30] == pytest.approx(1.0, abs=0.01)
    assert np.isinf(truth(arc(20, 60))[100])


def test_hidden_angle_bins_are_unseen_and_the_others_are_not():
    hidden = np.zeros(ANGLE_BINS, bool)
    hidden[100:140] = True
    seen = look(ROUND_ROOM, 40, np.random.default_rng(3)).hiding(hidden).virtual()
    assert (seen[:, 100:140] == UNSEEN).mean() > 0.97
    assert (seen[:, 200:] != UNSEEN).mean() > 0.95


def test_a_missing_wall_is_clear():
    seen = look(OPEN_OFFICE, 40, np.random.default_rng(4)).virtual()
    assert (seen[:, [0, 5, 355]] == CLEAR).mean() > 0.9


def test_a_wrong_pose_turns_what_the_node_learns():
    scans = look(OFFICE, 60, np.random.default_rng(5))
    turned = scans.misplaced(np.ones(60, bool), (0.0, 0.0, np.deg2rad(90.0))).virtual()
    assert np.median(turned[:, 90]) / 1000 == pytest.approx(2.9, abs=0.1)
    assert np.array_equal(scans.misplaced(np.zeros(60, bool), (1.0, 1.0, 1.0)).virtual(), scans.virtual())
