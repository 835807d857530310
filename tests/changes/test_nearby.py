"""Which points lie near a surface."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from timemap_cli.changes import nearby
from timemap_cli.changes.nearby import near

metres = st.integers(-3000, 3000).map(lambda mm: mm / 1000)
clouds = st.lists(st.tuples(metres, metres), max_size=25).map(lambda points: np.array(points).reshape(-1, 2))


@given(clouds, clouds, st.sampled_from([0.05, 0.15, 0.65, 2.0]), st.integers(1, 30))
def test_near_is_what_a_search_over_all_pairs_finds(points, surface, reach_m, at_once):
    apart = np.hypot(*(points[:, None] - surface[None]).transpose(2, 0, 1))
    assume(not (np.abs(apart - reach_m) < 1e-9).any())  # on the limit the last bit decides
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nearby, "_PAIRS_AT_ONCE", at_once)
        found = near(points, surface, reach_m)
    assert found.tolist() == (apart <= reach_m).any(axis=1).tolist()


def test_reach_is_a_distance_and_its_limit_is_near():
    surface = np.array([(0.0, 0.0)])
    points = np.array([(0.5, 0.0), (0.0, -0.5), (0.4, 0.3), (0.4, 0.4), (0.51, 0.0)])
    assert near(points, surface, 0.5).tolist() == [True, True, True, False, False]


def test_nothing_is_near_nothing():
    some, none = np.array([(0.0, 0.0)]), np.empty((0, 2))
    assert near(some, none, 1.0).tolist() == [False]
    assert near(none, some, 1.0).tolist() == []


@pytest.mark.parametrize(("beside_m", "expected"), [(0.1, True), (0.2, False)])
def test_points_beside_a_long_wall(beside_m, expected):
    wall = np.stack([np.arange(0.0, 400.0, 0.05), np.full(8000, 0.5)], axis=1)
    assert near(np.array([(377.0, 0.5 - beside_m)]), wall, 0.15).tolist() == [expected]


def test_far_from_the_origin_is_as_near():
    shift = np.array((-4.0e5, 7.0e5))
    points = np.array([(0.0, 0.0), (1.0, 0.0)])
    assert near(points + shift, np.array([(0.1, 0.0)]) + shift, 0.15).tolist() == [True, False]
