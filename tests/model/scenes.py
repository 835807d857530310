"""Rooms of straight walls, seen exactly: what the model's scans are made of and judged by."""

import math

import numpy as np

from timemap_cli.model.sweeps import Sweeps


def rectangle(left, bottom, right, top):
    """Segments (4, 4): x1, y1, x2, y2 [m] of a rectangle's sides."""
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    return np.array([(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)])


def pillar(x, y, size=0.4):
    return rectangle(x - size / 2, y - size / 2, x + size / 2, y + size / 2)


# A room with two pillars and a wall with a door in it; the smaller room behind the door is closed.
ROOM = np.concatenate(
    (
        rectangle(-4.0, -3.0, 5.0, 3.5),
        [(2.5, -3.0, 2.5, 0.3), (2.5, 1.2, 2.5, 3.5)],
        pillar(-2.0, 1.4),
        pillar(0.6, -1.9, 0.3),
    )
)


def cast(segments, x, y, bearings):
    """Exact distance [m] from (x, y) along each bearing [rad] to the nearest segment; inf where there is none.

    `x` and `y` are numbers, or one for each bearing.
    """
    x, y = np.broadcast_arrays(x, y, bearings)[:2]
    cos, sin = np.cos(bearings)[:, None], np.sin(bearings)[:, None]
    x1, y1, x2, y2 = segments.T
    dx, dy = x2 - x1, y2 - y1
    across = cos * dy - sin * dx
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = ((x1 - x[:, None]) * dy - (y1 - y[:, None]) * dx) / across
        along = ((x1 - x[:, None]) * sin - (y1 - y[:, None]) * cos) / across
    met = (distance > 0) & (along >= 0) & (along <= 1)
    return np.where(met, distance, np.inf).min(axis=1)


def pose(x, y, yaw=0.0, *, upside_down=False, z=0.3):
    """map_from_laser (3, 4) of a level scanner; upside down it is rolled by half a turn before it is turned."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    roll = -1.0 if upside_down else 1.0
    return np.array([[cos, -sin * roll, 0, x], [sin, cos * roll, 0, y], [0, 0, roll, z]])


def fan(beams, degrees, start_deg=None):
    """Bearings [rad] of so many beams over so many degrees, both ends included; negative degrees: clockwise."""
    start = -degrees / 2 if start_deg is None else start_deg
    return np.radians(start + np.arange(beams) * (degrees / max(1, beams - 1)))


def sweeps(ranges, bearings, poses, last_poses=None, *, clear_range=30.0, stamps_ns=None):
    """A block of scans; `poses` one (3, 4) for each row of `ranges`."""
    ranges = np.asarray(ranges, np.float32)
    first = np.asarray(poses, np.float64)
    if stamps_ns is None:
        stamps_ns = np.arange(len(ranges)) * 100_000_000
    last = first.copy() if last_poses is None else np.asarray(last_poses, np.float64)
    return Sweeps(
        np.asarray(stamps_ns, np.int64), ranges, np.asarray(bearings, np.float64), clear_range, first, last, 0
    )


def look_around(segments, x, y, yaw, bearings, *, upside_down=False, clear_range=30.0, noise=None):
    """One scan of a room, taken standing at (x, y, yaw)."""
    placed = pose(x, y, yaw, upside_down=upside_down)
    directions = map_directions(placed, bearings)
    ranges = cast(segments, x, y, directions)
    if noise is not None:
        ranges = ranges + noise.normal(0, 0.01, len(ranges))
    ranges[ranges > clear_range] = np.inf
    return sweeps([ranges], bearings, [placed], clear_range=clear_range)


def drive_past(segments, start, stop, bearings, *, upside_down=False, clear_range=30.0):
    """One scan taken while the robot moved evenly from `start` to `stop` (x, y, yaw each)."""
    part = np.arange(len(bearings)) / max(1, len(bearings) - 1)
    x, y, yaw = (np.asarray(a + (b - a) * part) for a, b in zip(start, stop, strict=True))
    turned = yaw + (-bearings if upside_down else bearings)
    ranges = cast(segments, x, y, turned)
    ranges[ranges > clear_range] = np.inf
    first, last = (pose(*place, upside_down=upside_down) for place in (start, stop))
    return sweeps([ranges], bearings, [first], [last], clear_range=clear_range)


def map_directions(placed, bearings):
    """Bearings [rad] in the map of a level scanner's beams."""
    x, y = placed[:2, 0, None] * np.cos(bearings) + placed[:2, 1, None] * np.sin(bearings)
    return np.arctan2(y, x)


def seen_from(segments, x, y, angle_bins, rays_per_bin=40):
    """Nearest and farthest true distance [m] in each angle bin (angle_bins, 2), as seen from (x, y)."""
    borders = np.arange(angle_bins * rays_per_bin) * (2 * math.pi / angle_bins / rays_per_bin)
    distance = cast(segments, x, y, borders).reshape(angle_bins, rays_per_bin)
    closing = np.roll(distance[:, :1], -1, axis=0)
    distance = np.concatenate((distance, closing), axis=1)
    return np.stack((distance.min(axis=1), distance.max(axis=1)), axis=1)
