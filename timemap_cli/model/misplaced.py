"""How well a scan fits what its node holds if the robot is elsewhere than it believes: moved, and turned, a little."""

import math
from functools import cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.angles import quarter_turns
from timemap_cli.model.contradiction import ANYTHING, MIN_VIEW, Bounds
from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.virtual_scan import CLEAR, Ranges

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FARTHEST, SHIFT = 1000, 200  # [mm] so far a scan is shifted, in steps of what may differ anyway ...
MOST_TURN, TURN = 24, 4  # [degrees] ... and turned
LOOKS = 180  # of the circle at most are followed: that is as good as all, and cheap


def fits(ranges: Ranges, bounds: Bounds) -> Floats:
    """Share of a scan's hits (angle_bins,) that its node's `bounds` (one row) allow, for each misplacement (k,).

    `unmoved(angle_bins)` is the number of the one that leaves the scan where it is. Of very few hits the share is
    small: they may fit anywhere.
    """
    angle_bins = len(ranges)
    hits = np.flatnonzero(ranges < CLEAR)[:: max(1, angle_bins // LOOKS)]
    place, cell = _moved(ranges[hits], hits, angle_bins)
    low, width = bounds.low[0], bounds.width[0]
    allowed = np.empty((len(turns(angle_bins)), len(place)), np.int64)
    for i, turn in enumerate(turns(angle_bins).tolist()):
        there = (cell + turn) % angle_bins
        room = width.take(there)
        inside = place - low.take(there) <= room  # whole numbers wrap: what lies below is far above
        allowed[i] = (inside & (room != ANYTHING)).sum(axis=1)
    least = MIN_VIEW * min(angle_bins, LOOKS)
    return allowed.ravel() / max(least, len(hits))


def unmoved(angle_bins: int) -> int:
    """Number of the misplacement that is none."""
    turned = int(np.flatnonzero(turns(angle_bins) == 0)[0])
    still = int(np.flatnonzero(~_shifts().any(axis=1))[0])
    return turned * len(_shifts()) + still


@cache
def turns(angle_bins: int) -> Ints:
    """By how many angle bins a scan is turned, ascending."""
    steps = np.arange(-MOST_TURN, MOST_TURN + 1, TURN)
    return np.unique(np.rint(steps * (angle_bins / 360)).astype(np.int64))


@cache
def _shifts() -> npt.NDArray[np.float32]:
    """(shifts, 2) [mm] in a disc round no shift."""
    steps = np.arange(-FARTHEST, FARTHEST + 1, SHIFT)
    x, y = (axis.ravel() for axis in np.meshgrid(steps, steps))
    near = x * x + y * y <= FARTHEST * FARTHEST
    return np.column_stack((x[near], y[near])).astype(np.float32)


@cache
def _middles(angle_bins: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    cos, sin = cos_sin((np.arange(angle_bins, dtype=np.float64) + 0.5) * (2 * math.pi / angle_bins))
    return cos.astype(np.float32), sin.astype(np.float32)


def _moved(ranges: Ranges, hits: Ints, angle_bins: int) -> tuple[Ranges, Ints]:
    """Range [mm] and angle bin (shifts, hits) of each hit, as seen from the node, when it is shifted."""
    cos, sin = (each.take(hits) for each in _middles(angle_bins))
    shifts = _shifts()
    x, y = ranges * cos + shifts[:, :1], ranges * sin + shifts[:, 1:]
    place = np.minimum(np.sqrt(x * x + y * y), np.float32(CLEAR - 1)).astype(np.uint16)
    cell = (quarter_turns(x, y) * np.float32(angle_bins / 4)).astype(np.int64)
    return place, cell
