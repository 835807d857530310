import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.results.bearings import scan_angles

bins = st.integers(3, 4000)


@given(bins)
def test_last_angle_follows_from_the_first_without_rounding(n):
    angle_min, angle_max, increment = scan_angles(n)
    assert angle_max == angle_min + (n - 1) * increment  # 64 bits hold the product exactly
    assert all(float(np.float32(a)) == a for a in (angle_min, angle_max, increment))


@given(bins)
def test_last_angle_follows_from_the_first_in_float32_arithmetic(n):
    angle_min, angle_max, increment = (np.float32(a) for a in scan_angles(n))
    assert angle_min + np.float32(n - 1) * increment == angle_max


@given(bins)
def test_bearing_is_the_centre_of_its_angle_bin(n):
    angle_min, _, increment = scan_angles(n)
    for i in (0, n // 2, n - 1):
        assert angle_min + i * increment == pytest.approx((i + 0.5) * 2 * math.pi / n, abs=1e-6)
