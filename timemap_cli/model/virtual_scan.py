"""From a scan to what it would have been from a node's centre (paper, eq. 1 and 2, and what they leave open)."""

import math
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from timemap_cli.model.line_of_sight import FAR, MILLIMETRES, Sight, line_of_sight
from timemap_cli.model.outline import Outlines, outlines
from timemap_cli.model.sweeps import Sweeps

UNSEEN = 65535  # no evidence in this angle bin
CLEAR = 65534  # nothing out to the node's radius
_BLOCKED = 65533  # not UNSEEN only in that something stands in the way
MAX_RADIUS = 60.0  # [m] what 16 bits of millimetres hold, with room for the codes

SIGHT_TOLERANCE = 100  # [mm] by which a hit may lie behind the outline: noise, and pose error within a scan
HOLE_EDGE = np.float32(0.2)  # [m] two hits no farther apart than this are one surface

Ranges = npt.NDArray[np.uint16]
Bools = npt.NDArray[np.bool_]

_BLOCK = 48  # scans at a time at most, so that the work stays in the processor's cache


def virtual_scans(
    sweeps: Sweeps, centres: npt.NDArray[np.float64], ways_free: Bools, angle_bins: int, radius: float
) -> tuple[Ranges, Bools]:
    """What n scans would have been from n node centres (n, 2) [m, map frame].

    `ways_free` (n,): the way from the laser to the node is known to be free (`FreeWays`), so the scan need not see it.
    Returns ranges (n, angle_bins) [mm], measured ones or CLEAR or UNSEEN, and whether the scan can judge its node at
    all (n,): the node's centre must lie in what the scan saw free, and some beam must be evidence.
    """
    ranges = np.empty((len(sweeps), angle_bins), np.uint16)
    judged = np.empty(len(sweeps), np.bool_)
    blocks = -(-len(sweeps) // _BLOCK)
    borders = [len(sweeps) * i // max(1, blocks) for i in range(blocks + 1)]
    for start, stop in pairwise(borders):
        part = slice(start, stop)
        ranges[part], judged[part] = _from_nodes(
            sweeps.rows(part), centres[part], ways_free[part], angle_bins, radius
        )
    return ranges, judged


def _from_nodes(
    sweeps: Sweeps, centres: npt.NDArray[np.float64], ways_free: Bools, angle_bins: int, radius: float
) -> tuple[Ranges, Bools]:
    outline = outlines(sweeps, centres, ways_free, angle_bins)
    sight = line_of_sight(outline, angle_bins)
    distance = _distances(outline)
    reach = math.floor(radius * 1000 + 1e-6)
    ranges = _nearest_hits(outline, sight, distance, reach)
    empty = ranges == UNSEEN
    ranges[empty & _clear(outline, sight, distance, reach)] = CLEAR
    _close_holes(ranges, empty, outline, sight, distance, reach)
    ranges[ranges == _BLOCKED] = UNSEEN
    ranges[~sight.encloses] = UNSEEN
    return ranges, sight.encloses & ~outline.disc.all(axis=1)


def _distances(outline: Outlines) -> npt.NDArray[np.float32]:
    """Distance of every vertex from the node [mm, whole, at most FAR] (n, vertices + 1)."""
    distance: npt.NDArray[np.float32] = outline.x * outline.x
    distance += outline.y * outline.y
    np.sqrt(distance, out=distance)
    distance *= MILLIMETRES
    np.rint(distance, out=distance)
    np.minimum(distance, np.float32(FAR), out=distance)
    return distance


def _nearest_hits(outline: Outlines, sight: Sight, distance: npt.NDArray[np.float32], reach: int) -> Ranges:
    """The nearest hit in each angle bin (n, angle_bins) that nothing hides from the node.

    Where none is, _BLOCKED if the outline has another vertex there within reach, else UNSEEN.
    """
    n, angle_bins = sight.free.shape
    near = distance <= reach
    near[:, -1] = False
    cell = sight.bearing.astype(np.int64)
    cell += np.arange(0, n * angle_bins, angle_bins)[:, None]
    value = distance.astype(np.uint16)
    value[~outline.hit] = _BLOCKED
    # A hit can only be hidden where the outline runs backwards: elsewhere each ray leaves it once, at the hit itself.
    doubtful = np.flatnonzero(near & outline.hit & sight.folded.ravel().take(cell))
    free = _free_towards(sight, cell.ravel().take(doubtful), sight.bearing.ravel().take(doubtful))
    hidden = doubtful[distance.ravel().take(doubtful) > free + SIGHT_TOLERANCE]
    value.reshape(-1)[hidden] = _BLOCKED
    cell[~near] = n * angle_bins  # beside the table
    nearest = np.full(n * angle_bins + 1, UNSEEN, np.uint16)
    np.minimum.at(nearest, cell.reshape(-1), value.reshape(-1))
    return nearest[:-1].reshape(n, angle_bins)


def _free_towards(
    sight: Sight, cell: npt.NDArray[np.int64], bearing: npt.NDArray[np.float32]
) -> npt.NDArray[np.float32]:
    """Free distance [mm] at bearings between two borders, interpolated."""
    rays = sight.free.shape[1]
    free = sight.free.ravel()
    following = cell + 1
    following[following % rays == 0] -= rays
    here, there = free.take(cell).astype(np.float32), free.take(following).astype(np.float32)
    return np.asarray(here + (bearing - np.floor(bearing)) * (there - here), np.float32)


def _clear(outline: Outlines, sight: Sight, distance: npt.NDArray[np.float32], reach: int) -> Bools:
    """Angle bins (n, angle_bins) of which both borders were seen free beyond the radius."""
    far = sight.free > reach
    if (outline.disc & (distance > reach)).any():  # else no ray ends so far away on the robot's own disc
        row, ray = np.nonzero(far)
        edge = sight.edge[row, ray].astype(np.int64)
        far[row, ray] = ~(outline.disc[row, edge] & outline.disc[row, edge + 1])
    return np.asarray(far & np.roll(far, -1, axis=1))


def _close_holes(
    ranges: Ranges,
    empty: Bools,
    outline: Outlines,
    sight: Sight,
    distance: npt.NDArray[np.float32],
    reach: int,
) -> None:
    """Give an angle bin between two near hits of one surface the range of the nearer, in place."""
    same = sight.edge == np.roll(sight.edge, -1, axis=1)
    row, column = np.nonzero(empty & same & (sight.free <= reach))
    edge = sight.edge[row, column].astype(np.int64)
    surface = outline.hit[row, edge] & outline.hit[row, edge + 1]
    row, column, edge = row[surface], column[surface], edge[surface]
    dx = outline.x[row, edge + 1] - outline.x[row, edge]
    dy = outline.y[row, edge + 1] - outline.y[row, edge]
    nearer = np.minimum(distance[row, edge], distance[row, edge + 1])
    closed = (dx * dx + dy * dy <= HOLE_EDGE * HOLE_EDGE) & (nearer <= reach)
    ranges[row[closed], column[closed]] = nearer[closed].astype(np.uint16)
