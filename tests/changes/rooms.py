"""Rings as a perfect scanner would measure them: boxes in a round room, by ray casting."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Difference
from timemap_cli.changes.rules import Rules
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.status import Status

RADIUS = 10.0
WALL = 5.0
CENTRE = Node(0.0, 0.0)


@dataclass(frozen=True)
class Box:
    """An upright box, axis-aligned, by its centre and side lengths."""

    x: float
    y: float
    width: float = 0.6
    depth: float = 0.6


def ring(
    node: Node, boxes: Sequence[Box] = (), wall: float = WALL, bins: int = 360
) -> npt.NDArray[np.float32]:
    """Ranges from the node to the nearest box or the round wall about the origin; +inf beyond the radius."""
    bearings = (np.arange(bins) + 0.5) * 2 * np.pi / bins
    u, v = np.cos(bearings), np.sin(bearings)
    along = node.x * u + node.y * v
    ranges = -along + np.sqrt(along**2 + wall**2 - node.x**2 - node.y**2)
    for box in boxes:
        ranges = np.minimum(ranges, _to_box(node, box, u, v))
    return np.where(ranges > RADIUS, np.inf, ranges).astype(np.float32)


def _to_box(node: Node, box: Box, u, v):
    """The slab method: the last entry into both slabs lies before the first exit."""
    with np.errstate(divide="ignore"):
        x = (np.array([[-1.0], [1.0]]) * box.width / 2 + box.x - node.x) / u
        y = (np.array([[-1.0], [1.0]]) * box.depth / 2 + box.y - node.y) / v
    enter = np.maximum(x.min(axis=0), y.min(axis=0))
    leave = np.minimum(x.max(axis=0), y.max(axis=0))
    return np.where((enter <= leave) & (enter > 0), enter, np.inf)


def estimate(node: int, ranges, *, stamp_ns: int = 1, samples: int = 20, support: float = 0.9):
    """An estimate whose every bin has the given support and samples."""
    ranges = np.asarray(ranges, dtype=np.float32)
    full = np.ones(len(ranges), dtype=np.float32)
    return Estimate(
        node=node,
        level="mid",
        stamp_ns=stamp_ns,
        ranges=ranges,
        support=support * full,
        known=full,
        samples=np.full(len(ranges), samples, dtype=np.uint16),
        status=np.full(len(ranges), Status.MEASURED, np.uint8),
        last_seen_ns=np.full(len(ranges), stamp_ns),
    )


def compare_rings(before, after, rules: Rules | None = None, nodes: Sequence[Node] = (CENTRE,)) -> Difference:
    """Compares one ring, or a list of one per node, given as bare ranges."""
    before, after = (rings if isinstance(rings, list) else [rings] for rings in (before, after))
    old = {i: estimate(i, r, stamp_ns=1) for i, r in enumerate(before)}
    new = {i: estimate(i, r, stamp_ns=2) for i, r in enumerate(after)}
    return compare(nodes, old, new, rules or Rules(), radius=RADIUS)
