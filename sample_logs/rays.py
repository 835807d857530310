"""Ray casting against line segments and circles, for whole sweeps of a moving laser at once."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

_TRIPLES_PER_BLOCK = 1_000_000
_TURN = 2 * np.pi


def cast(
    segments: Floats, origins: Floats, bearings: Floats, reach: float = np.inf
) -> tuple[Floats, Indices]:
    """Distance to the nearest segment along every ray, and which segment that is.

    `segments` (m, 4) are x, y of both ends, seen from both sides; `origins` (n, b, 2) and `bearings`
    (n, b) [rad] belong to one beam each, bearings of a sweep rising or falling about evenly.
    Returns ranges (n, b) [m], `inf` where nothing is hit within `reach`, and indices (n, b), -1 there.
    """
    n, beams = bearings.shape
    ranges = np.full((n, beams), np.inf)
    hits = np.full((n, beams), -1, dtype=np.int64)
    if not len(segments):
        return ranges, hits
    block = max(1, _TRIPLES_PER_BLOCK // (beams * 16))
    for start in range(0, n, block):
        part = slice(start, start + block)
        near = _near_segments(segments, origins[part], reach)
        ranges[part], local = _cast_block(segments[near], origins[part], bearings[part], reach)
        hits[part] = np.where(local >= 0, near[local] if len(near) else -1, -1)
    return ranges, hits


def cast_circles(centres: Floats, radius: float, origins: Floats, bearings: Floats) -> Floats:
    """Distance (n, b) [m] to the nearest circle, `inf` where none is hit.

    `centres` (n, k, 2) are those of each sweep, NaN for a circle that is not there.
    """
    ranges = np.full(bearings.shape, np.inf)
    there = np.isfinite(centres[..., 0])
    if not there.any():
        return ranges
    along = np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
    for k in range(centres.shape[1]):
        rows = np.flatnonzero(there[:, k])
        offset = centres[rows, None, k] - origins[rows]
        ahead = (offset * along[rows]).sum(-1)
        beside = offset[..., 0] * along[rows, :, 1] - offset[..., 1] * along[rows, :, 0]
        depth = radius**2 - beside**2
        distance = ahead - np.sqrt(np.maximum(depth, 0.0))
        ranges[rows] = np.where(
            (depth > 0) & (distance > 0), np.minimum(ranges[rows], distance), ranges[rows]
        )
    return ranges


def _near_segments(segments: Floats, origins: Floats, reach: float) -> Indices:
    """Indices of the segments whose bounding box lies within `reach` of the origins' bounding box."""
    low, high = origins.min((0, 1)) - reach, origins.max((0, 1)) + reach
    left, right = np.minimum(segments[:, :2], segments[:, 2:]), np.maximum(segments[:, :2], segments[:, 2:])
    return np.flatnonzero(((right >= low) & (left <= high)).all(1))


def _cast_block(segments: Floats, origins: Floats, bearings: Floats, reach: float) -> tuple[Floats, Indices]:
    n, beams = bearings.shape
    scan, segment, beam = _candidates(segments, origins, bearings, reach)
    ray = scan * beams + beam
    origin, angle = origins.reshape(-1, 2)[ray], bearings.ravel()
    cos, sin = np.cos(angle)[ray], np.sin(angle)[ray]
    start_x, start_y = segments[segment, 0] - origin[:, 0], segments[segment, 1] - origin[:, 1]
    along_x, along_y = (segments[:, 2:] - segments[:, :2]).T
    along_x, along_y = along_x[segment], along_y[segment]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = cos * along_y - sin * along_x
        distance = (start_x * along_y - start_y * along_x) / across
        share = (start_x * sin - start_y * cos) / across
    hit = np.flatnonzero((share >= 0) & (share <= 1) & (distance > 0) & (distance <= reach))
    ray, distance, segment = ray[hit], distance[hit], segment[hit]
    ranges, hits = np.full(n * beams, np.inf), np.full(n * beams, -1, dtype=np.int64)
    np.minimum.at(ranges, ray, distance)
    nearest = distance == ranges[ray]
    hits[ray[nearest]] = segment[nearest]
    return ranges.reshape(n, beams), hits.reshape(n, beams)


def _candidates(
    segments: Floats, origins: Floats, bearings: Floats, reach: float
) -> tuple[Indices, Indices, Indices]:
    """Triples (scan, segment, beam) that hold every beam that may meet a segment within `reach`.

    Each segment is seen from the middle of the sweep under an interval of bearings; the margin allows for the
    way the laser moves during the sweep and for beams that are not quite evenly spread.
    """
    n, beams = bearings.shape
    if beams == 1:
        every = np.indices((n, len(segments)))
        return every[0].ravel(), every[1].ravel(), np.zeros(every[0].size, dtype=np.int64)
    sign = np.where(bearings[:, -1] < bearings[:, 0], -1.0, 1.0)
    first, step = bearings[:, 0], (bearings[:, -1] - bearings[:, 0]) / (beams - 1)
    uneven = np.abs(bearings - first[:, None] - step[:, None] * np.arange(beams)).max(1)
    middle = origins[:, beams // 2]
    moved = np.linalg.norm(origins - middle[:, None], axis=2).max(1)
    from_middle = segments.reshape(1, -1, 2, 2) - middle[:, None, None]  # (n, m, end, xy)
    seen = np.arctan2(from_middle[..., 1], from_middle[..., 0]) * sign[:, None, None]
    turn = _wrap(seen[..., 1] - seen[..., 0])
    begin = np.mod(np.where(turn < 0, seen[..., 1], seen[..., 0]) - (first * sign)[:, None], _TURN)
    away = _distances(from_middle)
    step = np.maximum(np.abs(step), 1e-12)[:, None]
    slack = np.arcsin(np.minimum(1.0, moved[:, None] / np.maximum(away, 1e-12))) + uneven[:, None]
    slack = np.where(away <= moved[:, None], _TURN, slack + 2 * step)
    found = []
    for turns in (-_TURN, 0.0, _TURN):
        low = np.clip(np.floor((begin + turns - slack) / step), 0, beams).astype(np.int64)
        high = np.clip(np.ceil((begin + turns + np.abs(turn) + slack) / step) + 1, 0, beams).astype(np.int64)
        counts = np.where(away <= reach + moved[:, None], np.maximum(high - low, 0), 0)
        found.append((low.ravel(), counts.ravel()))
    return _expand(found, len(segments))


def _expand(found: list[tuple[Indices, Indices]], segments: int) -> tuple[Indices, Indices, Indices]:
    parts = []
    for low, counts in found:
        pair = np.repeat(np.arange(len(counts)), counts)
        ends = np.cumsum(counts)
        beam = np.arange(len(pair)) + np.repeat(low - ends + counts, counts)
        parts.append((pair // segments, pair % segments, beam))
    return (
        np.concatenate([p[0] for p in parts]),
        np.concatenate([p[1] for p in parts]),
        np.concatenate([p[2] for p in parts]),
    )


def _distances(ends: Floats) -> Floats:
    """Distance (n, m) of the origin from segments given by their ends (n, m, 2, 2)."""
    along = ends[..., 1, :] - ends[..., 0, :]
    length = np.maximum((along**2).sum(-1), 1e-18)
    share = np.clip(-(ends[..., 0, :] * along).sum(-1) / length, 0.0, 1.0)
    nearest: Floats = np.linalg.norm(ends[..., 0, :] + share[..., None] * along, axis=-1)
    return nearest


def _wrap(angle: Floats) -> Floats:
    return np.mod(angle + np.pi, _TURN) - np.pi
