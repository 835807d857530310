"""The measures, on estimates made by hand."""

import numpy as np
import pytest

from benchmarks.paper.metrics import Change, delay, error, flicker, half_and_half, overlap, runs

OLD, NEW = np.full(20, 3.0), np.where(np.arange(20) < 10, 2.0, 3.0)
CHANGE = Change(OLD, NEW, np.ones(20, bool), np.arange(20) < 10)


def shown(new_bins):
    """An estimate that shows so many of the ten changed angle bins."""
    return np.where(np.arange(20) < new_bins, NEW, OLD)


def test_the_delay_ends_when_nine_of_ten_angle_bins_are_new():
    follows = np.stack([[shown(n), shown(0)] for n in (0, 8, 9, 10)])
    found = delay(follows, CHANGE, every=10)
    assert found[0] == 30
    assert np.isnan(found[1])


def test_an_object_is_half_and_half_between_a_tenth_and_nine_tenths():
    found = [bool(half_and_half(shown(n), CHANGE)) for n in (0, 1, 2, 5, 8, 9, 10)]
    assert found == [False, False, True, True, True, False, False]


def test_two_whole_objects_in_different_states_are_not_half_and_half():
    changed = np.isin(np.arange(20), [1, 2, 3, 4, 11, 12, 13, 14])
    change = Change(OLD, np.where(changed, 2.0, 3.0), np.ones(20, bool), changed)
    one = np.where(np.isin(np.arange(20), [1, 2, 3, 4]), 2.0, 3.0)
    assert not half_and_half(one, change)


def test_runs_go_round_the_seam():
    chosen = np.isin(np.arange(12), [0, 1, 5, 6, 7, 11])
    assert [run.tolist() for run in runs(chosen)] == [[11, 0, 1], [5, 6, 7]]
    assert [run.tolist() for run in runs(np.ones(3, bool))] == [[0, 1, 2]]
    assert runs(np.zeros(3, bool)) == []


def test_clear_against_a_surface_is_an_error_of_a_metre_and_unknown_is_none():
    true = np.array([1.0, np.inf, 2.0, 2.0])
    seen = np.array([1.1, np.inf, np.inf, np.nan])
    assert error(seen, true, np.ones(4, bool)) == pytest.approx((0.1 + 0 + 1) / 3)


def test_flicker_counts_jumps_of_more_than_a_decimetre():
    seen = np.array([[1.0, 1.0], [1.05, 2.0], [1.05, 2.0], [np.inf, 2.0], [np.inf, 2.0]])[:, None]
    assert flicker(seen, np.ones(2, bool)) == pytest.approx(2 / 8)


def test_overlap_is_intersection_by_union():
    a, b = np.array([True, True, False, False]), np.array([False, True, True, False])
    assert overlap(a, b) == pytest.approx(1 / 3)
    assert overlap(np.zeros(4, bool), np.zeros(4, bool)) == 1
