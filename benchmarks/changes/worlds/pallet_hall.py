"""A pallet hall of 52 places in four rows, whose pallets are redrawn every night.

In wh10, wh30 and wh50 each place is emptied or filled anew each night with a chance of 10, 30 or 50 %. In whc half of
the places are redrawn every day, and the other half stays as it is. Times are seconds since midnight before day 1.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from benchmarks.changes.worlds.clearance import Point
from benchmarks.changes.worlds.patrols import ERROR_M, ERROR_RAD, FIRST_NS, OFFSET_M, OFFSET_RAD, RATES
from sample_logs.building import walk
from sample_logs.drives import Drive
from sample_logs.laser import Mount, Scanner
from sample_logs.rays import Floats
from sample_logs.robot import drive
from sample_logs.world import Thing, World, box, wall

WORLDS = ("wh10", "wh30", "wh50", "whc")
DAYS = 10
WIDTH, DEPTH = 24.0, 15.8
ROWS = (2.9, 6.3, 9.7, 13.1)  # y [m]
AISLES = (1.2, 4.6, 8.0, 11.4, 14.7)  # y [m]
PLACES = tuple((3.0 + 1.5 * i, y) for y in ROWS for i in range(13))
PALLET = (1.2, 0.8)

SCANNER = Scanner(
    first_deg=-135.0, step_deg=0.5, beams=541, period=0.1, sweep_time=0.0333, range_min=0.06, range_max=12.0,
    mount=Mount(0.18, 0.0, 0.3, 0.0), missing=0.01,
)  # fmt: skip
_DAY = 86400.0
_SPEED, _TURN_RATE = 1.0, 1.2
_FILLED = 0.6  # chance of a place that is redrawn
_ENDS = (1.0, WIDTH - 1.0)  # of the robot's way along an aisle, x [m]


@dataclass(frozen=True, slots=True)
class Stay:
    """A pallet that stands at a place, by its number, from one day up to the day before another."""

    place: int
    outline: Floats  # (4, 2) [m]
    first_day: int
    gone_day: int | None  # None: to the end


@cache
def stays(world: str, days: int) -> tuple[Stay, ...]:
    """Every pallet of one of `WORLDS`."""
    return tuple(_half_redrawn(days) if world == "whc" else _redrawn(int(world[2:]), days))


def _redrawn(percent: int, days: int) -> list[Stay]:
    rng = np.random.default_rng([7, percent])
    found = []
    for place in range(len(PLACES)):
        now: tuple[Floats, int] | None = None
        for day in range(1, days + 1):
            if day == 1 or rng.random() < percent / 100:
                if now is not None:
                    found.append(Stay(place, *now, day))
                now = (_pallet(rng, place), day) if rng.random() < _FILLED else None
        if now is not None:
            found.append(Stay(place, *now, None))
    return found


def _half_redrawn(days: int) -> list[Stay]:
    rng = np.random.default_rng(11)
    redrawn = set(rng.choice(len(PLACES), len(PLACES) // 2, replace=False).tolist())
    found = []
    for place in range(len(PLACES)):
        if place in redrawn:
            found += [
                Stay(place, _pallet(rng, place), day, day + 1)
                for day in range(1, days + 1)
                if rng.random() < 0.5
            ]
        elif rng.random() < _FILLED:
            found.append(Stay(place, _pallet(rng, place), 1, None))
    return found


def _pallet(rng: np.random.Generator, place: int) -> Floats:
    """Nobody puts a pallet down quite straight; what lies on it is of another depth each time."""
    x, y = PLACES[place]
    length, width = PALLET
    return box(
        x + rng.normal(0, 0.08),
        y + rng.normal(0, 0.12),
        length,
        width * rng.uniform(0.8, 1.2),
        rng.normal(0, 4),
    )


def things(world: str, days: int) -> list[Thing]:
    """Pallets and columns."""
    columns = [Thing("column", box(x - 0.75, y, 0.3, 0.3)) for x in (8.0, 16.0) for y in (3.7, 12.3)]
    pallets = [
        Thing(
            "pallet", stay.outline,
            since=-np.inf if stay.first_day == 1 else (stay.first_day - 1) * _DAY,
            until=np.inf if stay.gone_day is None else (stay.gone_day - 1) * _DAY,
        )
        for stay in stays(world, days)
    ]  # fmt: skip
    return pallets + columns


def walls() -> Floats:
    """Segments (m, 4) of the walls, with a gate in the far wall and one at the side."""
    return np.concatenate([
        wall((0, 0), (WIDTH, 0)), wall((0, DEPTH), (WIDTH, DEPTH), [(10, 13)]),
        wall((0, 0), (0, DEPTH)), wall((WIDTH, 0), (WIDTH, DEPTH), [(6, 9)]),
    ])  # fmt: skip


def route(day: int) -> list[Point]:
    """Along all aisles and back to the corner; on even days the other way round."""
    points: list[Point] = []
    for i, y in enumerate(AISLES):
        points += [(x, y) for x in _ENDS[:: 1 if i % 2 == 0 else -1]]
    points += [(_ENDS[0], AISLES[-1]), (_ENDS[0], AISLES[0])]
    return points if day % 2 else points[::-1]


def drives(world: str, days: int = DAYS) -> dict[str, Drive]:
    """The recordings of a world's days, by name."""
    return {f"day_{day:02d}": _drive(world, day, days) for day in range(1, days + 1)}


def _drive(world: str, day: int, days: int) -> Drive:
    rng = np.random.default_rng([31, day, len(world)])
    begins = (day - 1) * _DAY + 9 * 3600
    here = [replace(t, since=t.since - begins, until=t.until - begins) for t in things(world, days)]
    motion = drive(route(day), _SPEED, _TURN_RATE)
    start = rng.uniform(0, motion.duration - 40, 2)
    walks = (
        walk("eastbound", start[0], 1.1, (1.0, 4.9), (WIDTH - 1, 4.9)),
        walk("westbound", start[1], 1.0, (WIDTH - 1, 11.1), (1.0, 11.1)),
    )
    offset = np.clip(rng.normal(size=3), -2, 2) * (OFFSET_M, OFFSET_M, OFFSET_RAD)
    return Drive(
        World(walls(), here, walks), motion, SCANNER, RATES, FIRST_NS + round(begins * 1e9), day * 17 + 3,
        error_m=ERROR_M, error_rad=ERROR_RAD,
        map_offset=(float(offset[0]), float(offset[1]), float(offset[2])),
    )  # fmt: skip
