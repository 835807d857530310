"""What the maps of a result are worth: how much of what stands is in them, and how much that does not.

A cell is right within 11 cm of a true surface, a ghost farther than 15 cm from every one. A surface that was seen
that day is recalled where an occupied cell lies within 11 cm of it; it was seen within 11 cm of a beam's true end.
(Within 12 cm, the thickness of a wall, its far side would be seen as well.)
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import mean
from typing import Any

import numpy as np
import numpy.typing as npt
from rosbags.highlevel import AnyReader

from sample_logs.drives import Drive
from sample_logs.rays import Floats
from sample_logs.world import World, outline_segments
from timemap_cli.results.reader import ResultReader

OCCUPIED = 100
RIGHT_M, GHOST_M, SEEN_M = 0.11, 0.15, 0.11
_EXACTLY_M = 1e-9  # what is just as far is no farther
_SAMPLE_M = 0.02  # between the samples of a surface
_HIT_M = 0.005  # beams that end in one square of this side count once
_EVERY = 2  # of so many scans one is asked what it saw
_AT_ONCE = 500  # bounds the memory


@dataclass(frozen=True, slots=True)
class Grid:
    """A map of a level, axes along the map frame's."""

    stamp_ns: int
    cells: npt.NDArray[np.int8]  # (rows along +y, columns along +x)
    resolution: float  # [m]
    origin: tuple[float, float]  # [m] lower left corner

    def occupied(self) -> Floats:
        """Centres (n, 2) [m] of the occupied cells."""
        row, column = np.nonzero(self.cells == OCCUPIED)
        return np.stack([column + 0.5, row + 0.5], axis=1) * self.resolution + self.origin


@dataclass(frozen=True, slots=True)
class MapScore:
    """How well one map shows one day."""

    precision: float  # share of the occupied cells; 1 where there are none
    recall: float  # share of the surface that was seen that day
    ghosts: float  # [m^2]


def grids(result: Path, level: str) -> list[Grid]:
    """All maps of a level, in the order of writing."""
    found = []
    with AnyReader([result]) as reader:
        topics = [c for c in reader.connections if c.topic == f"/timemap/{level}/map"]
        for connection, stamp_ns, raw in reader.messages(connections=topics):
            message: Any = reader.deserialize(raw, connection.msgtype)
            info = message.info
            cells = np.asarray(message.data, np.int8).reshape(info.height, info.width)
            origin = (info.origin.position.x, info.origin.position.y)
            found.append(Grid(stamp_ns, cells, round(float(info.resolution), 6), origin))
    return found


def newest(maps: Sequence[Grid], before_ns: float) -> Grid:
    """The newest map that was written before a time."""
    return [grid for grid in maps if grid.stamp_ns < before_ns][-1]


def standing(world: World) -> Floats:
    """Segments (m, 4) of all that stands when the world's clock is 0."""
    there = [outline_segments(t.outline) for t in world.things if t.since <= 0.0 < t.until]
    return np.concatenate([world.walls, *there])


def seen_surface(drive: Drive) -> Floats:
    """Samples (n, 2) [m] of the surfaces that the laser of a drive saw from where it really was."""
    scanner, motion = drive.scanner, drive.motion
    starts = np.arange(0.3, motion.duration - 0.3, _EVERY * scanner.period)
    ends = []
    still = World(drive.world.walls, drive.world.things)
    for part in np.array_split(starts, 1 + len(starts) // 64):
        times = part[:, None] + np.arange(scanner.beams) * scanner.time_increment
        origins, bearings = scanner.rays(motion.at(times))
        ranges = still.ranges(np.zeros(len(part)), origins, bearings, scanner.range_max)
        points = origins + np.nan_to_num(ranges, posinf=0.0)[..., None] * np.stack(
            [np.cos(bearings), np.sin(bearings)], axis=-1
        )
        ends.append(np.unique(np.round(points[np.isfinite(ranges)] / _HIT_M), axis=0))
    samples = _samples(standing(still))
    return samples[_distance(samples, np.unique(np.concatenate(ends), axis=0) * _HIT_M) <= SEEN_M]


def score_map(grid: Grid, world: World, seen: Floats) -> MapScore:
    """Hold a map against the world of that day, and the surface (n, 2) that was seen of it."""
    occupied = grid.occupied()
    away = _beside_segments(occupied, standing(world))
    found = _distance(seen, occupied) <= RIGHT_M
    return MapScore(
        float(np.mean(away <= RIGHT_M)) if len(away) else 1.0,
        float(found.mean()),
        float(np.sum(away > GHOST_M + _EXACTLY_M)) * grid.resolution**2,
    )


def maps_of_day(result: Path, drives: Sequence[Drive], day: int) -> dict[str, MapScore]:
    """How well each level's map at the end of a day shows it; `drives` are of all days."""
    drive = drives[day - 1]
    before_ns = drives[day].start_ns if day < len(drives) else math.inf
    seen = seen_surface(drive)
    return {
        level: score_map(newest(grids(result, level), before_ns), drive.world, seen)
        for level in levels_of(result)
    }


def levels_of(result: Path) -> list[str]:
    """The levels of a result, the fastest first."""
    with ResultReader(result) as reader:
        return list(reader.levels)


def mean_score(scores: Iterable[MapScore]) -> MapScore:
    """The mean of each figure."""
    every = list(scores)
    return MapScore(
        mean(s.precision for s in every), mean(s.recall for s in every), mean(s.ghosts for s in every)
    )


def walls_left(result: Path, changes: Mapping[str, Any], level: str) -> int:
    """Occupied cells of a level's last map inside vanished events that it adopted and that still hold.

    `changes` is a document of schema timemap.changes/1.
    """
    maps = grids(result, level)
    if not maps:
        return 0
    cells = maps[-1].occupied()
    inside = np.zeros(len(cells), bool)
    for event in changes["events"]:
        if event["kind"] == "vanished" and event["closed_ns"] is None and event["adopted"][level] is not None:
            inside |= _inside(cells, np.array(event["outline"], dtype=float).reshape(-1, 2))
    return int(inside.sum())


def _inside(points: Floats, outline: Floats) -> npt.NDArray[np.bool_]:
    """Whether points (n, 2) lie inside a closed outline (k, 2)."""
    odd = np.zeros(len(points), bool)
    for (x1, y1), (x2, y2) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        if y1 != y2:
            across = (points[:, 1] < y1) != (points[:, 1] < y2)
            odd ^= across & (points[:, 0] < x1 + (points[:, 1] - y1) / (y2 - y1) * (x2 - x1))
    return odd


def _samples(segments: Floats) -> Floats:
    """Points (n, 2) along segments (m, 4)."""
    lengths = np.linalg.norm(segments[:, 2:] - segments[:, :2], axis=1)
    return np.concatenate([
        np.linspace(s[:2], s[2:], 2 + int(length / _SAMPLE_M)) for s, length in zip(segments, lengths, strict=True)
    ])  # fmt: skip


def _distance(points: Floats, others: Floats) -> Floats:
    """From each of the points (n, 2) to the nearest of others (m, 2) [m]; infinite where there are none."""
    if not len(others):
        return np.full(len(points), np.inf)
    found = []
    for i in range(0, len(points), _AT_ONCE):
        part = points[i : i + _AT_ONCE]
        x, y = (part[:, None, axis] - others[None, :, axis] for axis in (0, 1))
        found.append(np.sqrt((x * x + y * y).min(1)))
    return np.concatenate(found) if found else np.empty(0)


def _beside_segments(points: Floats, segments: Floats) -> Floats:
    """From each of the points (n, 2) to the nearest of the segments (m, 4) [m]."""
    start, edge = segments[None, :, :2], (segments[:, 2:] - segments[:, :2])[None]
    share = np.clip(((points[:, None] - start) * edge).sum(-1) / np.maximum((edge**2).sum(-1), 1e-12), 0, 1)
    return np.asarray(np.linalg.norm(points[:, None] - start - share[..., None] * edge, axis=-1).min(1))
