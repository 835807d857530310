"""The twelve patrols: when each begins, which way it goes, how wrong its localisation is, who walks."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.changes.worlds.building import (
    DAYS,
    DOORWAYS,
    NORTH,
    SOUTH,
    SPEED,
    TURN_RATE,
    WIDTH,
    building,
    morning,
    route,
)
from benchmarks.changes.worlds.clearance import Point
from sample_logs.building import walk
from sample_logs.drives import Drive, Rates
from sample_logs.laser import Mount, Scanner
from sample_logs.robot import Motion, drive
from sample_logs.world import Walk

FIRST_NS = 1_709_510_400_000_000_000  # 2024-03-04 00:00 UTC, a Monday: day 1

SCANNER = Scanner(
    first_deg=-135.0, step_deg=0.5, beams=541, period=0.1, sweep_time=0.075, range_min=0.06, range_max=25.0,
    mount=Mount(0.18, 0.0, 0.3, 0.0), missing=0.01,
)  # fmt: skip
RATES = Rates(odometry=20.0, localisation=10.0)
ERROR_M, ERROR_RAD = 0.025, 0.005  # of the localisation, renewed every quarter of a metre
OFFSET_M, OFFSET_RAD = 0.02, 0.002  # of a whole day, one sigma

# Where people stop: in which room, and at which place.
STOPS = (
    ("office", (4.9, 2.4)), ("kitchen", (9.6, 2.9)), ("workshop", (16.4, 2.8)), ("meeting", (3.4, 8.0)),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Patrol:
    """One day's patrol."""

    day: int
    begins: float  # [s] since midnight before day 1
    motion: Motion  # the robot's true way
    walks: tuple[Walk, ...]  # by the clock of the patrol
    map_offset: tuple[float, float, float]  # [m, m, rad]

    @property
    def start_ns(self) -> int:
        """Stamp at which the recording begins."""
        return FIRST_NS + round(self.begins * 1e9)

    @property
    def file(self) -> str:
        """Name of the recording, a folder."""
        return f"day_{self.day:02d}"

    def drive(self) -> Drive:
        """The recording's contents."""
        return Drive(
            building(self.begins, self.walks), self.motion, SCANNER, RATES, self.start_ns, self.day,
            error_m=ERROR_M, error_rad=ERROR_RAD, map_offset=self.map_offset,
        )  # fmt: skip


def patrols(days: int = DAYS, way: Callable[[int], list[Point]] = route) -> list[Patrol]:
    """The first `days` patrols, in the order of their days; `way` gives each day's route."""
    return [_patrol(day, drive(way(day), SPEED, TURN_RATE)) for day in range(1, days + 1)]


def _patrol(day: int, motion: Motion) -> Patrol:
    rng = np.random.Generator(np.random.PCG64([20, day]))
    begins = morning(day) + 9 * 3600.0 + round(float(rng.uniform(0, 3600)))
    offset = np.clip(rng.normal(size=3), -2, 2) * (OFFSET_M, OFFSET_M, OFFSET_RAD)
    shift = (float(offset[0]), float(offset[1]), float(offset[2]))
    return Patrol(day, begins, motion, _people(motion, rng), shift)


def _people(motion: Motion, rng: np.random.Generator) -> tuple[Walk, ...]:
    """Two who walk along the corridor, and one who stands in a room for 16 s while the robot is there."""
    starts, speeds = rng.uniform(0, motion.duration - 30, 2), rng.uniform(0.8, 1.3, 3)
    room, place = STOPS[int(rng.integers(len(STOPS)))]
    x, side = DOORWAYS[room], SOUTH - 0.7 if place[1] < SOUTH else NORTH + 0.7
    lane = SOUTH + 0.4
    inside = ((0.4, lane), (x, lane), (x, side), place)
    on_the_way = float(np.hypot(*np.diff(np.array(inside), axis=0).T).sum()) / speeds[2]
    met = motion.times[np.linalg.norm(motion.poses[:, :2] - place, axis=1).argmin()]
    begins = max(0.0, float(met) - rng.uniform(2, 14) - on_the_way)
    return (
        walk("visitor", starts[0], speeds[0], (WIDTH - 0.4, lane), (0.4, lane)),
        walk("courier", starts[1], speeds[1], (0.4, lane), (WIDTH - 0.4, lane)),
        walk("colleague", begins, speeds[2], *inside, place, place, *inside[::-1][1:]),
    )
