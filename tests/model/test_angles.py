"""Bearings of points, against the standard library's."""

import math

import numpy as np
import pytest

from timemap_cli.model.angles import quarter_turns

QUARTER = math.pi / 2


def bearing(x, y):
    """[rad], as the model finds it."""
    return float(quarter_turns(np.float32([x]), np.float32([y]))[0]) * QUARTER


def test_bearings_agree_with_the_arctangent_in_all_four_quadrants():
    random = np.random.default_rng(1)
    angles, lengths = random.uniform(0, math.tau, 20_000), 10 ** random.uniform(-3, 2, 20_000)
    x, y = (lengths * np.cos(angles)).astype(np.float32), (lengths * np.sin(angles)).astype(np.float32)
    expected = np.arctan2(y.astype(float), x.astype(float)) % math.tau
    np.testing.assert_allclose(quarter_turns(x, y) * QUARTER, expected, atol=2e-6)


COMPASS = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]


@pytest.mark.parametrize(("eighth", "point"), list(enumerate(COMPASS)))
def test_eighths_of_a_turn_are_exact(eighth, point):
    for scale in (1.0, 0.37, 1e-3, 81.9):
        x, y = np.float32(point[0] * scale), np.float32(point[1] * scale)
        assert quarter_turns(np.array([x]), np.array([y]))[0] == eighth / 2


@pytest.mark.parametrize("y", [-0.0, -1e-30, -1e-17, -1e-9, -1e-8, -1e-7, -1e-6])
def test_a_point_a_rounding_below_plus_x_wraps_into_the_circle(y):
    assert 0 <= bearing(3.0, y) < math.tau
    turn = quarter_turns(np.float32([3.0]), np.float32([y]))
    for angle_bins in (12, 13, 360, 361, 720, 3599, 3600):
        angle_bin = int((turn * np.float32(angle_bins / 4))[0])
        assert angle_bin in {0, angle_bins - 1}


def test_the_centre_itself_has_a_bearing():
    assert [bearing(x, y) for x in (0.0, -0.0) for y in (0.0, -0.0)] == pytest.approx(
        [0, 0, math.pi, math.pi]
    )


def test_bearings_rise_with_the_angle():
    angles = np.linspace(0, math.tau, 100_000, endpoint=False)
    turns = quarter_turns((5 * np.cos(angles)).astype(np.float32), (5 * np.sin(angles)).astype(np.float32))
    assert np.diff(turns).min() > -1e-6
