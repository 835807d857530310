"""Points of the plane in square cells: thinned to one a cell, and found again by where they lie.

Whatever is decided here is decided on whole millimetres, or on whole tenths of them: no order and no border
depends on the last bit of a number.
"""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FARTHEST_M = 1e7  # cells of a millimetre still have a key of 64 bits
_ROW = 1 << 32
_MIXED = np.uint64(0x9E3779B97F4A7C15)  # 2^64 over the golden ratio: neighbours land far apart


def cells_of(points: Floats, cell_m: float) -> Ints:
    """Keys of the cells that hold the points (..., 2) [m]; `key + 1` is the next to the right."""
    cell = np.floor(np.rint(points * 1000) / round(cell_m * 1000)).astype(np.int64)
    return np.asarray(cell[..., 1] * _ROW + cell[..., 0])


def shifted_cells(keys: Ints, right: Ints | int, up: Ints | int) -> Ints:
    """Keys of the cells so many cells to the right and up."""
    return np.asarray(keys + up * _ROW + right)


def thinned(points: Floats, cell_m: float) -> Floats:
    """Mean point of each cell that holds any, to the millimetre, by rows of cells: (k, 2) [m].

    Neither the order of the points (n, 2) [m] matters nor what is not finite or more than 1e7 m away.
    """
    far = ~(np.abs(points) <= FARTHEST_M).all(axis=1)
    millimetres = np.rint(points[~far] * 1000)
    keys, cell = np.unique(cells_of(points[~far], cell_m), return_inverse=True)
    counts = np.bincount(cell, minlength=len(keys))
    sums = [
        np.bincount(cell, weights=one, minlength=len(keys)) for one in millimetres.T
    ]  # exact: whole numbers
    return np.rint(np.stack(sums, axis=1) / counts[:, None]) / 1000


def sample(points: Floats, at_most: int, cell_m: float) -> Floats:
    """So many of the points (n, 2) [m], no two of them in one cell, spread evenly and always the same ones."""
    if len(points) <= at_most:
        return points
    mixed = cells_of(points, cell_m).astype(np.uint64) * _MIXED
    mixed = (mixed ^ (mixed >> np.uint64(32))) * _MIXED
    return points[np.sort(np.argsort(mixed, kind="stable")[:at_most])]


class Grid:
    """Points (n, 2) [m] by the cell that holds them."""

    def __init__(self, points: Floats, cell_m: float) -> None:
        keys = cells_of(points, cell_m)
        self._cell_m = cell_m
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]
        self._points = points

    def near(self, queries: Floats) -> tuple[Ints, Ints, Ints]:
        """All pairs of a query (k, 2) [m] and a point that are no farther apart than a cell's side.

        Returns the number of each pair's query, ascending, of its point, and the square of their distance
        [1e-8 m2].
        """
        centre = cells_of(queries, self._cell_m)[:, None]
        rows = shifted_cells(centre, 0, np.array([-1, 0, 1]))  # three cells beside each other are one stretch
        first = np.searchsorted(self._keys, rows - 1, side="left")
        count = np.searchsorted(self._keys, rows + 1, side="right") - first
        query = np.repeat(np.arange(len(queries)), count.sum(axis=1))
        ends = np.cumsum(count.ravel())
        place = np.arange(len(query)) + np.repeat(first.ravel() - ends + count.ravel(), count.ravel())
        point = self._order[place]
        apart = queries[query] - self._points[point]
        square = np.rint((apart[:, 0] * apart[:, 0] + apart[:, 1] * apart[:, 1]) * 1e8).astype(np.int64)
        within = square <= round(self._cell_m * self._cell_m * 1e8)
        return query[within], point[within], square[within]

    def nearest(self, queries: Floats) -> tuple[Ints, Ints, Ints]:
        """Of the pairs of `near`, for each query that has any the one least apart; of two alike the first point."""
        query, point, square = self.near(queries)
        if not len(query):
            return query, point, square
        begins = np.flatnonzero(np.diff(query, prepend=-1))
        best = np.minimum.reduceat(square * len(self._points) + point, begins)
        return query[begins], best % len(self._points), best // len(self._points)
