"""A small result: three nodes in a rectangular room, three levels, two recordings."""

import math
from pathlib import Path

import numpy as np

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.results.writer import ResultWriter

LEVELS = ("short", "mid", "long")
RADIUS = 5.0
SECOND = 1_000_000_000
T0 = 1_700_000_000_123_456_789
WIDTH, HEIGHT = 6.0, 4.0  # [m] the room's walls: x = 0, x = 6, y = 0, y = 4; an open door in x = 6
NODES = (Node(1.5, 2.0), Node(3.0, 1.25), Node(4.5, 2.0))
CONFIG = "seed: 0  # Größe\n"
REPORT = {
    "schema": "timemap.report/1",
    "nodes": 2,
    "scans": {"read": 12, "used": 12, "dropped": {}},
    "note": "größer",
}
CHANGES = {"schema": "timemap.changes/1", "events": [], "summary": {"events": 0}}


def room_ranges(node: Node, bins: int = 360) -> np.ndarray:
    """Ranges to the walls from a node; clear where they are beyond the radius or in the door, some unknown."""
    ranges = np.empty(bins, np.float32)
    for i in range(bins):
        bearing = (i + 0.5) * 2 * math.pi / bins
        c, s = math.cos(bearing), math.sin(bearing)
        to_x = (WIDTH - node.x) / c if c > 0 else -node.x / c
        to_y = (HEIGHT - node.y) / s if s > 0 else -node.y / s
        in_door = c > 0 and to_x < to_y and abs(node.y + to_x * s - 3.0) < 0.4
        wall = min(to_x, to_y)
        ranges[i] = math.inf if in_door or wall > RADIUS else wall
    ranges[bins // 2 : bins // 2 + 3] = np.nan
    return ranges


def estimate(node: int, level: str, stamp_ns: int, bins: int = 360, seed: int = 0) -> Estimate:
    """The room from a node, with numbers of no special form beside the ranges."""
    rng = np.random.default_rng(seed)
    return Estimate(
        node,
        level,
        stamp_ns,
        room_ranges(NODES[node], bins),
        rng.random(bins, np.float32),
        rng.random(bins, np.float32),
        rng.integers(0, 65536, bins, np.uint16),
        rng.integers(0, 4, bins, np.uint8),
        rng.integers(0, 2**31 * SECOND, bins),  # all that the seconds of a message hold
    )


def all_levels(node: int, stamp_ns: int, seed: int) -> list[Estimate]:
    return [estimate(node, level, stamp_ns, seed=3 * seed + i) for i, level in enumerate(LEVELS)]


def new_writer(path: Path, **settings) -> ResultWriter:
    defaults = {"levels": LEVELS, "angle_bins": 360, "radius": RADIUS, "map_frame": "map"}
    return ResultWriter(path, **(defaults | settings))


def write_room(path: Path) -> dict[tuple[str, int], list[Estimate]]:
    """Write the result; returns its estimates by level and node, in the order of their stamps."""
    told: dict[tuple[str, int], list[Estimate]] = {}
    newest: dict[str, dict[int, Estimate]] = {level: {} for level in LEVELS}
    with new_writer(path) as writer:
        for step, nodes_seen in enumerate([(0,), (0, 1), (1,), (1, 2), (2, 0)]):
            now_ns = T0 + 10 * SECOND * step
            writer.write_nodes(NODES[: 1 + max(nodes_seen)] if step < 4 else NODES, now_ns)
            batch = [
                one
                for i, node in enumerate(reversed(nodes_seen))
                for one in all_levels(node, now_ns - i * SECOND, seed=10 * step + i)
            ]
            writer.write_estimates(batch, now_ns)
            for one in batch:
                told.setdefault((one.level, one.node), []).append(one)
                newest[one.level][one.node] = one
            if step in (2, 4):
                writer.write_maps(newest, NODES[: len(newest["short"])], now_ns)
        writer.finish({"seed": "0", "inputs": "a.bag"}, CONFIG, REPORT, CHANGES)
    return told
