"""Jumps between neighbouring transforms: corrections of a localiser, and steps that no robot can make."""

import numpy as np
import pytest

from tests.logs.making import ns, tf, yaw
from timemap_cli.logs.jumps import jumps
from timemap_cli.logs.transforms import TransformBuffer


def jump(batches, first, last=None, target="map", source="base"):
    held = TransformBuffer()
    for batch in batches:
        held.add(batch)
    return jumps(held, target, source, ns(first), ns(first if last is None else last)).round(6).tolist()


def corrected(shift, turn_deg=0.0, odom=(0.0, 0.0)):
    """map -> odom at 0, 1, 2 and 3 s, corrected after 1 s; the robot drives 2 m/s in odom from a place on."""
    moved = [[0, 0, 0], [0, 0, 0], [*shift, 0], [*shift, 0]]
    driven = [[odom[0] + 2 * at, odom[1], 0] for at in range(4)]
    return [
        tf("map", "odom", range(4), moved, yaw([0, 0, turn_deg, turn_deg])),
        tf("odom", "base", range(4), driven),
    ]


def test_a_correction_counts_between_the_two_transforms_alone():
    assert jump(corrected((0.3, 0.4)), [0.5, 1, 1.5, 1.999, 2, 2.5]) == [0, 0, 0.5, 0.5, 0, 0]


def test_a_turn_counts_as_it_moves_what_stands_two_metres_away():
    """By a chord of 60 degrees; the robot stands at the origin of odom."""
    standing = [corrected((0, 0), 60.0)[0], tf("odom", "base", range(4), [[0, 0, 0]])]
    assert jump(standing, [1.5]) == [2.0]


def test_a_correction_counts_where_the_robot_is_and_not_at_the_origin_of_odom():
    """Turned by 90 degrees about the robot at (10, 0): the origin of odom moves 14 m, the robot does not move."""
    turned = [
        tf("map", "odom", [0, 1], [[0, 0, 0], [10, -10, 0]], yaw([0, 90])),
        tf("odom", "base", [0, 1], [[10, 0, 0], [10, 0, 0]]),
    ]
    assert jump(turned, [0.5]) == [round(2 * np.sqrt(2), 6)]


@pytest.mark.parametrize(("step", "expected"), [(0.29, 0.0), (1.3, 1.0)])
def test_what_carries_the_robot_jumps_by_what_no_robot_moves(step, expected):
    """3 m/s for 0.1 s are 0.3 m."""
    assert jump([tf("map", "base", [0, 0.1], [[0, 0, 0], [step, 0, 0]])], [0.05]) == [expected]


def test_a_robot_may_turn_by_6_3_rad_a_second():
    assert jump([tf("map", "base", [0, 0.1], [[0, 0, 0]], yaw([0, 35]))], [0.05]) == [0.0]
    over = jump([tf("map", "base", [0, 0.1], [[0, 0, 0]], yaw([0, 90]))], [0.05])
    assert over == [round(2 * (np.sqrt(2) - 0.63), 6)]


def test_the_time_from_the_first_beam_to_the_last_counts():
    batches = corrected((0.3, 0.4))
    assert jump(batches, [0.5, 1, 2, 0.2, 0.2], [1.5, 2, 3, 0.9, 2.8]) == [0.5, 0.5, 0, 0, 0.5]


def test_beyond_the_last_transform_nothing_jumps():
    assert jump(corrected((0.3, 0.4)), [3.0], [3.5]) == [0.0]


def test_a_change_of_parent_is_no_jump():
    """tf2 does not interpolate across it either."""
    batches = [tf("map", "base", [0, 2], [[0, 0, 0]]), tf("other", "base", [1], [[5, 5, 0]])]
    assert jump(batches, [0.5]) == [0.0]


def test_wheels_that_spin_are_no_jump():
    wheel = tf("base", "wheel", [0, 3], [[0, 0, 0]], yaw([0, 180]))
    assert jump([*corrected((0, 0)), wheel], [0.5, 1.5]) == [0, 0]


def test_the_largest_jump_of_a_chain_counts():
    batches = [
        *corrected((0.3, 0.4))[:1],
        tf("odom", "base", [0, 1.4, 1.6, 3], [[0, 0, 0], [0, 0, 0], [3, 0, 0], [3, 0, 0]]),
    ]
    assert jump(batches, [1.5, 1.7]) == [2.4, 0.5]
