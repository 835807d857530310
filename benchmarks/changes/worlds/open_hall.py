"""An open hall with a dozen pieces of furniture, of which seven are moved between two runs of one pass each.

The first run goes round the hall, the second across it: few nodes take scans of both. Layouts are drawn from a seed.

        y=10 +----------------------------+
             |  +-----first run--------+  |
             |  |       o    +-->      |  |
             |  |  o    +----+    o    |  |
             |  +-----------------------+ |
        y=0  +-------|--------------------+
            x=0      second run          x=14
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from benchmarks.changes.worlds.clearance import Point, clearance
from benchmarks.changes.worlds.patrols import FIRST_NS, RATES
from sample_logs.drives import Drive
from sample_logs.laser import Mount, Scanner
from sample_logs.rays import Floats
from sample_logs.robot import Motion, drive
from sample_logs.world import Thing, World, box, disc, outline_segments, wall

WIDTH, DEPTH = 14.0, 10.0
MOVED = 7  # pieces, of twelve
LAYOUTS = (
    1,
    2,
    4,
    9,
    10,
)  # seeds of halls in which the laser sees every place before and after: a test holds it
BETWEEN = 43200.0  # when the pieces are moved [s]

SCANNER = Scanner(
    first_deg=-120.0, step_deg=0.5, beams=481, period=0.125, sweep_time=0.08, range_min=0.06, range_max=20.0,
    mount=Mount(0.15, 0.0, 0.3, 0.0), missing=0.01,
)  # fmt: skip
_SPEED, _TURN_RATE = 1.0, 1.2
_ERROR_M, _ERROR_RAD = 0.02, 0.004
_OFFSET_M, _OFFSET_RAD = 0.01, 0.002  # of a whole run, one sigma
_SIDE_M = 1.5  # from the walls to the first run's way
_CLEAR_M = 0.45  # from a piece to both ways
_APART_M = 0.6  # between two pieces, wherever either ever stands
_FARTHER_M = 1.0  # least way that a moved piece goes
_TRIES = 5000
_SIZES = (
    ("table", 1.6, 0.8), ("desk", 1.4, 0.7), ("shelf", 1.2, 0.4), ("cabinet", 1.0, 0.5), ("sofa", 1.8, 0.8),
    ("chair", 0.6, 0.6), ("trolley", 0.8, 0.5), ("crate", 0.7, 0.6), ("locker", 0.5, 0.5), ("bench", 1.5, 0.4),
    ("barrel", 0.6, 0.6), ("bin", 0.4, 0.4),
)  # fmt: skip
_ROUND = frozenset(("barrel", "bin"))


@dataclass(frozen=True, slots=True)
class Hall:
    """One layout: what stands where (times in seconds since the first day), and both runs."""

    seed: int
    things: tuple[Thing, ...]
    ways: tuple[tuple[Point, ...], tuple[Point, ...]]

    def drives(self) -> dict[str, Drive]:
        """Both recordings by name, a day apart."""
        return {f"run_{run}": self._drive(run) for run in (1, 2)}

    def _drive(self, run: int) -> Drive:
        begins = (run - 1) * 86400.0 + 3600.0
        rng = np.random.Generator(np.random.PCG64([42, self.seed, run]))
        offset = np.clip(rng.normal(size=3), -2, 2) * (_OFFSET_M, _OFFSET_M, _OFFSET_RAD)
        return Drive(
            self.world(begins), self.motion(run), SCANNER, RATES, FIRST_NS + round(begins * 1e9),
            self.seed * 10 + run, error_m=_ERROR_M, error_rad=_ERROR_RAD,
            map_offset=(float(offset[0]), float(offset[1]), float(offset[2])),
        )  # fmt: skip

    def motion(self, run: int) -> Motion:
        """The robot's true way in run 1 or 2."""
        return drive(self.ways[run - 1], _SPEED, _TURN_RATE)

    def world(self, since: float) -> World:
        """The hall with its clock set to 0 at `since` [s]."""
        return World(walls(), [replace(t, since=t.since - since, until=t.until - since) for t in self.things])


def walls() -> Floats:
    """Segments (m, 4) of the four walls."""
    corners = [(0.0, 0.0), (WIDTH, 0.0), (WIDTH, DEPTH), (0.0, DEPTH), (0.0, 0.0)]
    return np.concatenate([wall(a, b) for a, b in pairwise(corners)])


def hall(seed: int) -> Hall:
    """The layout of a seed; RuntimeError where there is no room for a piece."""
    rng = np.random.Generator(np.random.PCG64([41, seed]))
    ways = (_round_it(rng), _across_it(rng))
    taken: list[Floats] = []  # outlines
    names = [_SIZES[i][0] for i in rng.permutation(len(_SIZES)).tolist()]
    things = []
    for i, name in enumerate(names):
        taken.append(_placed(name, rng, ways, taken))
        if i >= MOVED:
            things.append(Thing(name, taken[-1]))
            continue
        before = taken[-1]
        taken.append(_placed(name, rng, ways, taken, before))
        things += [Thing(name, before, until=BETWEEN), Thing(name, taken[-1], since=BETWEEN)]
    return Hall(seed, tuple(things), ways)


def _round_it(rng: np.random.Generator) -> tuple[Point, ...]:
    """Along all walls, from a corner, in one direction or the other."""
    low, right, top = _SIDE_M, WIDTH - _SIDE_M, DEPTH - _SIDE_M
    corners = np.roll([(low, low), (right, low), (right, top), (low, top)], int(rng.integers(4)), axis=0)
    points = [*corners, corners[0]][:: 1 if rng.random() < 0.5 else -1]
    return tuple((float(x), float(y)) for x, y in points)


def _across_it(rng: np.random.Generator) -> tuple[Point, ...]:
    """From one long wall to the other, along the middle in between; mirrored by chance."""
    first, last = rng.uniform(3.8, 5.2), rng.uniform(8.8, 10.2)
    middle, mirrored_x, mirrored_y = rng.uniform(4.4, 5.6), rng.random() < 0.5, rng.random() < 0.5
    points = [(first, 1.0), (first, middle), (last, middle), (last, DEPTH - 1.0)]
    return tuple(
        (round(WIDTH - x if mirrored_x else x, 3), round(DEPTH - y if mirrored_y else y, 3))
        for x, y in points
    )


def _placed(
    name: str, rng: np.random.Generator, ways: tuple[tuple[Point, ...], ...], taken: list[Floats],
    before: Floats | None = None,
) -> Floats:  # fmt: skip
    """An outline (k, 2) for a piece that keeps clear of all that is placed, and away from where it stood before."""
    length, width = next((a, b) for n, a, b in _SIZES if n == name)
    for _ in range(_TRIES):
        x, y = rng.uniform(0.5, WIDTH - 0.5), rng.uniform(0.5, DEPTH - 0.5)
        turned = float(rng.choice([0.0, 90.0])) + rng.normal(0, 8.0)
        outline = disc(x, y, length / 2) if name in _ROUND else box(x, y, length, width, turned)
        if _has_room(outline, ways, taken) and (
            before is None or np.linalg.norm(outline.mean(0) - before.mean(0)) >= _FARTHER_M
        ):
            return outline
    raise RuntimeError(f"no room for the {name} was found")


def _has_room(outline: Floats, ways: tuple[tuple[Point, ...], ...], taken: list[Floats]) -> bool:
    low, high = outline.min(0), outline.max(0)
    if low.min() < 0.1 or high[0] > WIDTH - 0.1 or high[1] > DEPTH - 0.1:
        return False
    edges = outline_segments(outline)
    others = [outline_segments(other) for other in taken]
    closed = [(float(x), float(y)) for x, y in [*outline, outline[0]]]
    apart = not others or clearance(closed, np.concatenate(others)) >= _APART_M
    return apart and all(clearance(way, edges) >= _CLEAR_M for way in ways)
