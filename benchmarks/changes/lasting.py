"""Which turns last long enough for a slow level to tell them, at the nodes that see the place.

A level needs its half-life. A memory that is younger than that turns when it has seen the new for as long as the old:
its half-life is what it saw before the turn. As for adoption, 1.3 of them are to have gone by.
"""

from collections.abc import Sequence
from statistics import median

import numpy as np

from benchmarks.changes.places import Place
from benchmarks.changes.scores import MOST_HALF_LIVES
from benchmarks.changes.visits import Pace
from sample_logs.rays import Floats
from sample_logs.world import World

NEAR_M = 3.0  # between a node and the middle of a place
_SIDE_M = 0.5  # a wall so near before the middle of a place does not hide it


def lasting(
    places: Sequence[Place], pace: Pace, nodes: Sequence[tuple[float, float]], walls: Floats, end_ns: int
) -> list[Place]:
    """The places that hold long enough, at the median of the nodes near and in sight; none where there is no node.

    What undoes a turn that did not last is no lasting one either: the level never knew of it.
    """
    found: list[Place] = []
    for place in places:
        before = [p for p in places if p.change == place.change and p.until_ns == place.since_ns]
        until_ns = end_ns if place.until_ns is None else place.until_ns - 1
        near = in_sight(place, np.array(nodes), walls)
        held = _held(pace, near, place.since_ns, until_ns)
        if held and median(held) >= MOST_HALF_LIVES and all(p in found for p in before):
            found.append(place)
    return found


def _held(pace: Pace, nodes: Sequence[int], since_ns: int, until_ns: int) -> list[float]:
    """Half-lives that a turn holds, of the memory of each node that knew what was there before."""
    found = []
    for node in nodes:
        young = pace.half_lives([node], 0, since_ns - 1)
        if young > 0:
            found.append(pace.half_lives([node], since_ns, until_ns) / min(1.0, young))
    return found


def in_sight(place: Place, nodes: Floats, walls: Floats) -> list[int]:
    """Numbers of the nodes (n, 2) within `NEAR_M` of a place with no wall (m, 4) in between."""
    x_min, y_min, x_max, y_max = place.bounds
    way = np.array([(x_min + x_max) / 2, (y_min + y_max) / 2]) - nodes
    far = np.linalg.norm(way, axis=1)
    bearings = np.arctan2(way[:, 1], way[:, 0])[:, None]
    free = World(walls).ranges(np.zeros(len(nodes)), nodes[:, None], bearings, 2 * NEAR_M)[:, 0]
    near = np.flatnonzero((far <= NEAR_M) & (free >= far - _SIDE_M))
    return [int(node) for node in near]
