"""What really changed in a simulated world.

Times are stamps in nanoseconds, lengths metres in the map frame. A change holds from `since_ns` until just before
`until_ns`; None: it holds to this day.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, isfinite

import numpy as np

from benchmarks.changes.worlds.building import things
from benchmarks.changes.worlds.patrols import FIRST_NS, Patrol
from sample_logs.drives import Drive
from sample_logs.rays import Floats
from sample_logs.world import Thing

Outline = tuple[tuple[float, float], ...]  # corners [m], closed
Bounds = tuple[float, float, float, float]  # [m] x_min, y_min, x_max, y_max


@dataclass(frozen=True, slots=True)
class Episode:
    """A stretch of time in which a change holds."""

    since_ns: int
    until_ns: int | None


@dataclass(frozen=True, slots=True)
class TrueChange:
    """One thing that appeared, vanished or moved; recurring if it holds more than once."""

    what: str
    kind: str  # appeared, vanished, moved
    outline: Outline  # where it stands; of what vanished, where it stood
    from_outline: Outline | None  # where a moved thing stood before
    episodes: tuple[Episode, ...]

    @property
    def recurring(self) -> bool:
        """Whether it comes and goes."""
        return len(self.episodes) > 1


@dataclass(frozen=True, slots=True)
class Walked:
    """Where one person was: positions [m] at stamps, straight between them, nowhere outside them."""

    who: str
    stamps_ns: tuple[int, ...]
    positions: tuple[tuple[float, float], ...]

    def nearest(self, bounds: Bounds, since_ns: int, until_ns: int) -> float:
        """How near the person came to the bounds between two stamps [m]; inf if not there then."""
        start, stop = max(since_ns, self.stamps_ns[0]), min(until_ns, self.stamps_ns[-1])
        if start > stop:
            return float("inf")
        times = np.linspace(start, stop, 2 + (stop - start) // 100_000_000) - self.stamps_ns[0]
        knots = np.array(self.stamps_ns) - self.stamps_ns[0]
        x, y = (np.interp(times, knots, [p[i] for p in self.positions]) for i in (0, 1))
        beside_x = np.maximum(np.maximum(bounds[0] - x, x - bounds[2]), 0.0)
        beside_y = np.maximum(np.maximum(bounds[1] - y, y - bounds[3]), 0.0)
        return float(np.hypot(beside_x, beside_y).min())


@dataclass(frozen=True, slots=True)
class Recorded:
    """One patrol's recording."""

    file: str
    day: int
    start_ns: int
    end_ns: int
    walked: tuple[Walked, ...]


@dataclass(frozen=True, slots=True)
class Truth:
    """All that is known of the recordings."""

    recordings: tuple[Recorded, ...]  # in the order of their days
    changes: tuple[TrueChange, ...]  # in the order in which they first hold

    @property
    def end_ns(self) -> int:
        """End of the last recording."""
        return self.recordings[-1].end_ns

    def quiet(self) -> tuple[Recorded, ...]:
        """The recordings, but the first, before which nothing changed but what recurs."""
        changed = [ns for c in self.changes if not c.recurring for e in c.episodes for ns in _ends(e)]
        pairs = zip(self.recordings, self.recordings[1:], strict=False)
        return tuple(b for a, b in pairs if not any(a.start_ns < ns <= b.end_ns for ns in changed))


def bounds_of(outline: Outline) -> Bounds:
    """The smallest upright rectangle around an outline."""
    xs, ys = zip(*outline, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def gap(a: Bounds, b: Bounds) -> float:
    """Distance between two upright rectangles [m], 0 where they touch or overlap."""
    return hypot(max(a[0] - b[2], b[0] - a[2], 0.0), max(a[1] - b[3], b[1] - a[3], 0.0))


def building_truth(planned: Sequence[Patrol]) -> Truth:
    """The truth of patrols through the building, without what changed only later."""
    return truth_of([recorded(one.file, one.day, one.drive()) for one in planned], things())


def truth_of(recordings: Sequence[Recorded], there: Sequence[Thing]) -> Truth:
    """The truth of recordings of a world; times of things are seconds since `FIRST_NS`.

    A thing is listed once for every place and every stretch of time, always by the same name.
    """
    end_ns = recordings[-1].end_ns
    by_name: dict[str, list[Thing]] = {}
    for thing in there:
        by_name.setdefault(thing.name, []).append(thing)
    found = [_change(name, places, end_ns) for name, places in by_name.items()]
    changes = [change for change in found if change is not None]
    return Truth(tuple(recordings), tuple(sorted(changes, key=lambda c: (c.episodes[0].since_ns, c.what))))


def recorded(file: str, day: int, drive: Drive) -> Recorded:
    """What is known of the recording of a drive."""
    walked = tuple(
        Walked(
            walk.name,
            tuple(drive.start_ns + round(t * 1e9) for t in walk.times.tolist()),
            tuple((round(x, 3), round(y, 3)) for x, y in walk.positions.tolist()),
        )
        for walk in drive.world.walks
    )
    end_ns = drive.start_ns + round(drive.motion.duration * 1e9)
    return Recorded(file, day, drive.start_ns, end_ns, walked)


def _change(name: str, places: Sequence[Thing], end_ns: int) -> TrueChange | None:
    """The change of a thing that is listed once for every place and every stretch of time; None: it stays."""
    first, last = places[0], places[-1]
    came = [_ns(t.since) for t in places if isfinite(t.since)]
    went = [_ns(t.until) for t in places if isfinite(t.until)]
    origin = None
    if len(places) > 1 and not np.array_equal(first.outline, last.outline):
        kind, origin, starts, stops = "moved", _outline(first.outline), came, went[1:]
    elif isfinite(first.since):
        kind, starts, stops = "appeared", came, went
    else:
        kind, starts, stops = "vanished", went, came
    episodes = [
        Episode(start, stops[i] if i < len(stops) else None)
        for i, start in enumerate(starts)
        if start < end_ns
    ]
    return TrueChange(name, kind, _outline(last.outline), origin, tuple(episodes)) if episodes else None


def _ns(seconds: float) -> int:
    return FIRST_NS + round(seconds * 1e9)


def _outline(corners: Floats) -> Outline:
    return tuple((round(x, 3), round(y, 3)) for x, y in corners.tolist())


def _ends(episode: Episode) -> list[int]:
    return [ns for ns in (episode.since_ns, episode.until_ns) if ns is not None]
