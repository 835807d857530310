"""The three angles of a LaserScan, chosen so that viewers cannot disagree about a bearing."""

import math
from functools import lru_cache

import numpy as np


@lru_cache(maxsize=8)
def scan_angles(angle_bins: int) -> tuple[float, float, float]:
    """angle_min, angle_max, angle_increment [rad] of a full turn, each exactly a float32.

    Bearing i is the centre of angle bin i, within 1e-6 rad. `angle_max == angle_min + (angle_bins - 1) *
    angle_increment` holds without any rounding, and in float32 arithmetic too: some viewers compute the
    increment from the two ends, others the end from the increment.
    """
    bin_width = 2 * math.pi / angle_bins
    steps = angle_bins - 1
    angle_max = np.float32(2 * math.pi - bin_width / 2)
    for attempt in range(100):
        nudge = (attempt + 1) // 2 * (-1) ** attempt  # 0, -1, 1, -2, 2, ...
        increment = np.float32(bin_width) + np.float32(nudge) * np.spacing(np.float32(bin_width))
        angle_min = float(angle_max) - steps * float(increment)  # exact: multiples of one small power of two
        in_float32 = np.float32(angle_min) + np.float32(steps) * increment
        if np.float32(angle_min) == angle_min and in_float32 == angle_max:
            return angle_min, float(angle_max), float(increment)
    raise ValueError(f"no exact angles for {angle_bins} angle bins")
