"""A robot that drives through a room and looks around: scans for tests of the whole method."""

from itertools import pairwise

import numpy as np

from tests.model.scenes import ROOM, cast, fan, pillar, pose, sweeps
from timemap_cli.model.estimator import estimate
from timemap_cli.model.gate import Gate
from timemap_cli.model.levels import Level
from timemap_cli.model.observer import Observer
from timemap_cli.model.time_map import TimeMap

LEVELS = (Level("short", 7, 5.0), Level("mid", 10, 12.0), Level("long", 20, 8.0, in_seconds=True))
GATE = Gate(min_travel=0.05, min_turn=0.1, min_interval_ns=200_000_000)
ARRAYS = ("ranges", "support", "known", "samples", "status", "last_seen_ns")
OPEN_GATE = Gate(0.0, 0.0, 0)


def drive(scans, seed=0, *, beams=121, degrees=240):
    """Scans along a loop; a box stands there in the second half; some scans are taken moving, some standing."""
    random = np.random.default_rng(seed)
    angle = np.linspace(0, 4 * np.pi, scans) * 0.99
    x, y = 0.9 * np.cos(angle), 0.5 + 0.8 * np.sin(angle)
    yaw = angle + np.pi / 2 + random.normal(0, 0.05, scans)
    bearings = fan(beams, degrees)
    ranges, first, last = [], [], []
    for i in range(scans):
        room = np.concatenate((ROOM, pillar(1.9, 0.5, 0.5))) if i > scans / 2 else ROOM
        seen = cast(room, x[i], y[i], yaw[i] + bearings) + random.normal(0, 0.01, beams)
        seen[random.random(beams) < 0.03] = np.nan
        seen[random.random(beams) < 0.02] = np.inf
        ranges.append(seen)
        first.append(pose(x[i], y[i], yaw[i]))
        moves = 0.0 if i % 3 else 0.02
        last.append(pose(x[i] + moves, y[i], yaw[i] + moves))
    return sweeps(ranges, bearings, first, last)


def observer(*, angle_bins=72, radius=5.0, spacing=0.7, nodes=(), gate=GATE):
    return Observer(gate, angle_bins=angle_bins, radius=radius, spacing=spacing, nodes=nodes)


def time_map(*, levels=LEVELS, angle_bins=72, seed=0, nodes=()):
    return TimeMap(
        levels, lambda memory: estimate(memory, 0.1), angle_bins=angle_bins, seed=seed, nodes=nodes
    )


def replay(scans, cuts=(), *, levels=LEVELS, seed=0, parts=None, **settings):
    """Estimates at the end, by level and node, of scans taken in blocks that begin at `cuts`."""
    looking = observer(**settings)
    learning = time_map(levels=levels, seed=seed, nodes=settings.get("nodes", ()))
    borders = [0, *sorted(cuts), len(scans)]
    for start, stop in pairwise(borders):
        learning.learn(looking.observe(scans.rows(slice(start, stop))))
    return learning, {(found.level, found.node): found for found in learning.estimates()}


def as_bytes(estimates):
    """Everything that estimates say."""
    return {
        key: (
            found.stamp_ns,
            *(getattr(found, name).tobytes() for name in ARRAYS),
        )
        for key, found in estimates.items()
    }
