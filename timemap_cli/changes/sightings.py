"""What each node says of a surface: it stands there, one sees past it, or the node cannot tell."""

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.bins import seen_past, step
from timemap_cli.changes.rings import Floats, Ints, Places, Rings
from timemap_cli.changes.rules import Rules
from timemap_cli.model.elementary import bearings, lengths

STANDS, UNTOLD, GONE = 1, 0, -1
Words = npt.NDArray[np.int8]

_CAN_TELL = 0.3  # of the points: a thing has sides that a node does not see
_AGREE = 2 / 3  # of those it can tell of: less is a thing half seen, and no word


def words(points: Floats, side: Rings, places: Places, rules: Rules) -> Words:
    """Each row's word (rows,) on the surface `points` (n, 2) [m, map frame]: STANDS, GONE or UNTOLD."""
    rows, bins, ranges = towards(points, places)
    seen, by = side.ranges[rows, bins], step(ranges, rules)
    firm = side.firm(rules, rules.min_samples)[rows, bins]
    firm &= side.last_seen_ns[rows, bins] >= side.stamps_ns[rows] - rules.max_age_ns
    stand = (firm & (np.abs(seen - ranges) <= by)).sum(axis=1)
    gone = (firm & seen_past(ranges, seen, places.radius, rules)).sum(axis=1)
    told = stand + gone
    can_tell = told >= np.maximum(_CAN_TELL * len(points), 1)
    said = np.zeros(len(side.ranges), np.int8)
    said[rows[:, 0]] = np.where(
        can_tell & (stand >= _AGREE * told),
        STANDS,
        np.where(can_tell & (gone >= _AGREE * told), GONE, UNTOLD),
    )
    return said


def towards(points: Floats, places: Places) -> tuple[Ints, Ints, Floats]:
    """Rows (k, 1) of the nodes within reach of some point, and each point's angle bin and range from there (k, n)."""
    offset = points[None, :, :] - places.centres[:, None, :]
    near = lengths(offset).min(axis=1) <= places.radius
    rows, offset = np.flatnonzero(near)[:, None], offset[near]
    turned = bearings(offset[..., 0], offset[..., 1])
    bins = np.floor(turned / places.bin_rad).astype(np.int64) % places.angle_bins
    return rows, bins, lengths(offset)
