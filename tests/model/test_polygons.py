import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.model.polygons import Raster, count_cover

UNIT = Raster(0.0, 0.0, 1.0, 4, 6)


def test_square_covers_the_cells_whose_centres_it_holds():
    square = np.array([[[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]]])
    expected = np.zeros((4, 6), int)
    expected[1:3, 1:4] = 1
    np.testing.assert_array_equal(count_cover([square], UNIT), expected)


def test_polygons_that_share_cells_are_counted_in_them():
    one = np.array([[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0]]])
    other = np.array([[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]]])
    count = count_cover([np.concatenate([one, other]), other], UNIT)
    assert count[0].tolist() == [3, 3, 3, 1, 1, 1]
    assert (count[1:] == 1).all()


def test_polygons_side_by_side_share_no_cell_and_leave_none_out():
    left = np.array([[[0.0, 0.0], [2.5, 0.0], [3.5, 4.0], [0.0, 4.0]]])
    right = np.array([[[2.5, 0.0], [6.0, 0.0], [6.0, 4.0], [3.5, 4.0]]])
    assert (count_cover([left, right], UNIT) == 1).all()


def test_polygon_without_area_covers_nothing():
    assert not count_cover([np.full((1, 5, 2), 2.5)], UNIT).any()


@given(st.lists(st.floats(0.1, 4.9), min_size=3, max_size=40), st.floats(0, 1), st.floats(0, 1))
def test_star_covers_a_cell_if_its_centre_lies_before_the_outline(radii, dx, dy):
    n = len(radii)
    bearing = np.arange(n) * 2 * math.pi / n
    centre = np.array([4.5 + dx, 4.5 + dy])
    corners = centre + np.array(radii)[:, None] * np.column_stack((np.cos(bearing), np.sin(bearing)))
    count = count_cover([corners[None]], Raster(-0.5, -0.5, 0.5, 22, 22))
    for row in range(0, 22, 3):
        for column in range(22):
            side = depth_inside(corners, centre, -0.5 + (column + 0.5) * 0.5, -0.5 + (row + 0.5) * 0.5)
            if abs(side) > 1e-9:
                assert count[row, column] == (side > 0)


def depth_inside(corners, centre, x, y):
    """Positive inside: in the triangle of the centre and the edge towards (x, y), the distance to that edge."""
    best = -math.inf
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        triangle = (centre, a, b)
        sides = []
        for p, q in zip(triangle, (a, b, centre), strict=True):
            sides.append((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]))
        if min(sides[0], sides[2]) >= -1e-12:
            best = max(best, sides[1])
    return best


def test_cells_of_points():
    row, column = Raster(-1.0, 2.0, 0.5, 4, 4).cells_of(np.array([[-1.0, 2.0], [0.49, 2.51], [0.5, 3.99]]))
    assert list(zip(row.tolist(), column.tolist(), strict=True)) == [(0, 0), (1, 2), (3, 3)]


@pytest.mark.parametrize("slope", [1e-12, -1e-12, 0.0])
def test_nearly_level_edges_leave_no_streaks(slope):
    strip = np.array([[[0.0, 1.5], [6.0, 1.5 + slope], [6.0, 2.6], [0.0, 2.6]]])
    count = count_cover([strip], UNIT)
    assert set(np.unique(count)) <= {0, 1}
    assert (count[2] == 1).all()
    assert not count[[0, 3]].any()
