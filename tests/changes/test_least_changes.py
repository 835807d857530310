"""Leaving out what is small, or hardly moved."""

from math import hypot, inf

import pytest

from tests.reports.differences import APPEARED, MOVED, VANISHED, difference


def test_size_is_the_diagonal_of_the_bounds():
    assert APPEARED.size_m == pytest.approx(hypot(0.2, 0.2))
    assert VANISHED.size_m == pytest.approx(hypot(0.05, 0.6))


def test_shift_of_a_moved_thing_is_the_way_it_went():
    assert MOVED.shift_m == pytest.approx(1.0)  # from (4.4, 6.8) to (5, 6): 0.6 and 0.8


def test_shift_of_another_thing_is_its_largest_step_of_range():
    assert APPEARED.shift_m == 1.0  # from 8 m to 7 m


def test_a_range_that_was_or_became_clear_is_a_step_without_bound():
    assert VANISHED.shift_m == inf


@pytest.mark.parametrize(
    ("size", "shift", "left"),
    [
        (0.0, 0.0, [MOVED, VANISHED, APPEARED]),
        (0.5, 0.0, [VANISHED]),
        (0.7, 0.0, []),
        (0.0, 0.99, [MOVED, VANISHED, APPEARED]),
        (0.0, 1.01, [VANISHED]),
        (0.5, 1.01, [VANISHED]),
    ],
)
def test_what_is_smaller_or_moved_less_is_left_out_and_counted(size, shift, left):
    told = difference(MOVED, VANISHED, APPEARED).at_least(size, shift)
    assert list(told.changes) == left
    assert told.small == 3 - len(left)


def test_what_was_compared_stays_the_same():
    whole = difference(MOVED, VANISHED)
    few = whole.at_least(5.0, 0.0)
    assert few.nodes == whole.nodes
    assert few.compared_bins == whole.compared_bins
