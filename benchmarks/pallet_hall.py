"""A pallet hall whose 52 places are redrawn every night: what stands where on which day, and the robot's rounds.

whNN: each night each place is emptied or filled anew with a chance of NN %. whc: half of the places are redrawn every
day, the other half stays.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin

from sample_logs.building import walk
from sample_logs.drives import Drive, Rates
from sample_logs.laser import Mount, Scanner
from sample_logs.rays import Floats
from sample_logs.recorder import write_ros2_folder
from sample_logs.robot import Motion, drive
from sample_logs.world import Thing, Walk, World, box, wall

KINDS = ("wh10", "wh30", "wh50", "whc")
DAYS = 10
DAY = 86400.0
FIRST_NS = 1_709_510_400_000_000_000  # 2024-03-04 00:00 UTC, a Monday: day 1
WIDTH, DEPTH = 24.0, 15.8
SPEED, TURN_RATE = 1.0, 1.2
ROWS, AISLES = (2.9, 6.3, 9.7, 13.1), (1.2, 4.6, 8.0, 11.4, 14.7)
PLACES = [(3.0 + 1.5 * i, y) for y in ROWS for i in range(13)]
FILLED = 0.6  # of the places

SCANNER = Scanner(
    first_deg=-135.0, step_deg=0.5, beams=541, period=0.1, sweep_time=0.0333, range_min=0.06, range_max=12.0,
    mount=Mount(0.18, 0, 0.3, 0), missing=0.01,
)  # fmt: skip


def begins(day: int) -> float:
    """Seconds from midnight before day 1 to the round of a day."""
    return (day - 1) * DAY + 9 * 3600


def things(kind: str, days: int = DAYS) -> list[Thing]:
    """All that stands in a hall of this kind, times in seconds since midnight before day 1."""
    columns = [Thing("column", box(x - 0.75, y, 0.3, 0.3)) for x in (8.0, 16.0) for y in (3.7, 12.3)]
    return (_half_staged(days) if kind == "whc" else _redrawn(int(kind[2:]), days)) + columns


def hall(kind: str, day: int, walks: tuple[Walk, ...] = (), days: int = DAYS) -> World:
    """The hall on a day, its clock set to 0 when the round begins."""
    here = [replace(t, since=t.since - begins(day), until=t.until - begins(day)) for t in things(kind, days)]
    return World(walls(), here, walks)


def walls() -> Floats:
    """Segments (m, 4) of the walls."""
    gates = [(10.0, 13.0)], [(6.0, 9.0)]
    sides = [wall((0, 0), (WIDTH, 0)), wall((0, DEPTH), (WIDTH, DEPTH), gates[0])]
    return np.concatenate([*sides, wall((0, 0), (0, DEPTH)), wall((WIDTH, 0), (WIDTH, DEPTH), gates[1])])


def patrol(day: int) -> Motion:
    """The robot's true way on that day: all aisles, on every second day in the other direction."""
    points: list[tuple[float, float]] = []
    ends = (1.0, WIDTH - 1.0)
    for i, y in enumerate(AISLES):
        points += [(x, y) for x in (ends if i % 2 == 0 else ends[::-1])]
    if points[-1][0] != ends[0]:
        points.append((ends[0], AISLES[-1]))
    points.append((1.0, 1.2))
    return drive(points if day % 2 else points[::-1], SPEED, TURN_RATE)


def make(folder: Path, kind: str, days: int = DAYS) -> list[Path]:
    """Write the recordings that `folder` does not hold yet; the paths of all, in order."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"day_{day:02d}" for day in range(1, days + 1)]
    for day, path in enumerate(paths, 1):
        if not (path / "metadata.yaml").exists():
            shutil.rmtree(path, ignore_errors=True)  # left behind by a run that was interrupted
            write_ros2_folder(path, _round(kind, day, days).events(), StoragePlugin.MCAP, compressed=True)
    return paths


def _round(kind: str, day: int, days: int) -> Drive:
    rng = np.random.default_rng([31, day, len(kind)])
    motion = patrol(day)
    start = rng.uniform(0, motion.duration - 40, 2)
    walks = (
        walk("p1", start[0], 1.1, (1.0, 4.9), (WIDTH - 1, 4.9)),
        walk("p2", start[1], 1.0, (WIDTH - 1, 11.1), (1.0, 11.1)),
    )
    x, y, yaw = (np.clip(rng.normal(size=3), -2, 2) * (0.02, 0.02, 0.002)).tolist()
    return Drive(
        hall(kind, day, walks, days), motion, SCANNER, Rates(odometry=20, localisation=10),
        FIRST_NS + round(begins(day) * 1e9), day * 17 + 3, error_m=0.025, error_rad=0.005, map_offset=(x, y, yaw),
    )  # fmt: skip


def _pallet(rng: np.random.Generator, x: float, y: float) -> Floats:
    return box(
        x + rng.normal(0, 0.08), y + rng.normal(0, 0.12), 1.2, 0.8 * rng.uniform(0.8, 1.2), rng.normal(0, 4)
    )


def _half_staged(days: int) -> list[Thing]:
    rng = np.random.default_rng(11)
    staged = set(rng.choice(len(PLACES), len(PLACES) // 2, replace=False).tolist())
    found = []
    for i, (x, y) in enumerate(PLACES):
        if i in staged:
            found += [
                Thing("staged", _pallet(rng, x, y), since=(day - 1) * DAY, until=day * DAY)
                for day in range(1, days + 1)
                if rng.random() < 0.5
            ]
        elif rng.random() < FILLED:
            found.append(Thing("pallet", _pallet(rng, x, y)))
    return found


def _redrawn(percent: int, days: int) -> list[Thing]:
    rng = np.random.default_rng([7, percent])
    return [thing for x, y in PLACES for thing in _redrawn_place(rng, x, y, percent / 100, days)]


def _redrawn_place(rng: np.random.Generator, x: float, y: float, turnover: float, days: int) -> list[Thing]:
    """What stands at one place, one after the other."""
    found: list[Thing] = []
    for day in range(1, days + 1):
        if day > 1 and rng.random() >= turnover:
            continue
        since = (day - 1) * DAY if day > 1 else -np.inf
        if found and found[-1].until == np.inf:
            found[-1] = replace(found[-1], until=since)
        if rng.random() < FILLED:
            found.append(Thing("pallet", _pallet(rng, x, y), since=since))
    return found
