"""Standard deviations of poses from covariances, which of them are believed, and what is set aside."""

import numpy as np
import pytest

from tests.logs.making import ns, poses
from timemap_cli.logs.batches import PoseBatch
from timemap_cli.logs.pose_quality import (
    NO_LIMITS,
    Deviations,
    PoseLimits,
    PoseQuality,
    report,
    standard_deviations,
)

NAN = np.nan


def covariance(xx=0.0, yy=0.0, yaw=0.0, xy=0.0):
    """(1, 6, 6)"""
    found = np.zeros((1, 6, 6))
    found[0, [0, 1, 5], [0, 1, 5]] = xx, yy, yaw
    found[0, 0, 1] = found[0, 1, 0] = xy
    return found


def stated(seconds, stds, yaw_std=0.1):
    """Poses at the times, with the standard deviations of x and y."""
    made = poses("/amcl_pose", "map", seconds, [[0, 0, 0]])
    found = np.concatenate([covariance(std**2, std**2, yaw_std**2) for std in stds])
    return PoseBatch(
        made.topic, "map", None, made.stamps_ns, made.log_ns, made.translation, made.rotation, found
    )


def held(*batches):
    made = Deviations()
    for batch in batches:
        made.add(batch)
    return made


def position(deviations, seconds):
    return deviations.at(ns(seconds))[0].round(6).tolist()


def test_the_standard_deviation_is_the_root_of_the_variance():
    assert standard_deviations(covariance(0.25, 0.04, 0.01)).tolist() == [[0.5, 0.1]]


def test_the_worst_direction_counts():
    """An ellipse of 0.5 m by 0.1 m at 45 degrees: variances 0.13 and 0.13 along the axes."""
    np.testing.assert_allclose(standard_deviations(covariance(0.13, 0.13, 0.01, xy=0.12)), [[0.5, 0.1]])


@pytest.mark.parametrize(
    "silent",
    [
        covariance(),
        covariance(-1, 0.1, 0.1),
        covariance(0.1, -0.1, 0.1),
        covariance(0.1, 0.1, -1),
        covariance(NAN, 0.1, 0.1),
        covariance(0.1, 0.1, NAN),
    ],
)
def test_a_covariance_that_says_nothing_is_unknown(silent):
    assert np.isnan(standard_deviations(silent)).all()


@pytest.mark.parametrize("variance", [1e9, np.finfo(float).max])
def test_a_huge_covariance_is_huge(variance):
    assert (standard_deviations(covariance(variance, variance, 1.0))[:, 0] > 1000).all()


def test_between_two_poses_the_larger_deviation_holds():
    deviations = held(stated([1, 2, 3], [0.1, 0.3, 0.2]))
    assert position(deviations, [1, 1.5, 2, 2.5, 3]) == [0.1, 0.3, 0.3, 0.3, 0.2]


def test_before_the_first_pose_nothing_is_known_and_after_the_last_its_own_holds():
    """A localiser that stands still sends nothing."""
    assert position(held(stated([1, 2], [0.1, 0.3])), [500]) == [0.3]
    assert np.isnan(position(held(stated([1, 2], [0.1, 0.3])), [0.5])).all()
    assert np.isnan(held().at(ns([1]))).all()


def test_across_a_gap_of_more_than_10_s_the_older_pose_holds_alone():
    deviations = held(stated([0, 10, 20.5], [0.1, 0.2, 0.9]))
    assert position(deviations, [5, 15]) == [0.2, 0.2]


def test_a_pose_of_which_nothing_is_known_leaves_its_neighbours_word():
    assert position(held(stated([0, 1, 2], [0.1, 0.0, 0.3], 0.0)), [0.5, 1.5]) == [0.1, 0.3]


def test_the_order_of_arrival_does_not_matter_and_of_equal_stamps_the_last_received_counts():
    deviations = held(stated([3, 4], [0.3, 0.4]), stated([1, 2], [0.1, 0.2]), stated([3], [0.5]))
    assert position(deviations, [1, 2, 3, 4]) == [0.1, 0.2, 0.5, 0.4]


def test_forgetting_keeps_what_later_stamps_need():
    deviations = held(stated(range(10), np.arange(1, 11) / 10))
    deviations.forget(int(ns(5.5)[0]))
    assert position(deviations, [5.5, 6, 9]) == [0.7, 0.7, 1.0]
    deviations.forget_all_but(int(ns(2)[0]))
    assert position(deviations, [7, 8]) == [0.8, 0.9]


def test_poses_without_a_covariance_say_nothing():
    assert np.isnan(position(held(poses("/pose", "map", [0, 1], [[0, 0, 0]])), [0.5])).all()


QUALITY = PoseQuality(
    position_std=np.array([0.1, 0.6, NAN, 0.5, 0.6]),
    yaw_std=np.array([0.1, 0.1, NAN, 0.4, 0.1]),
    jump=np.array([0.0, 0.0, 0.7, 0.5, 0.7]),
)


def set_aside(**limits):
    return {reason: rows.tolist() for reason, rows in PoseLimits(**limits).set_aside(QUALITY).items()}


def test_what_exceeds_a_limit_is_set_aside_for_one_reason_and_what_is_unknown_is_believed():
    assert set_aside(position_std=0.5, yaw_std=0.3, jump=0.5) == {
        "uncertain_pose": [False, True, False, True, True],
        "pose_jump": [False, False, True, False, False],
    }


def test_a_limit_of_zero_is_none():
    assert set_aside() == {"uncertain_pose": [False] * 5, "pose_jump": [False] * 5}
    assert set_aside(jump=0.5)["pose_jump"] == [False, False, True, False, True]
    assert PoseLimits() == NO_LIMITS


def test_a_report_has_the_largest_deviations_and_the_jumps():
    found = report(ns([3, 4, 5, 1, 2]), QUALITY, PoseLimits(0.5, 0.0, 0.6), "/amcl_pose")
    assert (found.position_std, found.yaw_std, found.covariances) == (0.6, 0.4, "/amcl_pose")
    assert (found.jumps, found.largest_jump, found.largest_jump_ns) == (2, 0.7, ns(2)[0])
    assert found.set_aside == {"uncertain_pose": 2, "pose_jump": 1}


def test_neighbouring_scans_within_a_jump_tell_of_one_jump():
    calm = PoseQuality(np.full(5, NAN), np.full(5, NAN), np.array([0, 0.6, 0.9, 0.6, 0]))
    found = report(ns(range(5)), calm, PoseLimits(jump=0.5), None)
    assert (found.jumps, found.largest_jump, found.largest_jump_ns) == (1, 0.9, ns(2)[0])
    assert (found.position_std, found.yaw_std) == (None, None)


def test_poses_that_do_not_jump_tell_of_none():
    calm = PoseQuality(np.full(2, 0.1), np.full(2, 0.1), np.full(2, 0.2))
    found = report(ns([0, 1]), calm, PoseLimits(0.5, 0.3, 0.5), None)
    assert (found.jumps, found.largest_jump, found.set_aside) == (
        0,
        0.0,
        {"uncertain_pose": 0, "pose_jump": 0},
    )


def test_what_is_kept_for_a_later_replay_says_the_same():
    deviations, resumed = held(stated([1, 2, 3], [0.1, 0.3, 0.2])), Deviations()
    resumed.restore(deviations.kept())
    resumed.add(stated([4], [0.4]))
    assert position(resumed, [1.5, 3.5]) == [0.3, 0.4]
