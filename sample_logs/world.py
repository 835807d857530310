"""A 2-D world of line segments, in which things stand for a while, and people walk."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sample_logs.rays import Floats, cast, cast_circles

LEG_RADIUS = 0.07
_STRIDE = 0.28
_STEPS_PER_SECOND = 0.9
_GLASS_ANSWERS_WITHIN = np.cos(np.deg2rad(20.0))


@dataclass(frozen=True, slots=True)
class Thing:
    """A closed outline (k, 2) [m] that stands in the world from `since` until just before `until` [s]."""

    name: str
    outline: Floats
    since: float = -np.inf
    until: float = np.inf

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max [m]."""
        low, high = self.outline.min(0), self.outline.max(0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])


@dataclass(frozen=True, slots=True)
class Walk:
    """Where one walker is over time: positions (k, 2) [m] at times (k,) [s], nowhere outside them.

    A walker with legs is seen as two of them in stride, one without as a circle of `radius` [m].
    """

    name: str
    times: Floats
    positions: Floats
    radius: float = LEG_RADIUS
    legs: bool = True

    def at(self, times: Floats) -> Floats:
        """Positions (n, 2), NaN while the walker is not there."""
        columns = (np.interp(times, self.times, self.positions[:, i], np.nan, np.nan) for i in (0, 1))
        return np.stack(list(columns), axis=-1)

    def circles(self, times: Floats) -> Floats:
        """Centres (n, k, 2) of what the laser sees, NaN while the walker is not there."""
        middle = self.at(times)
        if not self.legs:
            return middle[:, None]
        x, y = (np.interp(times + 0.05, self.times, self.positions[:, i]) for i in (0, 1))
        ahead = np.stack([x, y], axis=-1) - middle
        speed = np.linalg.norm(ahead, axis=-1, keepdims=True)
        moving = speed > 1e-3
        forward = np.where(moving, ahead / np.maximum(speed, 1e-3), (1.0, 0.0))
        swing = _STRIDE * np.sin(2 * np.pi * _STEPS_PER_SECOND * times)[:, None]
        stride = np.where(moving, swing, 0.0) * forward
        aside = 0.1 * np.stack([-forward[:, 1], forward[:, 0]], axis=-1)
        return np.stack([middle + aside + stride, middle - aside - stride], axis=1)


@dataclass(frozen=True, slots=True)
class World:
    """Walls (m, 4) and panes of glass (g, 4) that stay, things that come and go, people who walk."""

    walls: Floats
    things: Sequence[Thing] = ()
    walks: Sequence[Walk] = ()
    glass: Floats | None = None

    def ranges(self, times: Floats, origins: Floats, bearings: Floats, reach: float) -> Floats:
        """True distances (n, b) [m] along the rays of sweeps begun at `times` (n,) [s]; `inf` beyond `reach`.

        Times rise. What comes or goes does so between two sweeps.
        """
        ranges = np.empty(bearings.shape)
        for start, stop in self._still_stretches(times):
            part = slice(start, stop)
            solid = self._solid(times[start])
            ranges[part] = cast(solid, origins[part], bearings[part], reach)[0]
        for walk in self.walks:
            seen = cast_circles(walk.circles(times), walk.radius, origins, bearings)
            ranges = np.minimum(ranges, seen)
        if self.glass is not None:
            ranges = np.minimum(ranges, _mirrored_by_glass(self.glass, origins, bearings, reach))
        return np.where(ranges <= reach, ranges, np.inf)

    def _still_stretches(self, times: Floats) -> list[tuple[int, int]]:
        changes = [t for thing in self.things for t in (thing.since, thing.until) if np.isfinite(t)]
        cuts = np.unique(np.concatenate([[0, len(times)], np.searchsorted(times, changes)])).astype(int)
        return [(int(a), int(b)) for a, b in pairwise(cuts)]

    def _solid(self, time: float) -> Floats:
        standing = [outline_segments(t.outline) for t in self.things if t.since <= time < t.until]
        return np.concatenate([self.walls, *standing])


def _mirrored_by_glass(glass: Floats, origins: Floats, bearings: Floats, reach: float) -> Floats:
    """Glass answers only the beams that meet it nearly head-on; the others go through."""
    ranges, panes = cast(glass, origins, bearings, reach)
    along = glass[panes, 2:] - glass[panes, :2]
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    head_on = np.abs(np.cos(bearings) * along[..., 1] - np.sin(bearings) * along[..., 0])
    return np.where(head_on >= _GLASS_ANSWERS_WITHIN, ranges, np.inf)


def box(x: float, y: float, length: float, width: float, turned_deg: float = 0.0) -> Floats:
    """Corners (4, 2) of a rectangle around (x, y), its length along +x before it is turned."""
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (length / 2, width / 2)
    angle = np.deg2rad(turned_deg)
    cos, sin = np.cos(angle), np.sin(angle)
    along, across = corners.T[..., None]  # (4, 1) each; a matrix library would round by processor
    return np.asarray((x, y) + (along * (cos, sin) + across * (-sin, cos)))


def disc(x: float, y: float, radius: float, corners: int = 24) -> Floats:
    """Corners (corners, 2) of a regular polygon around (x, y), as good as a circle for a laser."""
    turn = 2 * np.pi * np.arange(corners) / corners
    return np.asarray((x, y) + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1))


def outline_segments(outline: Floats) -> Floats:
    """The edges (k, 4) of a closed outline (k, 2)."""
    return np.concatenate([outline, np.roll(outline, -1, axis=0)], axis=1)


def wall(
    start: tuple[float, float],
    end: tuple[float, float],
    gaps: Sequence[tuple[float, float]] = (),
    thickness: float = 0.12,
) -> Floats:
    """Segments (m, 4) of a wall along x or y, open where `gaps` (from, to) along its axis say so."""
    axis = 0 if start[1] == end[1] else 1
    stops = [start[axis], *(value for gap in sorted(gaps) for value in gap), end[axis]]
    pieces = []
    for low, high in zip(stops[::2], stops[1::2], strict=True):
        centre, size = np.array(start, dtype=float), np.full(2, thickness)
        centre[axis], size[axis] = (low + high) / 2, high - low
        pieces.append(outline_segments(box(centre[0], centre[1], size[0], size[1])))
    return np.concatenate(pieces)
