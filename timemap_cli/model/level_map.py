"""One level of all nodes together: as points, and as an occupancy grid."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.polygons import Raster, count_cover

UNKNOWN, FREE, OCCUPIED = -1, 0, 100

_SAME_SURFACE = 0.2  # [m] neighbouring ends no farther apart than this are joined
_MAX_CELLS = 1 << 24
_NODES_AT_ONCE = 256  # bounds the memory

_Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class OccupancyGrid:
    """A level seen from above, axes along the map's."""

    cells: npt.NDArray[np.int8]  # (rows along +y, columns along +x): UNKNOWN, FREE or OCCUPIED
    resolution: float  # [m] side of a cell
    origin_x: float  # [m] map frame, lower left corner of cell (0, 0); a multiple of the resolution
    origin_y: float  # [m]


def merged_points(nodes: Sequence[Node], estimates: Mapping[int, Estimate]) -> npt.NDArray[np.float32]:
    """The ends of all finite ranges, node by node, bin by bin.

    Returns (k, 3): x [m], y [m] in the map frame, support.
    """
    if not estimates:
        return np.empty((0, 3), np.float32)
    ranges = np.stack([e.ranges for e in estimates.values()])
    support = np.stack([e.support for e in estimates.values()])
    hit = np.isfinite(ranges)
    ends = _centres(nodes, estimates)[:, None] + _ends(np.where(hit, ranges, 0.0))
    return np.column_stack((ends[hit], support[hit])).astype(np.float32)


def occupancy_grid(
    nodes: Sequence[Node], estimates: Mapping[int, Estimate], radius: float, resolution: float = 0.05
) -> OccupancyGrid:
    """A level as a grid: clear angle bins free cells out to the radius [m], finite ones out to their range.

    A cell is occupied where an end lies in it, or the line between two neighbouring ends of one surface; else
    free where a node sees into it; else unknown. Occupied wins, whichever node says so: who plans with the
    grid should rather go round a thing that has left than into one that stands. The resolution [m] is doubled
    until the grid has at most 2 ** 24 cells.
    """
    ranges = np.stack([e.ranges for e in estimates.values()]) if estimates else np.empty((0, 1), np.float32)
    centres = _centres(nodes, estimates)
    outlines = [
        centres[part, None] + _outlines(ranges[part], radius)
        for part in (slice(i, i + _NODES_AT_ONCE) for i in range(0, len(ranges), _NODES_AT_ONCE))
    ]
    raster = _raster_round(outlines, resolution)
    cells = np.full((raster.rows, raster.columns), UNKNOWN, np.int8)
    cells[count_cover(outlines, raster) > 0] = FREE
    for first, outline in zip(range(0, len(ranges), _NODES_AT_ONCE), outlines, strict=True):
        part = slice(first, first + len(outline))
        row, column = raster.cells_of(_surface(ranges[part], centres[part]))
        cells[row, column] = OCCUPIED
    return OccupancyGrid(cells, raster.resolution, raster.origin_x, raster.origin_y)


def _centres(nodes: Sequence[Node], estimates: Mapping[int, Estimate]) -> _Floats:
    """(k, 2) [m] map frame: where the node of each estimate stands."""
    return np.array([(nodes[e.node].x, nodes[e.node].y) for e in estimates.values()]).reshape(-1, 2)


@lru_cache(maxsize=8)
def _directions(angle_bins: int) -> tuple[_Floats, _Floats]:
    """Unit vectors (angle_bins, 2) to the centre of each angle bin, and to its border with the next."""
    halves = np.arange(1.0, 2 * angle_bins + 1)
    turned = np.stack(cos_sin(halves * (math.pi / angle_bins)), axis=1)
    return turned[::2], turned[1::2]


def _ends(ranges: npt.NDArray[np.floating]) -> _Floats:
    """(k, bins) [m] -> (k, bins, 2) [m] relative to the node."""
    return ranges[..., None] * _directions(ranges.shape[1])[0]


def _joined(ranges: npt.NDArray[np.float32], ends: _Floats) -> npt.NDArray[np.bool_]:
    """(k, bins): the end of this angle bin and that of the next lie on one surface."""
    step = np.roll(ends, -1, axis=1) - ends
    with np.errstate(invalid="ignore"):
        near = (step**2).sum(axis=2) <= _SAME_SURFACE**2
    hit = np.isfinite(ranges)
    return np.asarray(near & hit & np.roll(hit, -1, axis=1))


def _outlines(ranges: npt.NDArray[np.float32], radius: float) -> _Floats:
    """What each node sees free, as a closed polygon counter-clockwise: (k, 3 * bins, 2) [m] from the node.

    Per angle bin its end, then two corners at the border with the next bin: both on the line between the ends
    where they belong to one surface; else both at the nearer range, so that nothing is freed behind a wall
    seen at a flat angle. An unknown bin has its corners at the node.
    """
    reach = np.where(np.isposinf(ranges), radius, np.nan_to_num(ranges.astype(np.float64), nan=0.0))
    ends = _ends(reach)
    known = reach > 0
    next_reach, next_known = np.roll(reach, -1, axis=1), np.roll(known, -1, axis=1)
    nearer = np.minimum(reach, next_reach)
    border = _directions(ranges.shape[1])[1]
    corner = np.where(known & next_known, nearer, reach)[..., None] * border
    next_corner = np.where(known & next_known, nearer, next_reach)[..., None] * border
    joined = _joined(ranges, ends)[..., None]
    middle = (ends + np.roll(ends, -1, axis=1)) / 2
    corners = (ends, np.where(joined, middle, corner), np.where(joined, middle, next_corner))
    return np.stack(corners, axis=2).reshape(len(ranges), -1, 2)


def _surface(ranges: npt.NDArray[np.float32], centres: _Floats) -> _Floats:
    """(k, 2) [m] map frame: all ends, and points between those of one surface."""
    hit = np.isfinite(ranges)
    ends = centres[:, None] + _ends(np.where(hit, ranges, 0.0))
    joined = _joined(ranges, ends)
    start, step = ends[joined], (np.roll(ends, -1, axis=1) - ends)[joined]
    return np.concatenate([ends[hit], *(start + share * step for share in (0.25, 0.5, 0.75))])


def _raster_round(outlines: Sequence[_Floats], resolution: float) -> Raster:
    """The smallest raster of whole cells that holds all outlines."""
    if not outlines:
        return Raster(0.0, 0.0, resolution, 1, 1)
    low = np.min([o.min(axis=(0, 1)) for o in outlines], axis=0)
    high = np.max([o.max(axis=(0, 1)) for o in outlines], axis=0)
    while True:
        first = np.floor(low / resolution)
        columns, rows = np.floor(high / resolution) - first + 1  # floats: int64 may not hold their product
        if rows * columns <= _MAX_CELLS:
            origin_x, origin_y = first * resolution
            return Raster(float(origin_x), float(origin_y), resolution, int(rows), int(columns))
        resolution *= 2
