import numpy as np
import pytest

from timemap_cli.logs.irregularities import duration, pose_problems, time_problems


def times(seconds):
    return np.rint(np.asarray(seconds) * 1e9).astype(np.int64)


STEADY = np.arange(100.0, 110.0, 0.1)


def standing(n):
    poses = np.zeros((n, 3, 4))
    poses[:, :, :3] = np.eye(3)
    return poses


def test_steady_scans_have_no_problem():
    assert time_problems("/scan", times(STEADY), times(STEADY + 0.05)) == []
    assert time_problems("/scan", times([]), times([])) == []
    assert time_problems("/scan", times([1.0]), times([1.0])) == []


def test_stamps_that_step_back_are_told_with_the_largest_step():
    stamps = STEADY.copy()
    stamps[50:] -= 0.96
    assert time_problems("/scan", times(stamps), times(STEADY)) == [
        "/scan: stamps step back once, by up to 0.86 s"
    ]


def test_equal_stamps_are_told():
    stamps = STEADY.copy()
    stamps[10] = stamps[9]
    assert time_problems("/scan", times(stamps), times(STEADY)) == [
        "/scan: 1 scan with the stamp of the one before"
    ]


def test_gaps_are_told():
    stamps = np.concatenate([STEADY, STEADY + 30])
    assert time_problems("/scan", times(stamps), times(stamps)) == [
        "/scan: 1 gap without scans, up to 20.1 s"
    ]


def test_a_slow_scanner_has_no_gaps():
    stamps = np.arange(0.0, 100.0, 3.3) + 1
    assert time_problems("/scan", times(stamps), times(stamps)) == []


def test_log_times_far_from_the_stamps_are_told():
    (problem,) = time_problems("/scan", times(STEADY), times(STEADY + 54.3 * 365.25 * 86400))
    assert problem == "/scan: recorded 54.3 years after the stamps (other clock, or played back)"


def test_a_clock_that_is_set_during_the_recording_is_told():
    logged = STEADY.copy()
    logged[60:] += 5.0
    (problem,) = time_problems("/scan", times(STEADY), times(logged))
    assert problem == "/scan: stamps and log times drift apart once, by up to 5.0 s at once"


def test_scans_without_a_stamp_are_told():
    assert "/scan: 2 scans without a stamp" in time_problems("/scan", times([0, 0, 1.0]), times([1, 2, 3.0]))


def test_a_jump_of_the_pose_is_told():
    poses = standing(len(STEADY))
    poses[40:, 0, 3] = 0.4
    assert pose_problems("/scan", times(STEADY), poses) == [
        "/scan: the pose jumps once, namely at +4.0 s by 0.40 m and 0 deg within 0.10 s"
    ]


def test_a_turn_on_the_spot_is_no_jump_even_over_the_seam():
    poses = standing(len(STEADY))
    yaw = np.linspace(0, 12, len(STEADY))
    poses[:, 0, 0] = poses[:, 1, 1] = np.cos(yaw)
    poses[:, 1, 0] = np.sin(yaw)
    poses[:, 0, 1] = -np.sin(yaw)
    assert pose_problems("/scan", times(STEADY), poses) == []


def test_no_poses_have_no_jumps():
    assert pose_problems("/scan", times([]), np.empty((0, 3, 4))) == []


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.86, "0.86 s"),
        (63.94, "63.9 s"),
        (134.8, "2 min 15 s"),
        (119.7, "2 min 0 s"),
        (2650.9, "44 min 11 s"),
        (7200, "2 h 0 min"),
        (4 * 86400 + 3 * 3600, "99 h 0 min"),
        (20 * 86400, "20 days 0 h"),
    ],
)
def test_durations_read_as_one_says_them(seconds, text):
    assert duration(seconds) == text
