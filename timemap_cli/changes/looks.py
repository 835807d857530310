"""How the nodes of a side look at surface points: they show a surface there, see past it, or cannot tell."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from timemap_cli.changes.bins import seen_past, step
from timemap_cli.changes.rings import Bools, Floats, Ints
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side
from timemap_cli.model.angles import quarter_turns
from timemap_cli.model.elementary import lengths

_PAIRS_AT_ONCE = 1 << 18  # of a point and a node; bounds the memory


@dataclass(frozen=True, slots=True)
class Looks:
    """k looks of nodes at points that could tell."""

    points: Ints  # (k,) number of the point
    rows: Ints  # (k,) row of the node
    bins: Ints  # (k,) angle bin of the point, seen from the node
    ranges: Floats  # (k,) [m] how far the point is from the node
    past: Bools  # (k,) the node sees past the point; else it shows a surface there
    seen_ns: Ints  # (k,) newest scan of the angle bin


def looks(points: Floats, side: Side, rules: Rules) -> Iterator[Looks]:
    """All looks of a side's nodes at points (n, 2) [m, map frame] that could tell, all of one point together.

    A node shows a point where a firm angle bin within `edge_deg` ends within a step of it; it sees past it where the
    firm angle bin towards it, and all known ones within `edge_deg`, end farther than that. Else it cannot tell: it
    does not know, or something stands before.
    """
    for some, rows in _together(points, side):
        yield _look(points, some, rows, side, rules)


def _together(points: Floats, side: Side) -> Iterator[tuple[Ints, Ints]]:
    """Points that lie together, and the rows of the nodes that may have them in reach."""
    radius, centres = side.places.radius, side.places.centres
    tiles = np.floor(points / radius).astype(np.int64)
    order = np.lexsort((tiles[:, 1], tiles[:, 0]))
    borders = np.flatnonzero(np.any(np.diff(tiles[order], axis=0) != 0, axis=1)) + 1
    for tile in np.split(order, borders):
        if not len(tile):
            continue
        low, high = points[tile].min(axis=0) - radius, points[tile].max(axis=0) + radius
        rows = np.flatnonzero(((centres >= low) & (centres <= high)).all(axis=1))
        at_once = max(1, _PAIRS_AT_ONCE // max(1, len(rows)))
        for begin in range(0, len(tile) if len(rows) else 0, at_once):
            yield tile[begin : begin + at_once], rows


def _look(points: Floats, some: Ints, rows: Ints, side: Side, rules: Rules) -> Looks:
    """The looks of the nodes in `rows` (k,) at the points numbered `some` (n,)."""
    places = side.places
    point, row = (each.reshape(-1) for each in np.meshgrid(some, rows, indexing="ij"))
    offset = points[point] - places.centres[row]
    ranges = lengths(offset)
    within = np.flatnonzero(ranges <= places.radius)
    point, row, ranges = point[within], row[within], ranges[within]
    bins = _bins_towards(offset[within], places.angle_bins)
    at = row * places.angle_bins + bins
    in_sight = side.farthest.take(at) >= ranges - step(ranges, rules)  # else something is before it
    point, row, bins, at = point[in_sight], row[in_sight], bins[in_sight], at[in_sight]
    ranges = ranges[in_sight]
    past = side.firm.take(at) & seen_past(ranges, side.nearest.take(at), places.radius, rules)
    shown = np.zeros(len(at), np.bool_)
    rest = np.flatnonzero(~past)
    shown[rest] = _shown(row[rest], bins[rest], ranges[rest], side, rules)
    told = np.flatnonzero(past | shown)
    seen_ns = side.rings.last_seen_ns.take(at[told])
    return Looks(point[told], row[told], bins[told], ranges[told], past[told], seen_ns)


def _shown(rows: Ints, bins: Ints, ranges: Floats, side: Side, rules: Rules) -> Bools:
    """Whether a firm angle bin within `edge_deg` of these (k,) ends within a step of the range [m]."""
    found = np.zeros(len(rows), np.bool_)
    by = step(ranges, rules)
    edge = side.places.edge_bins(rules)
    for shift in range(-edge, edge + 1):
        at = rows * side.places.angle_bins + (bins + shift) % side.places.angle_bins
        found |= side.firm.take(at) & (np.abs(side.rings.ranges.take(at) - ranges) <= by)
    return found


def _bins_towards(offset: Floats, angle_bins: int) -> Ints:
    """Angle bin (n,) in which a point (n, 2) [m] from the node lies."""
    turned = quarter_turns(offset[:, 0].astype(np.float32), offset[:, 1].astype(np.float32))
    return (turned * np.float32(angle_bins / 4)).astype(np.int64) % angle_bins
