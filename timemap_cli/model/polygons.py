"""Polygons on a raster: how many of them cover each cell."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class Raster:
    """Square cells along the axes; cell (row 0, column 0) begins at the origin."""

    origin_x: float  # [m]
    origin_y: float  # [m]
    resolution: float  # [m]
    rows: int
    columns: int

    def cells_of(self, points: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Rows and columns of the cells that hold points (k, 2) [m]; the points must lie on the raster."""
        steps = np.floor((points - (self.origin_x, self.origin_y)) / self.resolution).astype(np.intp)
        return np.clip(steps[:, 1], 0, self.rows - 1), np.clip(steps[:, 0], 0, self.columns - 1)


def count_cover(polygons: Iterable[npt.NDArray[np.float64]], raster: Raster) -> npt.NDArray[np.int16]:
    """How many polygons hold the centre of each cell: (rows, columns).

    `polygons`: arrays (k, corners, 2) [m], closed, counter-clockwise, on the raster. Every edge leaves +1 or
    -1 where it crosses the line through a row's cell centres; a sum along each row turns these into counts.
    That costs as much as the outlines are long, however large the areas.
    """
    change = np.zeros((raster.rows, raster.columns + 1), np.int16)
    for block in polygons:
        row, column, sign = _crossings(block, raster)
        np.add.at(change.reshape(-1), row * (raster.columns + 1) + column, sign)
    np.cumsum(change, axis=1, out=change)
    return change[:, :-1]


def _crossings(
    polygons: npt.NDArray[np.float64], raster: Raster
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.int16]]:
    """Row, first column on the right, and sign of each crossing; an edge has its lower end, not its upper."""
    corner = (polygons - (raster.origin_x, raster.origin_y)) / raster.resolution
    corner -= 0.5  # whole at cell centres
    after = np.roll(corner, -1, axis=1)
    x, y = corner.reshape(-1, 2).T
    step_x, step_y = (after - corner).reshape(-1, 2).T
    first = np.ceil(np.minimum(y, after[..., 1].ravel())).astype(np.intp)
    count = np.ceil(np.maximum(y, after[..., 1].ravel())).astype(np.intp) - first
    edge = np.repeat(np.arange(len(x)), count)
    start = np.cumsum(count) - count
    row = np.arange(len(edge)) - (start - first)[edge]
    column = np.ceil(x[edge] + (row - y[edge]) / step_y[edge] * step_x[edge]).astype(np.intp)
    sign = np.where(step_y > 0, -1, 1).astype(np.int16)[edge]  # the inside is left of a rise
    return row, np.clip(column, 0, raster.columns), sign
