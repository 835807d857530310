import numpy as np
import pytest

from timemap_cli.logs.missing_returns import ENOUGH, MissingReturns, examine
from timemap_cli.model.sweeps import Sweeps

BEARINGS = np.radians(np.arange(-60.0, 61.0))


def along_a_wall(n_scans=30, x=2.0, step=0.02):
    """A scanner that looks along +x and drives along a wall at x = 2 m."""
    ranges = np.broadcast_to(x / np.cos(BEARINGS), (n_scans, len(BEARINGS))).astype(np.float32)
    poses = np.zeros((n_scans, 3, 4))
    poses[:, :, :3] = np.eye(3)
    poses[:, 1, 3] = np.arange(n_scans) * step
    return ranges.copy(), poses


def sweeps(ranges, poses, clear_range=30.0):
    stamps = np.arange(len(ranges), dtype=np.int64)
    return Sweeps(stamps, ranges, BEARINGS, clear_range, poses, poses, 0)


def test_missing_returns_through_a_wall_are_no_evidence():
    ranges, poses = along_a_wall()
    ranges[::3, 40:80] = np.inf
    found = examine([sweeps(ranges, poses)], 10.0)
    assert found.beams == 10 * 40
    assert found.contradicted > 0.9
    assert not found.are_clear


def test_missing_returns_beside_a_wall_are_clear():
    ranges, poses = along_a_wall()
    ranges[:, 60:] = np.inf
    assert examine([sweeps(ranges, poses)], 10.0).contradicted < 0.15


def test_a_wall_beyond_the_radius_contradicts_nothing():
    ranges, poses = along_a_wall()
    ranges[::3, 40:80] = np.inf
    found = examine([sweeps(ranges, poses)], 1.5)
    assert found == MissingReturns(400, 0.0)
    assert found.are_clear


def test_a_wall_beyond_the_clear_range_contradicts_nothing():
    ranges, poses = along_a_wall()
    ranges[::3, 40:80] = np.inf
    assert examine([sweeps(ranges, poses, clear_range=1.5)], 10.0).contradicted == 0.0


def test_something_that_other_beams_pass_more_often_is_not_solid():
    """Somebody stood there in five of thirty scans."""
    ranges, poses = along_a_wall(x=4.0)
    ranges[:5] = along_a_wall(n_scans=5, x=2.0)[0]
    ranges[20:, 40:80] = np.inf
    assert examine([sweeps(ranges, poses)], 3.0).contradicted < 0.1


def test_the_answer_does_not_depend_on_how_scans_are_cut_into_blocks():
    ranges, poses = along_a_wall()
    ranges[::3, 40:80] = np.inf
    whole = examine([sweeps(ranges, poses)], 10.0)
    parts = [sweeps(ranges[i : i + 7], poses[i : i + 7]) for i in range(0, 30, 7)]
    assert examine(parts, 10.0) == whole


@pytest.mark.parametrize("turn", [0.0, 1.0, 2.5])
@pytest.mark.parametrize("shift", [0.0, -777.0])
def test_the_answer_is_the_same_wherever_the_building_lies(turn, shift):
    ranges, poses = along_a_wall()
    ranges[::3, 40:80] = np.inf
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    moved = rotation @ poses
    moved[:, :2, 3] += shift
    assert examine([sweeps(ranges, moved)], 10.0).contradicted > 0.7


def test_too_few_missing_returns_say_nothing():
    ranges, poses = along_a_wall()
    ranges[0, : ENOUGH - 1] = np.inf
    found = examine([sweeps(ranges, poses)], 10.0)
    assert found == MissingReturns(ENOUGH - 1, None)
    assert found.are_clear


def test_no_scan_at_all_says_nothing():
    assert examine([], 10.0) == MissingReturns(0, None)
