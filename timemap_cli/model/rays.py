"""The rays of a scan that matter to a node: the nearest of a few neighbouring beams, and the arc behind the scanner.

A scanner finer than the angle bins says the same thing several times. Of each group of beams within half an angle bin
only the nearest is followed: it is the one that an angle bin would keep, and it halves the work.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.sweeps import Sweeps

Floats = npt.NDArray[np.float32]
Bools = npt.NDArray[np.bool_]

_ARC_STEP = math.radians(30)  # coarse enough to be cheap; the chord still passes outside the node's centre
_LONGEST = np.float32(1000)  # [m] beyond every radius; the square of a driver's largest number is infinite
_WIDEST_SEAM = 2.5  # beam spacings between the last beam and the first that still close the circle


@dataclass(frozen=True, slots=True)
class Rays:
    """Rays of n scans from the laser, in scanning order; those behind the field of view come last.

    Directions are the same for all scans (1, rays), or each scan has its own (n, rays).
    """

    cos: Floats  # of the direction, in the laser's plane
    sin: Floats
    progress: Floats  # 0 at the first beam, 1 at the last, back to 0 behind
    length: Floats  # (n, rays) [m] of a hit; what a missing return frees; NaN where there is no evidence
    hit: Bools  # (n, rays)
    counter_clockwise: bool  # from the laser's +x to its +y

    def of(self, scans: npt.NDArray[np.int64]) -> "Rays":
        """The rays of these scans alone."""
        cos, sin, progress = (
            each if len(each) == 1 else each[scans] for each in (self.cos, self.sin, self.progress)
        )
        return Rays(cos, sin, progress, self.length[scans], self.hit[scans], self.counter_clockwise)


@dataclass(frozen=True, slots=True)
class _Fan:
    """Directions of a scanner's beams, then those of the arc behind its field of view."""

    cos: Floats  # (directions,)
    sin: Floats
    progress: Floats
    beams: int
    spacing: float  # [rad]
    counter_clockwise: bool


def rays(sweeps: Sweeps, angle_bins: int) -> Rays:
    """Rays of a block of scans for nodes with so many angle bins."""
    fan = _fan(sweeps.bearings.tobytes())
    group = max(1, min(fan.beams, int(math.pi / angle_bins / fan.spacing + 1e-6)))
    kept = -(-fan.beams // group)
    behind = np.arange(fan.beams, len(fan.cos))
    length = np.full((len(sweeps), kept + len(behind)), np.nan, np.float32)
    if group > 1:
        column = np.empty(length.shape, np.int64)
        column[:, :kept] = _nearest_of_each(sweeps.ranges, group, length[:, :kept])
        column[:, kept:] = behind
        cos, sin, progress = (each.take(column) for each in (fan.cos, fan.sin, fan.progress))
    else:
        length[:, :kept] = sweeps.ranges
        cos, sin, progress = (each[None] for each in (fan.cos, fan.sin, fan.progress))
    hit = np.isfinite(length)
    np.minimum(length, np.float32(sweeps.clear_range), out=length, where=~hit)  # NaN stays NaN
    np.minimum(length, _LONGEST, out=length)
    return Rays(cos, sin, progress, length, hit, fan.counter_clockwise)


def _nearest_of_each(ranges: Floats, group: int, nearest: Floats) -> npt.NDArray[np.int64]:
    """Write the nearest of each group of beams into `nearest` (n, groups) and return which beam it was.

    A hit goes before a missing return, and that before no evidence.
    """
    n, beams = ranges.shape
    groups = nearest.shape[1]
    chosen = np.tile(np.arange(0, groups * group, group), (n, 1))
    nearest[:] = ranges[:, ::group]
    for offset in range(1, group):
        other = ranges[:, offset::group]
        so_far = nearest[:, : other.shape[1]]
        nearer = np.fmin(so_far, other)
        np.copyto(chosen[:, : other.shape[1]], np.arange(offset, beams, group), where=nearer != so_far)
        so_far[:] = nearer
    return chosen


@lru_cache(maxsize=16)
def _fan(float64_bearings: bytes) -> _Fan:
    angles = np.frombuffer(float64_bearings).tolist()
    beams, start, stop = len(angles), angles[0], angles[-1]
    last = max(1, beams - 1)
    sign = 1.0 if stop >= start else -1.0
    spacing = abs(stop - start) / last or math.tau
    progress = [i / last for i in range(beams)]
    gap = math.tau - abs(stop - start)
    if gap > _WIDEST_SEAM * spacing or beams < 3:
        pieces = max(1, math.ceil(gap / _ARC_STEP))
        angles += [stop + sign * gap * i / pieces for i in range(pieces + 1)]
        progress += [1 - i / pieces for i in range(pieces + 1)]
    cos, sin = (each.astype(np.float32) for each in cos_sin(np.array(angles)))
    return _Fan(cos, sin, np.array(progress, np.float32), beams, spacing, sign > 0)
