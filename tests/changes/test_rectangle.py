"""The sides of the least rectangle round an outline."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.changes.rectangle import rectangle_sides

# an outline is of squares of 5 cm whichever way it is turned; over their corners they measure 7.1 cm
TURNED_M = 0.05 * (np.sqrt(2) - 1)


def outline(length_m: float, depth_m: float, every_m: float = 0.05) -> np.ndarray:
    """The four sides of a rectangle about the origin, corners included, as complex numbers [m]."""
    x = np.linspace(-length_m / 2, length_m / 2, 2 + int(length_m / every_m))
    y = np.linspace(-depth_m / 2, depth_m / 2, 2 + int(depth_m / every_m))
    return np.concatenate(
        [x - 0.5j * depth_m, x + 0.5j * depth_m, 1j * y - length_m / 2, 1j * y + length_m / 2]
    )


def placed(points: np.ndarray, turned_deg: float, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    turned = points * np.exp(1j * np.radians(turned_deg)) + complex(x, y)
    return np.stack([turned.real, turned.imag], axis=1)


@given(st.floats(0.3, 3.0), st.floats(0.05, 1.0), st.floats(0, 360), st.floats(-50, 50), st.floats(-50, 50))
def test_turned_rectangles_keep_their_sides(length_m, depth_m, turned_deg, x, y):
    sides = rectangle_sides(placed(outline(length_m, depth_m), turned_deg, x, y))
    assert sides == pytest.approx(sorted((length_m, depth_m), reverse=True), abs=TURNED_M + 0.005)


def test_a_rectangle_along_the_axes_has_its_sides():
    assert rectangle_sides(placed(outline(0.8, 0.3), 0.0)) == pytest.approx((0.8, 0.3))
    assert rectangle_sides(placed(outline(0.8, 0.3), 90.0)) == pytest.approx((0.8, 0.3))


@given(st.floats(0.2, 3.0), st.floats(0, 360))
def test_one_face_has_hardly_a_shorter_side(length_m, turned_deg):
    longer, shorter = rectangle_sides(placed(np.linspace(0, length_m, 20) + 0j, turned_deg))
    assert longer == pytest.approx(length_m, abs=TURNED_M)
    assert 0.0 <= shorter <= TURNED_M


@given(st.floats(0.3, 3.0), st.floats(0.3, 1.0), st.floats(0, 360))
def test_two_faces_have_the_sides_of_the_whole(length_m, depth_m, turned_deg):
    """Of a corner, the rectangle along the diagonal has the same area as the one along the faces."""
    corner = np.r_[np.linspace(0, length_m, 20), 1j * np.linspace(0, depth_m, 20)]
    sides = rectangle_sides(placed(corner, turned_deg))
    assert sides == pytest.approx(sorted((length_m, depth_m), reverse=True), abs=TURNED_M + 0.005)


def test_a_point_has_no_sides():
    assert rectangle_sides(np.array([(3.0, 4.0)])) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert rectangle_sides(np.array([(3.0, 4.0), (3.0, 4.0)])) == pytest.approx((0.0, 0.0), abs=1e-12)
