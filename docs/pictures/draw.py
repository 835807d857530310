"""Draw a level of a result, as in the README.

python docs/pictures/draw.py RESULT LEVEL OUT.png [FASTER_LEVEL]

Needs matplotlib. With a second level, what differs between the two is drawn on top.
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

from timemap_cli.comparing import Comparison, compare_levels
from timemap_cli.model.level_map import UNKNOWN, OccupancyGrid, merged_points, occupancy_grid
from timemap_cli.results.reader import ResultReader

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

COLOURS = {"appeared": "#c1440e", "vanished": "#1f6fb2", "moved": "#7b3fa0"}


def draw(result: Path, level: str, out: Path, faster: str | None = None) -> None:
    """Draw one level of a result: free space white, unknown grey, surfaces by their support."""
    with ResultReader(result) as reader:
        nodes, estimates = reader.nodes, reader.estimates(level)
        grid = occupancy_grid(nodes, estimates, reader.radius)
    points = merged_points(nodes, estimates)
    height, width = (side * grid.resolution for side in grid.cells.shape)
    figure, axes = plt.subplots(figsize=(11, 11 * height / width))
    axes.imshow(_shades(grid), origin="lower", extent=_extent(grid), interpolation="nearest")
    axes.scatter(
        points[:, 0], points[:, 1], c=0.35 - 0.35 * points[:, 2], s=0.8, cmap="gray", vmin=0, vmax=1, lw=0
    )
    axes.plot([node.x for node in nodes], [node.y for node in nodes], ".", color="#2a9d5c", ms=3)
    if faster:
        _draw_changes(axes, compare_levels(result, (level, faster)))
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.tight_layout()
    figure.savefig(out, dpi=80)


def _shades(grid: OccupancyGrid) -> np.ndarray:
    grey = np.where(grid.cells == UNKNOWN, 0.78, 1.0)
    return np.dstack([grey] * 3)


def _extent(grid: OccupancyGrid) -> tuple[float, float, float, float]:
    rows, columns = grid.cells.shape
    left, bottom = grid.origin_x, grid.origin_y
    return left, left + columns * grid.resolution, bottom, bottom + rows * grid.resolution


def _draw_changes(axes: Axes, comparison: Comparison) -> None:
    for change in comparison.difference.changes:
        left, bottom, right, top = change.bounds
        colour = COLOURS[change.kind.value]
        box = Rectangle(
            (left - 0.1, bottom - 0.1), right - left + 0.2, top - bottom + 0.2, fc="none", ec=colour, lw=2
        )
        axes.add_patch(box)
        axes.annotate(change.kind.value, (left - 0.1, top + 0.15), color=colour, fontsize=13, weight="bold")


if __name__ == "__main__":
    draw(Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3]), *sys.argv[4:5])
