"""What one scan saw free, as a polygon round the robot, relative to the node that is to learn from it."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.sweeps import Sweeps

Floats = npt.NDArray[np.float32]
Bools = npt.NDArray[np.bool_]

BLIND_MARGIN = 0.1  # [m] by which the disc where the robot stands reaches beyond the node's centre
BRIDGED_BEAMS = 2  # as many beams in a row without evidence do not open the polygon
_ARC_STEP = math.radians(30)  # coarse enough to be cheap; the chord still passes outside the node's centre


@dataclass(frozen=True, slots=True)
class Outlines:
    """One closed polygon for each of n scans, its vertices in scanning order, the first repeated at the end.

    A vertex is the end of a beam: a hit, the end of what a missing return frees, or, where there is no evidence
    and outside the field of view, a point on the small disc that is free because the robot stands there.
    """

    x: Floats  # (n, vertices + 1) [m] relative to the node's centre, map axes
    y: Floats  # (n, vertices + 1) [m]
    hit: Bools  # (n, vertices + 1) vertex is a measured surface
    turn: Floats  # (n, 1) +1: vertices run counter-clockwise round the robot, -1: clockwise


@dataclass(frozen=True, slots=True)
class _Fan:
    """Directions of a scanner's beams, followed by those of the arc behind its field of view."""

    cos: Floats  # (directions,)
    sin: Floats  # (directions,)
    progress: Floats  # (directions,) 0 at the first beam, 1 at the last, back to 0 along the arc
    counter_clockwise: bool


def outlines(sweeps: Sweeps, centres: npt.NDArray[np.float64]) -> Outlines:
    """Polygons of n scans relative to the n node centres (n, 2) [m, map frame]."""
    fan = _fan(sweeps.bearings.tobytes())
    first, last = sweeps.map_from_laser_first, sweeps.map_from_laser_last
    origin = first[:, :2, 3] - centres  # (n, 2)
    blind = np.hypot(origin[:, 0], origin[:, 1]).astype(np.float32)[:, None] + np.float32(BLIND_MARGIN)
    length, hit = _lengths(sweeps, blind, len(fan.cos))
    moves = bool(np.any(first != last))
    if moves:
        length *= _chord_correction(first, last, fan.progress)
    x = _place(first, last, 0, origin[:, 0], fan, length, moves)
    y = _place(first, last, 1, origin[:, 1], fan, length, moves)
    _bridge(x, y, hit, np.isnan(sweeps.ranges))
    for array in (x, y, hit):
        array[:, -1] = array[:, 0]
    upright = first[:, 0, 0] * first[:, 1, 1] - first[:, 0, 1] * first[:, 1, 0] > 0
    turn = np.where(upright == fan.counter_clockwise, np.float32(1), np.float32(-1))
    return Outlines(x, y, hit, turn[:, None])


@lru_cache(maxsize=16)
def _fan(float64_bearings: bytes) -> _Fan:
    bearings = np.frombuffer(float64_bearings)
    start, stop = float(bearings[0]), float(bearings[-1])
    sign = 1.0 if stop >= start else -1.0
    gap = 2 * math.pi - abs(stop - start)
    spacing = abs(stop - start) / max(1, len(bearings) - 1)
    angles = bearings.tolist()
    progress = [i / max(1, len(angles) - 1) for i in range(len(angles))]
    if gap > (BRIDGED_BEAMS + 0.5) * spacing or len(angles) < 3:
        pieces = math.ceil(gap / _ARC_STEP)
        angles += [stop + sign * gap * i / pieces for i in range(pieces + 1)]
        progress += [1 - i / pieces for i in range(pieces + 1)]
    # cos and sin one by one: NumPy's own differ between processors in the last bit
    cos = np.array([math.cos(a) for a in angles], np.float32)
    sin = np.array([math.sin(a) for a in angles], np.float32)
    return _Fan(cos, sin, np.array(progress, np.float32), sign > 0)


def _lengths(sweeps: Sweeps, blind: Floats, directions: int) -> tuple[Floats, Bools]:
    """Length of every vertex' ray from the laser (n, directions) and whether it is a hit (n, directions + 1)."""
    n, beams = sweeps.ranges.shape
    length = np.empty((n, directions), np.float32)
    length[:, :beams] = sweeps.ranges
    length[:, beams:] = blind
    hit = np.zeros((n, directions + 1), np.bool_)
    np.isfinite(sweeps.ranges, out=hit[:, :beams])
    if not hit[:, :beams].all():
        np.minimum(length[:, :beams], np.float32(sweeps.clear_range), out=length[:, :beams], where=~hit[:, :beams])
        np.copyto(length, blind, where=np.isnan(length))
    return length, hit


def _chord_correction(
    first: npt.NDArray[np.float64], last: npt.NDArray[np.float64], progress: Floats
) -> Floats:
    """Factor (n, directions) that takes a blend of two rotations back to length 1, to second order.

    Half way between two directions theta apart, their mean is shorter by theta^2 / 8.
    """
    difference = last[:, :, :3] - first[:, :, :3]
    squared = (difference * difference).sum(axis=(1, 2)) / 4  # theta^2 / 2
    bend = progress * (1 - progress)
    return np.asarray(1 + squared.astype(np.float32)[:, None] * bend, np.float32)


def _place(
    first: npt.NDArray[np.float64],
    last: npt.NDArray[np.float64],
    axis: int,
    origin: npt.NDArray[np.float64],
    fan: _Fan,
    length: Floats,
    moves: bool,
) -> Floats:
    """One map coordinate (n, directions + 1) of all vertices; the last column is left for the closing vertex."""
    column = [m.astype(np.float32)[:, None] for m in (first[:, axis, 0], first[:, axis, 1], origin)]
    out = np.empty((len(length), length.shape[1] + 1), np.float32)
    point = out[:, :-1]
    np.multiply(column[0], fan.cos, out=point)
    point += column[1] * fan.sin
    if moves:
        change = (last - first)[:, axis].astype(np.float32)
        point += change[:, 0, None] * (fan.progress * fan.cos)
        point += change[:, 1, None] * (fan.progress * fan.sin)
    point *= length
    point += column[2]
    if moves:
        point += change[:, 3, None] * fan.progress
    return out


def _bridge(x: Floats, y: Floats, hit: Bools, missing: Bools) -> None:
    """Lay vertices of short runs without evidence onto the vertex before them, in place."""
    if not missing.any():
        return
    beams = missing.shape[1]
    index = np.arange(beams)
    before = np.maximum.accumulate(np.where(missing, -1, index), axis=1)
    after = np.minimum.accumulate(np.where(missing, beams, index)[:, ::-1], axis=1)[:, ::-1]
    short = missing & (after - before - 1 <= BRIDGED_BEAMS) & (before >= 0) & (after < beams)
    row, column = np.nonzero(short)
    source = before[row, column]
    for vertex in (x, y, hit):
        vertex[row, column] = vertex[row, source]
