"""Simulated drives: a world, a way through it, a scanner, and poses that are wrong as a localiser's are."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from benchmarks.changes.worlds import pallet_hall, patrols
from sample_logs import building as sample_building
from sample_logs.laser import Mount, Scanner
from sample_logs.rays import Floats
from sample_logs.robot import Motion, compose, drive, localisation_errors
from sample_logs.world import World, wall
from timemap_cli.model.sweeps import Sweeps

BLOCK = 64  # scans that are taken at once
SEED = 5
_LOCALISATION = 10.0  # [Hz]


@dataclass(frozen=True, slots=True)
class Place:
    """Where a robot drives."""

    name: str
    world: World
    motion: Motion
    range_max: float  # [m] of the scanner
    missing_is_free: bool = False  # missing returns are open space here; else they are no evidence


@dataclass(frozen=True, slots=True)
class Setup:
    """How the robot looks and how wrong its poses are."""

    degrees: int
    rate: float  # [Hz]
    ahead: float = 0.18  # [m] the laser's place before the robot's centre
    error_m: float = 0.025
    error_rad: float = 0.005

    def scanner(self, range_max: float) -> Scanner:
        """A scanner of half a degree."""
        period = 1 / self.rate
        return Scanner(
            first_deg=-self.degrees / 2, step_deg=0.5, beams=2 * self.degrees + 1, period=period,
            sweep_time=0.75 * period, range_min=0.06, range_max=range_max,
            mount=Mount(self.ahead, 0.0, 0.3, 0.0), missing=0.01,
        )  # fmt: skip


def setups() -> list[Setup]:
    """Every field of view, slow and fast; then a fast one of 40 Hz, a laser far ahead, and poses twice as wrong."""
    plain = [Setup(degrees, rate) for degrees in (180, 240, 270) for rate in (5.0, 10.0)]
    return [
        *plain,
        Setup(270, 40.0),
        Setup(180, 10.0, ahead=0.4),
        Setup(270, 10.0, error_m=0.05, error_rad=0.01),
    ]


def places() -> list[Place]:
    """The building of `benchmarks.changes`, that of the sample recordings, halls of pallets, and a comb of rooms.

    The near-sighted robot sees 4 m far, and beyond that nothing that is evidence.
    """
    patrol = patrols.patrols(2)[1].drive()
    round_ = pallet_hall.drives("wh30", 1)["day_01"]
    hall = Place("hall", round_.world, round_.motion, 12.0, missing_is_free=True)
    return [
        Place("building", patrol.world, patrol.motion, 25.0),
        Place("sample", sample_building.building(0.0, ()), sample_building.patrol(1), 12.0),
        hall,
        replace(hall, name="hall, near-sighted", range_max=4.0, missing_is_free=False),
        Place("comb", _comb(), _through_the_comb(), 12.0),
    ]


COMB_ROOMS, COMB_WIDTH, COMB_DEPTH, COMB_CORRIDOR = 8, 1.5, 3.0, 1.6  # [m]


def _comb() -> World:
    """Narrow rooms side by side, with walls of 0.1 m between them, and doorways to a corridor."""
    end, top = COMB_ROOMS * COMB_WIDTH, COMB_CORRIDOR + COMB_DEPTH
    doorways = [((i + 0.5) * COMB_WIDTH - 0.45, (i + 0.5) * COMB_WIDTH + 0.45) for i in range(COMB_ROOMS)]
    thin = 0.1
    walls = [wall((0, 0), (end, 0), thickness=thin), wall((0, top), (end, top), thickness=thin)]
    walls += [wall((0, 0), (0, top), thickness=thin), wall((end, 0), (end, top), thickness=thin)]
    walls += [wall((0, COMB_CORRIDOR), (end, COMB_CORRIDOR), doorways, thickness=thin)]
    between = [i * COMB_WIDTH for i in range(1, COMB_ROOMS)]
    walls += [wall((x, COMB_CORRIDOR), (x, top), thickness=thin) for x in between]
    return World(np.concatenate(walls))


def _through_the_comb() -> Motion:
    lane, inside = COMB_CORRIDOR / 2, COMB_CORRIDOR + COMB_DEPTH - 0.8
    points = [(0.5, lane)]
    for x in ((i + 0.5) * COMB_WIDTH for i in range(COMB_ROOMS)):
        points += [(x, lane), (x, inside), (x, lane)]
    return drive([*points, (COMB_ROOMS * COMB_WIDTH - 0.5, lane)], 0.6, 1.0)


@dataclass(frozen=True, slots=True)
class Driven:
    """The scans of a drive, and where the laser really was."""

    sweeps: Sweeps
    lasers: Floats  # (n, 2) [m] at the first beam
    times: Floats  # (n,) [s] by the world's clock


def driven(place: Place, setup: Setup, seed: int = SEED) -> Driven:
    """Drive through a place."""
    rng = np.random.Generator(np.random.PCG64([seed, setup.degrees, round(setup.rate)]))
    scanner = setup.scanner(place.range_max)
    starts = np.arange(0.3, place.motion.duration - 0.3, scanner.period)
    starts = starts + rng.uniform(0, 0.001, len(starts))
    ranges = np.concatenate(
        [
            scanner.scan(place.world, place.motion, starts[i : i + BLOCK], rng)
            for i in range(0, len(starts), BLOCK)
        ]
    )
    if not place.missing_is_free:
        ranges[np.isinf(ranges)] = np.nan
    error = _errors(place.motion, setup, rng)
    ends = starts + scanner.sweep_time
    first, last = (_laser(place.motion.at(t), error(t), setup.ahead) for t in (starts, ends))
    true = _laser(place.motion.at(starts), np.zeros((len(starts), 3)), setup.ahead)
    stamps_ns = np.rint(starts * 1e9).astype(np.int64) + patrols.FIRST_NS
    sweeps = Sweeps(stamps_ns, ranges, scanner.bearings, place.range_max, first, last, 0)
    return Driven(sweeps, true[:, :2, 3], starts)


def _errors(motion: Motion, setup: Setup, rng: np.random.Generator) -> Callable[[Floats], Floats]:
    times = np.arange(0.0, motion.duration, 1 / _LOCALISATION)
    errors = localisation_errors(motion.at(times), rng, setup.error_m, setup.error_rad)
    return Motion(times, errors).at


def _laser(robot: Floats, error: Floats, ahead: float) -> npt.NDArray[np.float64]:
    """map_from_laser (n, 3, 4) of a robot that is believed to be where it is but for an error."""
    x, y, yaw = compose(compose(robot, error), np.array([ahead, 0.0, 0.0])).T
    pose = np.zeros((len(x), 3, 4))
    pose[:, 0, 0] = pose[:, 1, 1] = np.cos(yaw)
    pose[:, 1, 0], pose[:, 0, 1] = np.sin(yaw), -np.sin(yaw)
    pose[:, 2, 2], pose[:, 0, 3], pose[:, 1, 3], pose[:, 2, 3] = 1, x, y, 0.3
    return pose
