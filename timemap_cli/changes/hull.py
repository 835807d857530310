"""The outline of a thing from its points."""

import numpy as np

from timemap_cli.changes.rings import Floats

MARGIN_M = 0.025  # a surface seen from one side is a line; its outline has a width all the same


def hull(points: Floats) -> Floats:
    """Corners (k, 2) [m], counter-clockwise, of the least convex polygon round squares of 5 cm at the points (n, 2)."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * MARGIN_M
    around = (points[:, None] + corners).reshape(-1, 2)
    ordered = np.unique(around, axis=0).tolist()  # by x, then y
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _chain(ordered: list[list[float]]) -> list[list[float]]:
    """The points that turn left all the way (Andrew's monotone chain)."""
    kept: list[list[float]] = []
    for x, y in ordered:
        while len(kept) > 1:
            (ax, ay), (bx, by) = kept[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                break
            kept.pop()
        kept.append([x, y])
    return kept
