"""Outlines of points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.changes.hull import hull
from timemap_cli.changes.matching import best_match, overlap

metres = st.floats(-50, 50).map(lambda value: round(value, 3))
outlines = st.lists(st.tuples(metres, metres), min_size=1, max_size=30).map(np.array)


def area(polygon):
    x, y = polygon.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def test_one_point_has_a_square_of_five_centimetres():
    corners = hull(np.array([[1.0, 2.0]]))
    assert sorted(map(tuple, np.round(corners, 4).tolist())) == [
        (0.975, 1.975),
        (0.975, 2.025),
        (1.025, 1.975),
        (1.025, 2.025),
    ]


def test_points_within_do_not_matter():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    with_middle = np.vstack((square, [[0.5, 0.5]]))
    np.testing.assert_array_equal(hull(square), hull(with_middle))
    assert area(hull(square)) == pytest.approx(1.05**2)


@given(outlines)
def test_the_outline_turns_left_and_holds_all_points(points):
    corners = hull(points)
    assert area(corners) >= 0.05**2 - 1e-9
    along = np.roll(corners, -1, axis=0) - corners
    for point in points:
        beside = point - corners
        assert (along[:, 0] * beside[:, 1] - along[:, 1] * beside[:, 0] > 0).all()


def test_overlap_is_the_share_of_the_smaller_that_lies_near():
    line = np.stack([np.arange(0, 2, 0.1), np.zeros(20)], axis=1)
    assert overlap(line, line[:3]) == 1.0
    assert overlap(line, line + np.array([0, 0.25])) == 1.0
    assert overlap(line, line + np.array([0, 0.35])) == 0.0
    assert overlap(line, line + np.array([1.65, 0])) == pytest.approx(0.3)


def test_the_best_match_overlaps_by_half_at_least():
    class Place:
        def __init__(self, shift):
            self.points = np.stack([np.arange(0, 2, 0.1) + shift, np.zeros(20)], axis=1)

    near, far = Place(0.7), Place(1.65)
    points = Place(0.0).points
    assert best_match(points, [far, near]) is near
    assert best_match(points, [far]) is None
    assert best_match(points, []) is None
