"""The building's patrols on other ways: each day another lane, another order of the rooms, another direction.

The robot looks into the same rooms as on the patrols of `building`: into the store only where it is open.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.changes.worlds.building import (
    DOORWAYS,
    NORTH,
    SOUTH,
    WIDTH,
    door_open,
    morning,
    things,
    walls,
)
from benchmarks.changes.worlds.clearance import Point, clearance
from sample_logs.rays import Floats
from sample_logs.world import outline_segments

CLEAR_M = 0.34  # kept from everything that stands
_NOON = 43200.0
_ASIDE_M = 0.2  # most that a way through a doorway is beside its middle
_TRIES = 200


@dataclass(frozen=True, slots=True)
class Spread:
    """How far the ways of the days lie apart [m]."""

    seed: int
    wall_m: float  # least distance of a lane from the corridor's walls
    around_m: float  # most that a corner inside a room is beside where it is in `building`, x and y

    def route(self, day: int) -> list[Point]:
        """The robot's way on that day, from one end of the corridor to the other by way of all rooms."""
        rng = np.random.Generator(np.random.PCG64([self.seed, day]))
        standing = standing_on(day)
        lane = self._lane(rng, standing)
        rooms = [room for room in _CORNERS if room != "store" or door_open(day)]
        points: list[Point] = [(1.0, lane)]
        for i in rng.permutation(len(rooms)).tolist():
            points += self._visit(rooms[i], lane, rng, standing)
        points.append((WIDTH - 1.0, lane))
        return points[::-1] if rng.random() < 0.5 else points

    def _lane(self, rng: np.random.Generator, standing: Floats) -> float:
        """Where across the corridor the robot drives that day, y [m]."""

        def drawn() -> list[Point]:
            y = round(float(rng.uniform(SOUTH + self.wall_m, NORTH - self.wall_m)), 3)
            return [(1.0, y), (WIDTH - 1.0, y)]

        return _clear(drawn, standing)[0][1]

    def _visit(self, room: str, lane: float, rng: np.random.Generator, standing: Floats) -> list[Point]:
        """From the lane into a room and back, in one direction or the other."""
        inside_y = SOUTH - 1.2 if _CORNERS[room][0][1] < SOUTH else NORTH + 1.2

        def drawn() -> list[Point]:
            x = DOORWAYS[room] + round(float(rng.uniform(-_ASIDE_M, _ASIDE_M)), 3)
            aside = rng.uniform(-self.around_m, self.around_m, (2, 2)).round(3).tolist()
            corners = [(cx + dx, cy + dy) for (cx, cy), (dx, dy) in zip(_CORNERS[room], aside, strict=True)]
            turned = corners[:: 1 if rng.random() < 0.5 else -1]
            return [(x, lane), (x, inside_y), *turned, (x, inside_y), (x, lane)]

        return _clear(drawn, standing)


_CORNERS = {
    "office": ((1.9, 2.4), (4.3, 1.7)),
    "kitchen": ((7.4, 2.0), (10.2, 2.0)),
    "workshop": ((13.3, 2.0), (16.4, 1.9)),
    "store": ((10.2, 8.8), (15.8, 8.8)),
    "meeting": ((2.4, 8.6), (6.0, 8.6)),
}


LANES = Spread(seed=22, wall_m=0.7, around_m=0.4)
FAR_LANES = Spread(seed=21, wall_m=0.4, around_m=0.7)  # as far apart as corridor and rooms allow


def standing_on(day: int) -> Floats:
    """Segments (m, 4) of walls and things at noon of a day."""
    noon = morning(day) + _NOON
    there = [outline_segments(t.outline) for t in things() if t.since <= noon < t.until]
    return np.concatenate([walls(), *there])


def _clear(drawn: Callable[[], list[Point]], standing: Floats) -> list[Point]:
    """The first way drawn that leaves room enough; RuntimeError where none of `_TRIES` does."""
    for _ in range(_TRIES):
        way = drawn()
        if clearance(way, standing) >= CLEAR_M:
            return way
    raise RuntimeError("no way through the building was found that keeps clear of everything")
