"""How much of what is known agrees with the range shown: a matter of distance, not of states."""

import numpy as np
import pytest

from tests.model.test_estimator import found
from timemap_cli.model.estimates import Estimate

NAN = np.nan


def support_of_first(*ranges):
    """Support of what is shown where these ranges [m] of one angle bin are remembered, each once."""
    return float(found(np.array([[r, 2.0, 2.0] for r in ranges]), window=20).support[0, 0])


@pytest.mark.parametrize(
    ("other", "agrees"),
    [(2.199, True), (2.2, True), (2.201, False), (1.8, True), (1.799, False), (np.inf, False)],
)
def test_what_lies_within_the_step_of_a_change_agrees(other, agrees):
    assert support_of_first(2.0, 2.0, 2.0, other) == (1.0 if agrees else 0.75)


@pytest.mark.parametrize(("other", "agrees"), [(9.27, True), (9.271, False), (8.73, True), (8.729, False)])
def test_far_away_the_step_is_a_share_of_the_range_shown(other, agrees):
    """3 % of 9 m are 0.27 m."""
    assert support_of_first(9.0, 9.0, 9.0, other) == (1.0 if agrees else 0.75)


def test_clear_agrees_with_clear_alone():
    assert support_of_first(np.inf, np.inf, np.inf, 9.99) == 0.75


def test_a_surface_whose_ranges_spread_over_several_states_agrees_with_itself():
    """Of eight ranges 6 cm apart only three or four are of one state 0.1 m wide, but all lie within 0.2 m of the
    middle."""
    spread = [2.0, 2.06, 2.12, 2.18, 2.24]
    assert support_of_first(*spread, *spread, 2.12, 2.12, 2.12) == 1.0


def test_of_what_was_never_seen_nothing_is_supported():
    assert found(np.full((3, 12), NAN), window=10).support.tolist() == [[0.0] * 12]


def test_plausibility_is_what_does_not_contradict_whether_known_or_not():
    """Half of the window is known, and a quarter of that disagrees."""
    arrays = (np.array([value], np.float32) for value in (2.0, 0.75, 0.5))
    rest = np.array([9], np.uint16), np.array([1], np.uint8), np.array([0])
    assert Estimate(0, "mid", 0, *arrays, *rest).plausibility.tolist() == [0.875]
