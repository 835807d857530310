"""A slow virtual scan: one scan, one node, plain loops in float64, exact intersections of ray and segment.

It follows the rule as it is written down, not the way the model computes it: every beam is followed, a hit's line of
sight is cut with every edge in its own direction, and the robot's disc is a circle of many corners.
"""

import math

import numpy as np

CLEAR = math.inf
UNSEEN = math.nan
HIT, FREE, DISC = "hit", "free", "disc"  # what a corner of the outline is


def slow_virtual_scan(scan, row, centre, angle_bins, radius):
    """Ranges (angle_bins,) [m] with inf for clear and NaN for unseen, or None if the scan cannot judge the node."""
    corners = _outline(scan, row, centre)
    turned = sum(_step(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))
    if abs(turned) < math.pi:
        return None
    edges = np.array(
        [(a[0], a[1], b[0], b[1]) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    )
    hits = [[] for _ in range(angle_bins)]
    for x, y, kind in corners:
        distance = math.hypot(x, y)
        if kind == HIT and distance <= radius and distance <= _free(edges, math.atan2(y, x)) + 0.1:
            hits[_bin(x, y, angle_bins)].append(distance)
    width = 2 * math.pi / angle_bins
    result = []
    for i, found in enumerate(hits):
        if found:
            result.append(min(found))
        elif (hole := _hole(corners, edges, (i + 0.5) * width, radius)) is not None:
            result.append(hole)
        else:
            rays = ((i + part) * width for part in (0, 0.5, 1))
            result.append(CLEAR if all(_seen_clear(corners, edges, ray, radius) for ray in rays) else UNSEEN)
    return np.array(result)


def _outline(scan, row, centre):
    first, last = scan.map_from_laser_first[row], scan.map_from_laser_last[row]
    ranges, bearings = scan.ranges[row].astype(float), scan.bearings
    beams = len(bearings)
    corners = []
    for i, (measured, bearing) in enumerate(zip(ranges, bearings, strict=True)):
        if math.isnan(measured):
            run = _run_without_evidence(ranges, i)
            if run[0] > 0 and run[1] < beams and run[1] - run[0] <= 2:
                continue
            kind, distance = DISC, _blind(first, last, i / max(1, beams - 1), bearing, centre)
        elif math.isfinite(measured):
            kind, distance = HIT, measured
        else:
            kind, distance = FREE, scan.clear_range
        corners.append((*_place(first, last, i / max(1, beams - 1), distance, bearing, centre), kind))
    gap = 2 * math.pi - abs(bearings[-1] - bearings[0])
    spacing = abs(bearings[-1] - bearings[0]) / max(1, beams - 1)
    if beams < 3 or gap > 2.5 * spacing:
        sign = 1 if bearings[-1] >= bearings[0] else -1
        steps = 90
        for i in range(steps + 1):
            bearing = bearings[-1] + sign * gap * i / steps
            blind = _blind(first, last, 1 - i / steps, bearing, centre)
            corners.append((*_place(first, last, 1 - i / steps, blind, bearing, centre), DISC))
    return corners


def _blind(first, last, part, bearing, centre):
    """The disc's radius; towards a node that the laser drives away from within the sweep as far as the node is then."""
    away, at_last = (math.hypot(pose[0, 3] - centre[0], pose[1, 3] - centre[1]) for pose in (first, last))
    if at_last <= away:
        return min(2.5, away + 0.1)
    x, y = _place(first, last, part, 0.0, bearing, centre)
    x1, y1 = _place(first, last, part, 1.0, bearing, centre)
    return min(2.5, max(away + 0.1, 1.072 * (-x * (x1 - x) - y * (y1 - y)) + 0.02))


def _run_without_evidence(ranges, i):
    start = stop = i
    while start > 0 and math.isnan(ranges[start - 1]):
        start -= 1
    while stop < len(ranges) and math.isnan(ranges[stop]):
        stop += 1
    return start, stop


def _place(first, last, part, distance, bearing, centre):
    """End of a beam relative to the node: position blended, rotation turned evenly about the vertical."""
    turn = (
        math.remainder(math.atan2(last[1, 0], last[0, 0]) - math.atan2(first[1, 0], first[0, 0]), 2 * math.pi)
        * part
    )
    x, y = (first[a, 0] * math.cos(bearing) + first[a, 1] * math.sin(bearing) for a in (0, 1))
    x, y = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
    at = [first[a, 3] + (last[a, 3] - first[a, 3]) * part - centre[a] for a in (0, 1)]
    return at[0] + distance * x, at[1] + distance * y


def _bin(x, y, angle_bins):
    i = int(math.atan2(y, x) % (2 * math.pi) * angle_bins / (2 * math.pi))
    return i % angle_bins


def _step(a, b):
    return math.remainder(math.atan2(b[1], b[0]) - math.atan2(a[1], a[0]), 2 * math.pi)


def _crossings(edges, bearing):
    """Distance along the ray to every edge (edges,), inf where it does not meet it."""
    x1, y1, x2, y2 = edges.T
    dx, dy = x2 - x1, y2 - y1
    cos, sin = math.cos(bearing), math.sin(bearing)
    across = cos * dy - sin * dx
    with np.errstate(divide="ignore", invalid="ignore"):
        distance, along = (x1 * dy - y1 * dx) / across, (x1 * sin - y1 * cos) / across
    return np.where((distance > 0) & (along >= -1e-9) & (along <= 1 + 1e-9), distance, np.inf)


def _free(edges, bearing):
    return float(_crossings(edges, bearing).min())


def _seen_clear(corners, edges, bearing, radius):
    crossed = _crossings(edges, bearing)
    i = int(crossed.argmin())
    unseen = corners[i][2] == corners[(i + 1) % len(corners)][2] == DISC
    return crossed[i] > radius and not unseen


def _hole(corners, edges, bearing, radius):
    crossed = _crossings(edges, bearing)
    i = int(crossed.argmin())
    a, b = corners[i], corners[(i + 1) % len(corners)]
    nearer = min(math.hypot(*a[:2]), math.hypot(*b[:2]))
    close = math.hypot(a[0] - b[0], a[1] - b[1]) <= 0.2
    return nearer if a[2] == b[2] == HIT and close and crossed[i] <= radius and nearer <= radius else None
