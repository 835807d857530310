"""Surfaces that a node still shows because nobody passed it again, while others have seen past them since."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from timemap_cli.changes.events import Event
from timemap_cli.changes.hull import hull
from timemap_cli.changes.nearby import near
from timemap_cli.changes.rings import Bools, Floats
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side
from timemap_cli.changes.testimony import testimony
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node

_GHOST = 0.5  # share of the nodes that can tell and see past it; a wall in doubt stays, as who plans should go round
_OF_EVENT_M = 0.3  # a surface so near to the points of what is gone is a part of it, whenever it was seen
_DEFAULT = Rules()


def without_ghosts(
    nodes: Sequence[Node],
    estimates: Mapping[int, Estimate],
    vanished: Sequence[Event],
    radius: float,
    rules: Rules = _DEFAULT,
) -> dict[int, Estimate]:
    """Estimates of one level, by node, whose angle bins are unknown where they end at a ghost.

    A ghost is what most of the nodes that looked lately see past, and what lies in the outline of an event of
    `vanished`: near its points, or not seen since the event last was. `radius` [m] is how far a node sees.
    """
    if not estimates:
        return {}
    side = Side.of(estimates, nodes, radius, rules)
    rows, bins = np.nonzero(np.isfinite(side.rings.ranges))
    ends = side.ends(rows, bins)
    ghost = testimony(ends, side, rules).contradicted(_GHOST)
    seen_ns = side.rings.last_seen_ns[rows, bins]
    for event in vanished:
        inside = np.flatnonzero(_inside(ends, hull(event.points)))
        is_part = near(ends[inside], event.points, _OF_EVENT_M) | (seen_ns[inside] <= event.last_seen_ns)
        ghost[inside[is_part]] = True
    ranges = side.rings.ranges.astype(np.float32)
    ranges[rows[ghost], bins[ghost]] = np.nan
    numbers = side.places.numbers.tolist()
    return {number: replace(estimates[number], ranges=ranges[row]) for row, number in enumerate(numbers)}


def _inside(points: Floats, corners: Floats) -> Bools:
    """Which of the points (n, 2) lie in the convex polygon (k, 2), counter-clockwise, its border included."""
    along = np.roll(corners, -1, axis=0) - corners
    offset = points[:, None] - corners
    return np.asarray((along[:, 0] * offset[..., 1] - along[:, 1] * offset[..., 0] >= 0).all(axis=1))
