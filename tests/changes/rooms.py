"""Rings as a perfect scanner would measure them: boxes in a round room, or rooms of boxes, by ray casting."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Difference
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.status import Status

RADIUS = 10.0
WALL = 5.0
OUTDOORS = 1000.0  # a round wall that no node sees
CENTRE = Node(0.0, 0.0)


@dataclass(frozen=True)
class Box:
    """An upright box by its centre and side lengths, along the axes unless it is turned counter-clockwise."""

    x: float
    y: float
    width: float = 0.6
    depth: float = 0.6
    turned_deg: float = 0.0


def wall(x_min: float, y_min: float, x_max: float, y_max: float) -> Box:
    """A wall along the axes, by its corners."""
    return Box((x_min + x_max) / 2, (y_min + y_max) / 2, x_max - x_min, y_max - y_min)


def walls(x_min: float, y_min: float, x_max: float, y_max: float) -> list[Box]:
    """The four walls of a room, 0.2 m thick, by its inner corners."""
    left, right, low, high = x_min - 0.2, x_max + 0.2, y_min - 0.2, y_max + 0.2
    sides = (
        (left, low, x_min, high),
        (x_max, low, right, high),
        (left, low, right, y_min),
        (left, y_max, right, high),
    )
    return [wall(*side) for side in sides]


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
    away, ray = complex(box.x - node.x, box.y - node.y), u + 1j * v
    if box.turned_deg:
        back = np.exp(-1j * np.radians(box.turned_deg))
        away, ray = away * back, ray * back
    with np.errstate(divide="ignore"):
        x = (np.array([[-1.0], [1.0]]) * box.width / 2 + away.real) / ray.real
        y = (np.array([[-1.0], [1.0]]) * box.depth / 2 + away.imag) / ray.imag
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


def estimates(
    nodes: Sequence[Node], boxes: Sequence[Box] = (), *, wall: float = WALL, stamp_ns: int = 1
) -> dict[int, Estimate]:
    """What each node sees of the same boxes, by its number."""
    return {i: estimate(i, ring(node, boxes, wall), stamp_ns=stamp_ns) for i, node in enumerate(nodes)}


def side_of(nodes: Sequence[Node], held: Mapping[int, Estimate], rules: Rules | None = None) -> Side:
    """One side of a comparison."""
    return Side.of(held, nodes, RADIUS, rules or Rules())
