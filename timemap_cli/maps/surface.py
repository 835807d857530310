"""A surface made of points: where its nearest point is, and which way it runs there."""

from dataclasses import dataclass

import numpy as np

from timemap_cli.maps.grid import Floats, Grid, Ints, thinned
from timemap_cli.model.elementary import bearings, cos_sin

FINE_M, WIDE_M = 0.05, 0.2  # sides of cells

_REACH_CELLS = 5  # farther away no point of it is looked for
_NORMAL_CELLS = 4  # neighbours that tell which way it runs
_MIN_NEIGHBOURS = 4
_DENSE = 3
_FLAT = (
    0.1  # a line's points spread across it by at most this share (of the variance) of what they do along it
)
_MAX_POINTS = 50_000  # more are thinned to wider cells


@dataclass(frozen=True, slots=True)
class Pairs:
    """Points, each with the nearest place of a surface."""

    which: Ints  # (k,) number of the point, ascending
    gaps: Floats  # (k, 2) [m] from the point to the surface's nearest
    squares: Ints  # (k,) [1e-8 m2] length of the gap, squared
    metric: Floats  # (k, 3) xx, xy, yy: across a line alone, any way beside a corner

    @property
    def across(self) -> Floats:
        """(k, 2) [m] what a point is beside a line, or the whole gap where there is no line."""
        (x, y), (xx, xy, yy) = self.gaps.T, self.metric.T
        return np.stack((xx * x + xy * y, xy * x + yy * y), axis=1)

    def of(self, chosen: np.ndarray) -> "Pairs":
        """Some of the pairs."""
        return Pairs(self.which[chosen], self.gaps[chosen], self.squares[chosen], self.metric[chosen])


class Surface:
    """Points thinned to one a cell, with the direction of the line they lie on, if they do.

    Points by themselves are none of it: of a wall seen from afar at a flat angle two drives know other points.

    Built from points (n, 2) [m]; nearest points are found within `reach` [m], five cells.
    """

    def __init__(self, points: Floats, cell_m: float) -> None:
        kept = _dense(thinned(points, cell_m), _REACH_CELLS * cell_m)
        self.points = kept  # (m, 2) [m]
        self.reach = _REACH_CELLS * cell_m
        self._grid = Grid(kept, self.reach)
        self._metric = _metric(kept, Grid(kept, _NORMAL_CELLS * cell_m))

    def nearest(self, points: Floats) -> Pairs:
        """Pairs of those points (k, 2) [m] that are within reach of the surface."""
        which, place, squares = self._grid.nearest(points)
        return Pairs(which, self.points[place] - points[which], squares, self._metric[place])


@dataclass(frozen=True, slots=True)
class Scales:
    """One surface as it is, and as it looks from afar."""

    fine: Surface
    wide: Surface

    @classmethod
    def of(cls, points: Floats) -> "Scales":
        """Of points (n, 2) [m]; within 0.25 m the surface is found as it is, from 1 m away as it looks from afar."""
        fine = _bounded(points, FINE_M)
        return cls(fine, _bounded(fine.points, WIDE_M))


def _bounded(points: Floats, cell_m: float) -> Surface:
    """A surface with cells so wide that it has at most 50,000 points."""
    while len(thinned(points, cell_m)) > _MAX_POINTS:
        cell_m *= 2
    return Surface(points, cell_m)


def _dense(points: Floats, within_m: float) -> Floats:
    """The points with two others at least so near."""
    here, _, _ = Grid(points, within_m).near(points)
    return points[np.bincount(here, minlength=len(points)) >= _DENSE]


def _metric(points: Floats, grid: Grid) -> Floats:
    """(m, 3) xx, xy, yy of the matrix that keeps what lies across the line through a point's neighbours.

    Where those lie on no line, it is that which keeps all.
    """
    here, neighbour, _ = grid.near(points)
    x, y = np.rint((points[neighbour] - points[here]) * 1000).T  # whole millimetres: their sums are exact

    def total(values: Floats | None = None) -> Floats:
        return np.bincount(here, weights=values, minlength=len(points)).astype(np.float64)

    count = total()
    mean_x, mean_y = total(x) / count, total(y) / count
    xx = total(x * x) / count - mean_x * mean_x
    xy = total(x * y) / count - mean_x * mean_y
    yy = total(y * y) / count - mean_y * mean_y
    half = (xx - yy) / 2
    spread, middle = np.sqrt(half * half + xy * xy), (xx + yy) / 2
    along_x, along_y = cos_sin(bearings(half, xy) / 2)
    line = (count >= _MIN_NEIGHBOURS) & (np.rint(middle - spread) <= np.rint(_FLAT * (middle + spread)))
    across = np.stack((along_y * along_y, -along_x * along_y, along_x * along_x), axis=1)
    return np.where(line[:, None], across, np.array([1.0, 0.0, 1.0]))
