"""Where an alignment may start: the offsets at which points meet a surface at a glance."""

import math

import numpy as np

from timemap_cli.maps.grid import Floats, Ints, cells_of, shifted_cells
from timemap_cli.maps.offset import Offset

_CELL_M = 0.2
_CELLS = np.arange(-5, 6)  # shifts by up to a metre
_YAWS_DEG = range(-10, 11, 2)


def likely_starts(
    points: Floats, surface: Floats, pivots: list[tuple[float, float]], count: int
) -> list[Offset]:
    """The best offsets of a grid of 1 m and 10 degrees, no two of them of one yaw about one pivot; the best first.

    An offset is as good as many points (n, 2) [m] it takes to cells of 0.2 m at the surface (m, 2) [m]. Turns are
    about each of the pivots [m]: a drive may be turned about the place where it begins.
    """
    occupied = _occupied(surface)
    if not len(occupied):
        return []
    ranked: list[tuple[int, int, int, int, Offset]] = []
    for pivot in pivots:
        for degrees in _YAWS_DEG:
            turn = Offset(yaw=math.radians(degrees)).about(*pivot)
            met, right, up = _best_shift(turn.moved(points), occupied)
            start = Offset(turn.dx + right * _CELL_M, turn.dy + up * _CELL_M, turn.yaw)
            ranked.append((-met, abs(degrees), right * right + up * up, len(ranked), start))
    return [start.rounded() for *_, start in sorted(ranked)[:count]]


def _occupied(surface: Floats) -> Ints:
    """Keys of the cells that lie within half a cell's side of the surface, ascending."""
    corners = np.array([(-1, -1), (-1, 1), (1, -1), (1, 1)]) * (_CELL_M / 2)
    return np.unique(cells_of(surface[:, None] + corners, _CELL_M))


def _best_shift(points: Floats, occupied: Ints) -> tuple[int, int, int]:
    """How many points the best shift takes to occupied cells, and that shift [cells] to the right and up."""
    up, right = (one.ravel() for one in np.meshgrid(_CELLS, _CELLS, indexing="ij"))
    keys = shifted_cells(cells_of(points, _CELL_M), right[:, None], up[:, None])
    place = np.minimum(np.searchsorted(occupied, keys), len(occupied) - 1)
    met = (occupied[place] == keys).sum(axis=1)
    best = np.lexsort((right * right + up * up, -met))[0]
    return int(met[best]), int(right[best]), int(up[best])
