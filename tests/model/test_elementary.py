"""Sines, arctangents, logarithms and lengths, against the standard library's."""

import math

import numpy as np
import pytest

from timemap_cli.model.elementary import bearings, cos_sin, distance, lengths, logarithms


def test_cosines_and_sines_agree_with_the_standard_library():
    random = np.random.default_rng(1)
    angles = np.concatenate((random.uniform(-7, 7, 5000), random.uniform(-1e4, 1e4, 5000)))
    cos, sin = cos_sin(angles)
    assert max(abs(c - math.cos(a)) for c, a in zip(cos, angles, strict=True)) <= 2.3e-16
    assert max(abs(s - math.sin(a)) for s, a in zip(sin, angles, strict=True)) <= 2.3e-16


def test_quarter_turns_have_cosines_and_sines_of_nought_and_one_within_a_rounding():
    cos, sin = cos_sin(np.arange(-8, 9) * (math.pi / 2))
    np.testing.assert_allclose(cos, [1, 0, -1, 0] * 4 + [1], atol=1e-15)
    np.testing.assert_allclose(sin, [0, 1, 0, -1] * 4 + [0], atol=1e-15)


def test_cosines_and_sines_keep_the_shape_and_pass_on_what_is_not_finite():
    cos, sin = cos_sin(np.array([[0.0, np.nan]]))
    assert cos.tolist()[0][0] == 1.0
    assert sin.tolist()[0][0] == 0.0
    assert np.isnan([cos[0, 1], sin[0, 1]]).all()


def test_bearings_agree_with_the_standard_library_in_all_four_quadrants():
    x, y = np.random.default_rng(2).normal(size=(2, 5000))
    expected = [math.atan2(b, a) for a, b in zip(x, y, strict=True)]
    np.testing.assert_allclose(bearings(x, y), expected, rtol=1e-15)


@pytest.mark.parametrize(
    ("x", "y", "expected"),
    [
        (1, 0, 0),
        (2, 2, 0.25),
        (0, 3, 0.5),
        (-1, 1, 0.75),
        (-1, 0.0, 1),
        (-1, -0.0, -1),
        (0, -2, -0.5),
        (0, 0, 0),
    ],
)
def test_bearings_of_the_axes_and_diagonals_in_half_turns(x, y, expected):
    assert bearings(np.array([float(x)]), np.array([float(y)]))[0] == pytest.approx(
        expected * math.pi, rel=1e-15
    )


def test_bearings_of_tiny_points_keep_their_digits():
    # the angle between two neighbouring poses: what slerp divides by
    assert bearings(np.array([2.0]), np.array([3e-9]))[0] == pytest.approx(1.5e-9, rel=1e-15)


def test_logarithms_agree_with_the_standard_library():
    random = np.random.default_rng(3)
    values = np.concatenate((10 ** random.uniform(-300, 300, 3000), 1 + random.uniform(-0.5, 1, 3000)))
    expected = [math.log(value) for value in values]
    np.testing.assert_allclose(logarithms(values), expected, rtol=1e-15, atol=1e-15)


def test_logarithms_of_numbers_beside_one_keep_their_digits():
    values = np.array([1 - 2**-53, 1.0, 1 + 2**-52])
    np.testing.assert_allclose(logarithms(values), [-(2.0**-53), 0.0, 2.0**-52], rtol=1e-15)


def test_lengths_are_those_of_pythagoras():
    assert distance(-3.0, 4.0) == 5.0
    assert lengths(np.array([[3.0, 4.0], [-8.0, 15.0], [0.0, 0.0]])).tolist() == [5.0, 17.0, 0.0]
    assert np.isnan(lengths(np.array([[np.nan, 1.0]])))[0]
