"""Which points lie near a surface: at a flat angle a pose that is a few centimetres off shifts ranges by a lot.

The points of the wall that is seen so still lie on the wall.
"""

import numpy as np

from timemap_cli.changes.rings import Bools, Floats, Ints
from timemap_cli.model.elementary import lengths

_PAIRS_AT_ONCE = 1 << 18  # bounds the memory
_ROW = 1 << 31  # cells of a grid in a row, more than any map has
_AROUND = tuple((x, y) for x in (0, -1, 1) for y in (0, -1, 1))


def near(points: Floats, surface: Floats, reach_m: float) -> Bools:
    """Which of the points (n, 2) lie within `reach_m` of a point of a surface (k, 2), (n,)."""
    found = np.zeros(len(points), np.bool_)
    if not len(points) or not len(surface):
        return found
    origin = np.minimum(points.min(axis=0), surface.min(axis=0)) - 2 * reach_m
    keys = _cells(surface, origin, reach_m)
    order = np.argsort(keys, kind="stable")
    keys, surface = keys[order], surface[order]
    for x, y in _AROUND:
        left = np.flatnonzero(~found)
        wanted = _cells(points[left], origin, reach_m) + (x * _ROW + y)
        begin, end = np.searchsorted(keys, wanted), np.searchsorted(keys, wanted, side="right")
        for some in _portions(end - begin):
            here = left[some]
            found[here] = _any_within(points[here], surface, begin[some], end[some], reach_m)
    return found


def _cells(points: Floats, origin: Floats, width_m: float) -> Ints:
    """Number of the cell of each point."""
    cells = np.floor((points - origin) / width_m).astype(np.int64)
    return cells[:, 0] * _ROW + cells[:, 1]


def _portions(counts: Ints) -> list[Ints]:
    """Those that have any, in portions of bounded counts."""
    there = np.flatnonzero(counts)
    if not len(there):
        return []
    portion = np.cumsum(counts[there]) // _PAIRS_AT_ONCE
    return np.split(there, np.flatnonzero(np.diff(portion)) + 1)


def _any_within(points: Floats, surface: Floats, begin: Ints, end: Ints, reach_m: float) -> Bools:
    """Whether each point (n, 2) lies within reach of one of surface[begin:end], none of which is empty."""
    counts = end - begin
    first = np.cumsum(counts) - counts
    which = np.repeat(np.arange(len(points)), counts)
    other = np.arange(len(which)) + np.repeat(begin - first, counts)
    close = lengths(points[which] - surface[other]) <= reach_m
    return np.asarray(np.logical_or.reduceat(close, first))
