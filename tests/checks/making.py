"""Snapshots of a square room with a box in it, seen from three nodes."""

from dataclasses import replace

import numpy as np

from timemap_cli.checks.snapshot import Input, LevelRings, Scans, SeenEvent, Snapshot
from timemap_cli.model.nodes import Node

BINS = 360
NODES = (Node(1.0, 1.0), Node(3.0, 1.0), Node(2.0, 3.0))
SECOND = 1_000_000_000
EVENT = SeenEvent("appeared", 2.0, 2.0, 0.5, 3, 100 * SECOND, None, ("short",))
WALLS = np.array([[0, 0, 4, 0], [4, 0, 4, 4], [4, 4, 0, 4], [0, 4, 0, 0]], float)


def box(x, y, side=0.6):
    """Four walls (4, 4) around a box with its centre at x, y."""
    low, high = -side / 2, side / 2
    corners = np.array([[low, low], [high, low], [high, high], [low, high]]) + np.array([x, y])
    return np.concatenate([corners, np.roll(corners, -1, axis=0)], axis=1)


def seen(nodes, walls, turn=0.0, shift=(0.0, 0.0)):
    """Ranges (nodes, BINS) [m] to the nearest wall; turned about each node, then shifted, as a wrong pose would."""
    bearings = (np.arange(BINS) + 0.5) * (2 * np.pi / BINS) - turn
    rows = []
    for node in nodes:
        start = np.array([node.x, node.y]) - shift
        to = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)[:, None]
        one, along = walls[None, :, :2] - start, (walls[:, 2:] - walls[:, :2])[None]
        cross = to[..., 0] * along[..., 1] - to[..., 1] * along[..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (one[..., 0] * along[..., 1] - one[..., 1] * along[..., 0]) / cross
            share = (one[..., 0] * to[..., 1] - one[..., 1] * to[..., 0]) / cross
        hit = (distance > 0) & (share >= 0) & (share <= 1)
        rows.append(np.where(hit, distance, np.inf).min(axis=1))
    return np.array(rows)


def rings(ranges):
    support = np.full(len(ranges), 0.9)
    return LevelRings(np.round(ranges, 2), support, tuple(f"{i:012x}" for i in range(len(ranges))))


def snapshot(ranges=None, **more):
    ranges = seen(NODES, np.concatenate([WALLS, box(2.0, 1.8)])) if ranges is None else ranges
    plain = Snapshot(
        version="1.0",
        inputs=(Input("monday.mcap", "aa"),),
        settings={"map.radius": 10.0, "levels.short.half_life": "5obs"},
        map_frame="map",
        radius=10.0,
        angle_bins=BINS,
        no_return="ignore",
        beams={"/scan": {"hit": 0.99, "no_return": 0.01}},
        scans=Scans(1000, 990, {"no_pose": 10}),
        nodes=NODES,
        levels={"short": rings(ranges)},
        events=(EVENT,),
    )
    return replace(plain, **more)
