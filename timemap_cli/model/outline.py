"""What one scan saw free, as a polygon round the robot, relative to the node that is to learn from it."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.free_ways import ROBOT_RADIUS
from timemap_cli.model.rays import Bools, Floats, Rays, rays
from timemap_cli.model.sweeps import Sweeps

Poses = npt.NDArray[np.float64]

BLIND_MARGIN = 0.1  # [m] by which the disc round the robot reaches beyond a node to which the way is free
LARGEST_DISC = 2.5  # [m] a node farther away than this must have been seen
_CHORD = np.float32(1.072)  # 1 / cos^2 of half a step of the arc behind the field of view ...
_MORE = np.float32(0.02)  # [m] ... and a little, lest the node lie on the chord


@dataclass(frozen=True, slots=True)
class Outlines:
    """One closed polygon for each of n scans, its vertices in scanning order, the first repeated at the end.

    A vertex is the end of a ray: a hit, the end of what a missing return frees, or, where there is no evidence
    and outside the field of view, a point on the small disc that is free because the robot stands there.
    """

    x: Floats  # (n, vertices + 1) [m] relative to the node's centre, map axes
    y: Floats  # (n, vertices + 1) [m]
    hit: Bools  # (n, vertices + 1) vertex is a measured surface
    disc: Bools  # (n, vertices + 1) vertex is on the disc: nothing was seen in its direction
    turn: Floats  # (n, 1) +1: vertices run counter-clockwise round the robot, -1: clockwise


def outlines(sweeps: Sweeps, centres: npt.NDArray[np.float64], ways_free: Bools, angle_bins: int) -> Outlines:
    """Polygons of n scans relative to the n node centres (n, 2) [m, map frame]; `ways_free` (n,) as in `FreeWays`."""
    first, last = sweeps.map_from_laser_first, sweeps.map_from_laser_last
    fan = rays(sweeps, angle_bins)
    origin = first[:, :2, 3] - centres
    missing = np.isnan(fan.length)
    away = _away(origin)
    blind = np.where(ways_free, np.minimum(away + BLIND_MARGIN, LARGEST_DISC), ROBOT_RADIUS)
    length = np.where(missing, blind.astype(np.float32)[:, None], fan.length)
    leaves = np.flatnonzero(ways_free & (_away(last[:, :2, 3] - centres) > away))
    if len(leaves):
        behind = _beyond_node(first[leaves], last[leaves], centres[leaves], fan.of(leaves))
        np.maximum(length[leaves], behind, out=behind)
        length[leaves] = np.where(missing[leaves], behind, length[leaves])
    moves = not np.array_equal(first, last)
    turning = _Turning.of(first, last, fan.progress) if moves else None
    x, y = (_place(first[:, a], (last - first)[:, a], origin[:, a], fan, length, turning) for a in (0, 1))
    hit, disc = np.empty(x.shape, np.bool_), np.empty(x.shape, np.bool_)
    hit[:, :-1] = fan.hit
    disc[:, :-1] = missing
    _bridge(x, y, hit, disc, missing)
    for vertices in (x, y, hit, disc):
        vertices[:, -1] = vertices[:, 0]
    upright = first[:, 0, 0] * first[:, 1, 1] - first[:, 0, 1] * first[:, 1, 0] > 0
    turn = np.where(upright == fan.counter_clockwise, np.float32(1), np.float32(-1))
    return Outlines(x, y, hit, disc, turn[:, None])


def _away(offset: Poses) -> Poses:
    return np.asarray(np.sqrt(offset[:, 0] ** 2 + offset[:, 1] ** 2))


def _beyond_node(first: Poses, last: Poses, centres: Poses, fan: Rays) -> Floats:
    """How long rays (n, rays) [m] towards a node must be to reach beyond it, wherever the laser is by then.

    A laser that drives away within its sweep is farther from the node at its last beam than at its first. A chord
    over one step of the arc passes outside the node where both its ends reach so far beyond it, each along its ray.
    """
    ahead, aside = (
        [_along(pose, centres, axis).astype(np.float32)[:, None] for pose in (first, last)] for axis in (0, 1)
    )
    reach = fan.cos * (ahead[0] + fan.progress * (ahead[1] - ahead[0]))
    reach += fan.sin * (aside[0] + fan.progress * (aside[1] - aside[0]))
    reach *= _CHORD
    reach += _MORE
    np.minimum(reach, np.float32(LARGEST_DISC), out=reach)
    return reach


def _along(pose: Poses, centres: Poses, axis: int) -> Poses:
    """How far the node's centre (n,) [m] lies along an axis of the laser."""
    x, y = (centres - pose[:, :2, 3]).T
    return np.asarray(pose[:, 0, axis] * x + pose[:, 1, axis] * y)


@dataclass(frozen=True, slots=True)
class _Turning:
    """How a direction turns evenly from where the first pose has it to where the last has it.

    It is `stretch * first + share * (last - first)` (n, rays). Where nothing turns, stretch is exactly 1.
    """

    stretch: Floats
    share: Floats

    @classmethod
    def of(cls, first: Poses, last: Poses, progress: Floats) -> "_Turning":
        """Weights sin(p theta) / sin(theta) at progress p, as a series: library sines differ between processors."""
        difference = last[:, :, :3] - first[:, :, :3]
        v = (difference * difference).sum(axis=(1, 2)) / 4  # 1 - cos(theta)
        square = 2 * v * (1 + v * (1 / 6 + v * (2 / 45 + v / 70)))  # theta^2
        behind = 1 - progress
        gained = _gained(square, progress)
        return cls(1 + (gained + _gained(square, behind)), progress + gained)


def _gained(square: npt.NDArray[np.float64], part: Floats) -> Floats:
    """sin(p theta) / sin(theta) - p for p (n, rays) and theta^2 (n,), to the sixth order."""
    t = square
    constant = t * (1 / 6 + t * (7 / 360 + t * (31 / 15120)))
    linear = -t * t * (3 / 360 + t * (18 / 15120))
    quadratic = t * t * t * (3 / 15120)
    c0, c1, c2 = (each.astype(np.float32)[:, None] for each in (constant, linear, quadratic))
    p2 = part * part
    gained: Floats = c2 * p2
    gained += c1
    gained *= p2
    gained += c0
    gained *= part * (1 - p2)
    return gained


def _place(
    pose: Poses,
    change: Poses,
    origin: npt.NDArray[np.float64],
    fan: Rays,
    length: Floats,
    turning: _Turning | None,
) -> Floats:
    """One coordinate (n, rays + 1) [m] of the ends of all rays; the last column is left for the closing vertex.

    `pose` (n, 4) is that coordinate's row of map_from_laser at the first beam, `change` (n, 4) what it changes by
    until the last; `origin` (n,) is the laser's coordinate relative to the node. Without `turning` nothing moves.
    """
    out = np.empty((len(length), length.shape[1] + 1), np.float32)
    end = out[:, :-1]
    along_x, along_y, at = (column.astype(np.float32)[:, None] for column in (pose[:, 0], pose[:, 1], origin))
    np.multiply(along_x, fan.cos, out=end)
    end += along_y * fan.sin
    if turning:
        end *= turning.stretch
        step = change.astype(np.float32)
        turned = step[:, 0, None] * fan.cos
        turned += step[:, 1, None] * fan.sin
        turned *= turning.share
        end += turned
    end *= length
    end += at
    if turning:
        end += step[:, 3, None] * fan.progress
    return out


def _bridge(x: Floats, y: Floats, hit: Bools, disc: Bools, missing: Bools) -> None:
    """Lay vertices of one or two rays without evidence onto the vertex before them, in place."""
    there = ~missing
    one = missing[:, 1:-1] & there[:, :-2] & there[:, 2:]
    two = missing[:, 1:-2] & missing[:, 2:-1] & there[:, :-3] & there[:, 3:]
    for run, length in ((one, 1), (two, 2)):
        row, before = np.nonzero(run)
        for step in range(1, length + 1):
            for vertex in (x, y, hit, disc):
                vertex[row, before + step] = vertex[row, before]
