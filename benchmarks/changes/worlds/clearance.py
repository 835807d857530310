"""How much room a route leaves between the robot's middle and what stands beside it."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from sample_logs.rays import Floats

Point = tuple[float, float]
_STEP_M = 0.05


def clearance(route: Sequence[Point], segments: Floats) -> float:
    """Least distance [m] between a route's straight legs and segments (m, 4)."""
    points = np.concatenate([_leg(a, b) for a, b in pairwise(route)])
    start, edge = segments[None, :, :2], (segments[:, 2:] - segments[:, :2])[None]
    share = np.clip(((points[:, None] - start) * edge).sum(-1) / (edge**2).sum(-1), 0, 1)
    return float(np.linalg.norm(points[:, None] - start - share[..., None] * edge, axis=-1).min())


def _leg(a: Point, b: Point) -> Floats:
    """Points (k, 2) from a to b."""
    steps = 2 + int(np.hypot(b[0] - a[0], b[1] - a[1]) / _STEP_M)
    return np.linspace(a, b, steps)
