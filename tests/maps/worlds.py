"""Rooms of straight walls and boxes, seen from nodes by casting rays; and the same turned and shifted."""

import numpy as np

RADIUS = 10.0


def walls(*corners):
    """Segments (k, 2, 2) [m] from corner to corner, closed."""
    ring = np.array(corners, float)
    return np.stack((ring, np.roll(ring, -1, axis=0)), axis=1)


def box(x, y, width=0.8, depth=0.8, yaw=0.0):
    """The sides of an upright box about (x, y)."""
    half = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (width / 2, depth / 2)
    return walls(*moved(half, x, y, yaw))


def moved(points, dx, dy, yaw=0.0, pivot=(0.0, 0.0)):
    """Points turned by yaw [rad] about the pivot, then shifted."""
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    return (np.asarray(points) - pivot) @ turn.T + pivot + (dx, dy)


def seen(segments, nodes, bins=360, radius=RADIUS, noise=0.0, rng=None):
    """Where the rays of all nodes end within the radius: (n, 2) [m]."""
    bearings = (np.arange(bins) + 0.5) * 2 * np.pi / bins
    rays = np.stack((np.cos(bearings), np.sin(bearings)), axis=1)
    found = [_ends(segments, np.array(node, float), rays, radius, noise, rng) for node in nodes]
    return np.concatenate(found)


def _ends(segments, node, rays, radius, noise, rng):
    start, along = segments[:, 0] - node, segments[:, 1] - segments[:, 0]
    across = rays[:, None, 0] * along[:, 1] - rays[:, None, 1] * along[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / across
        share = (start[:, 0] * rays[:, None, 1] - start[:, 1] * rays[:, None, 0]) / across
    ranges = np.where((distance > 0) & (share >= 0) & (share <= 1), distance, np.inf).min(axis=1)
    hit = ranges <= radius
    if noise:
        ranges = ranges + rng.normal(0.0, noise, len(ranges))
    return node + ranges[hit, None] * rays[hit]


def hall(pieces):
    """A hall of 14 m by 10 m about the origin with pieces of furniture at (x, y, yaw)."""
    furniture = [box(x, y, 1.2, 0.6, yaw) for x, y, yaw in pieces]
    return np.concatenate([walls((-7, -5), (7, -5), (7, 5), (-7, 5)), *furniture])


def spots(rng, count, taken=()):
    """So many random places (x, y, yaw) in the hall, 1.6 m from each other, from those taken and from the walls."""
    found = list(taken)
    while len(found) < len(taken) + count:
        x, y = rng.uniform((-6, -4), (6, 4))
        if all(np.hypot(x - a, y - b) > 1.6 for a, b, _ in found):
            found.append((x, y, rng.uniform(0, np.pi)))
    return found[len(taken) :]


def free_nodes(rng, count, pieces):
    """Places in the hall at least a metre from the middle of all pieces."""
    found = []
    while len(found) < count:
        node = rng.uniform((-6.3, -4.3), (6.3, 4.3))
        if all(np.hypot(node[0] - x, node[1] - y) > 1.0 for x, y, _ in pieces):
            found.append(node)
    return found
