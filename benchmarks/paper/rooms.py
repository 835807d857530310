"""Worlds of the experiments, as segments (m, 4) [m] round a node at the origin."""

import numpy as np

from benchmarks.paper.scene import ANGLE_BINS
from sample_logs.rays import Floats
from sample_logs.world import box, outline_segments


def with_boxes(world: Floats, *boxes: tuple[float, float, float, float, float]) -> Floats:
    """A world and boxes in it: x, y, length, width [m], turned by [degrees]."""
    return np.concatenate((world, *(outline_segments(box(*one)) for one in boxes)))


def arc(start: float, stop: float, distance: float = 1.0) -> Floats:
    """An arc-shaped object 0.15 m deep round the node, from one angle bin to another: it can be counted in bins."""
    angles = np.linspace(start, stop, 25) * (2 * np.pi / ANGLE_BINS)
    inside = distance * np.stack((np.cos(angles), np.sin(angles)), axis=1)
    return outline_segments(np.concatenate((inside, (1 + 0.15 / distance) * inside[::-1])))


_WALLS = outline_segments(box(0.4, 0.2, 5.0, 4.0))

# A room of 5 m by 4 m with a cabinet, a pillar and a desk on its side.
OFFICE = with_boxes(
    _WALLS, (-1.3, 1.9, 1.2, 0.5, 0.0), (1.6, -1.2, 0.4, 0.4, 0.0), (-1.4, -1.3, 0.5, 1.0, 0.0)
)

# The same room without its wall at +x: there is nothing within reach.
OPEN_OFFICE = np.delete(OFFICE, 1, axis=0)
