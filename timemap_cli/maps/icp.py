"""Trimmed iterative closest point, point to line (Chetverikov et al. 2002; Chen and Medioni 1992)."""

import numpy as np

from timemap_cli.maps.grid import Floats
from timemap_cli.maps.offset import Offset
from timemap_cli.maps.surface import Pairs, Surface

_MIN_PAIRS = 10
_DAMPING = 1e-3  # a direction that nothing fixes is left as it is


def closest(points: Floats, surface: Surface, start: Offset, steps: int, trimmed: float = 0.7) -> Offset:
    """The offset near `start` that takes most of the points (n, 2) [m] onto the surface.

    It takes at most so many steps; in each this share of the pairs count, the closest: the others may have changed.
    """
    found = start
    for _ in range(steps):
        moved = found.moved(points)
        step = _step(moved, surface.nearest(moved), trimmed)
        if step is None:
            break
        before, found = found, found.then(step).rounded()
        if found == before:
            break
    return found


def _step(points: Floats, pairs: Pairs, trimmed: float) -> Offset | None:
    """What brings the closest pairs together, for small turns; None where they are too few to tell."""
    if len(pairs.which) < _MIN_PAIRS:
        return None
    last = np.sort(pairs.squares)[int(trimmed * (len(pairs.squares) - 1))]
    kept = pairs.of(pairs.squares <= last)
    x, y = points[kept.which].T
    xx, xy, yy = kept.metric.T
    pull_x, pull_y = kept.across.T
    turn_x, turn_y = x * xy - y * xx, x * yy - y * xy
    damping = _DAMPING * len(x)
    matrix = (
        (float(xx.sum()) + damping, float(xy.sum()), float(turn_x.sum())),
        (float(xy.sum()), float(yy.sum()) + damping, float(turn_y.sum())),
        (float(turn_x.sum()), float(turn_y.sum()), float((x * turn_y - y * turn_x).sum()) + damping),
    )
    pull = float(pull_x.sum()), float(pull_y.sum()), float((x * pull_y - y * pull_x).sum())
    return Offset(*_solved(matrix, pull))


_Row = tuple[float, float, float]


def _solved(matrix: tuple[_Row, _Row, _Row], right: _Row) -> _Row:
    """The x of matrix x = right, a symmetric matrix of positive eigenvalues; by elimination."""
    (a, b, c), (_, d, e), (_, _, f) = matrix
    p, q, r = right
    lower_b, lower_c = b / a, c / a
    d, e, f = d - lower_b * b, e - lower_b * c, f - lower_c * c
    q, r = q - lower_b * p, r - lower_c * p
    lower_e = e / d
    z = (r - lower_e * q) / (f - lower_e * e)
    y = (q - e * z) / d
    return (p - b * y - c * z) / a, y, z
