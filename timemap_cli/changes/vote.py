"""What the nodes around say about a thing that one side has and the other has not."""

import numpy as np

from timemap_cli.changes.bins import seen_past, step
from timemap_cli.changes.rings import Bools, Floats, Ints, Places, Rings
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.things import Thing

_POINTS = 500  # enough to judge anything; keeps the memory small where a whole building differs


def is_believed(thing: Thing, having: Rings, lacking: Rings, places: Places, rules: Rules) -> bool:
    """True where more of the nodes that can tell saw the thing come or go than never had it, or none can tell.

    A node never had it where it saw past its points on the side that has it. A node that shows it on both sides,
    because it cannot tell it from what is behind or has not made up its mind yet, has no say; nor has one that
    can tell about less than half of the points from its place.
    """
    points = thing.points[:: -(-len(thing.points) // _POINTS)]
    agree, contradict = _count(points, having, lacking, places, rules)
    judges = 2 * (agree + contradict) >= len(points)
    in_favour = judges & (agree >= contradict)
    return not judges.any() or float(in_favour[judges].mean()) > rules.vote_share


def _count(points: Floats, having: Rings, lacking: Rings, places: Places, rules: Rules) -> tuple[Ints, Ints]:
    """How many of the points each node within reach agrees with, and contradicts, two (nodes,)."""
    offset = points[None, :, :] - places.centres[:, None, :]
    near = np.hypot(offset[..., 0], offset[..., 1]).min(axis=1) <= places.radius
    rows, offset = np.flatnonzero(near)[:, None], offset[near]
    ranges = np.hypot(offset[..., 0], offset[..., 1])
    bearings = np.arctan2(offset[..., 1], offset[..., 0])
    bins = np.floor(bearings / places.bin_rad).astype(np.int64) % places.angle_bins
    had, never = _look(having, rows, bins, ranges, places, rules)
    _, sees_past = _look(lacking, rows, bins, ranges, places, rules)
    often = having.firm(rules, rules.vote_samples)[rows, bins]
    agree = often & had & sees_past & lacking.firm(rules, rules.min_samples)[rows, bins]
    return agree.sum(axis=1), (often & never).sum(axis=1)


def _look(
    side: Rings, rows: Ints, bins: Ints, ranges: Floats, places: Places, rules: Rules
) -> tuple[Bools, Bools]:
    """Whether a side shows surfaces at `ranges`, within the edge tolerance, and whether it sees past them."""
    by = step(ranges, rules)
    shown = np.zeros(ranges.shape, dtype=np.bool_)
    for shift in range(-places.edge_bins(rules), places.edge_bins(rules) + 1):
        shown |= np.abs(side.ranges[rows, (bins + shift) % places.angle_bins] - ranges) <= by
    return shown, seen_past(ranges, side.ranges[rows, bins], places.radius, rules) & ~shown
