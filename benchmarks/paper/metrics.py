"""What is measured of estimates: against two true scans, before and after a change."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from benchmarks.paper.scene import RADIUS, rays
from sample_logs.rays import Floats

Bools = npt.NDArray[np.bool_]

STEP = 0.1  # [m] two ranges farther apart than this differ
_EVEN = 0.15  # [m] rays of one angle bin that lie within this are one surface
_WORST = 1.0  # [m] what an error counts at most, also that of clear against a surface


@dataclass(frozen=True, slots=True)
class Change:
    """A world before and after, as seen from the node; angle bins that straddle an edge are in neither set."""

    old: Floats  # (angle_bins,) [m], inf clear
    new: Floats
    even: Bools  # (angle_bins,) both times one surface
    changed: Bools  # (angle_bins,) even, and different

    @classmethod
    def between(cls, old_segments: Floats, new_segments: Floats) -> "Change":
        """What changes at the node between two worlds (m, 4)."""
        old, new = rays(old_segments), rays(new_segments)
        even = _even(old) & _even(new)
        nearest = old.min(axis=1), new.min(axis=1)
        return cls(*nearest, even, even & (apart(*nearest) > STEP))


def _even(found: Floats) -> Bools:
    depth = np.minimum(found, 2 * RADIUS)
    return np.asarray(depth.max(axis=1) - depth.min(axis=1) <= _EVEN)


def apart(a: Floats, b: Floats) -> Floats:
    """Distance of two arrays of ranges [m]; clear is far behind every surface, NaN stays NaN."""
    return np.asarray(np.abs(np.minimum(a, 2 * RADIUS) - np.minimum(b, 2 * RADIUS)))


def shows_new(estimates: Floats, change: Change) -> Bools:
    """Which angle bins (..., angle_bins) are nearer to the new world than to the old."""
    return np.asarray(apart(estimates, change.new) < apart(estimates, change.old))


def delay(estimates: Floats, change: Change, every: int) -> Floats:
    """Scans (nodes,) until 90 % of the changed angle bins show the new state; NaN never.

    `estimates` (k, nodes, angle_bins) begin `every` scans after the change.
    """
    share = shows_new(estimates, change)[..., change.changed].mean(axis=2)
    done = share >= 0.9
    return np.where(done.any(axis=0), (done.argmax(axis=0) + 1.0) * every, np.nan)


def half_and_half(estimates: Floats, change: Change) -> Bools:
    """Which estimates (...,) show a run of changed angle bins more than 10 % old and more than 10 % new."""
    new = shows_new(estimates, change)
    mixed = np.zeros(new.shape[:-1], np.bool_)
    for run in runs(change.changed):
        share = new[..., run].mean(axis=-1)
        mixed |= (share > 0.1) & (share < 0.9)
    return mixed


def runs(chosen: Bools) -> list[npt.NDArray[np.int64]]:
    """Runs of neighbouring chosen angle bins, round the circle."""
    places = np.flatnonzero(chosen)
    if not len(places):
        return []
    steps = np.diff(places, append=places[0] + len(chosen))
    ends = np.flatnonzero(steps > 1)
    if not len(ends):
        return [places]
    turned = np.roll(places, -(ends[-1] + 1))
    return np.split(turned, np.cumsum(np.diff(ends, prepend=ends[-1] - len(places)))[:-1])


def error(estimates: Floats, true: Floats, where: Bools) -> Floats:
    """Mean error [m] (...,) over the chosen angle bins that are known, each at most a metre."""
    return np.asarray(np.nanmean(np.minimum(apart(estimates, true), _WORST)[..., where], axis=-1))


def flicker(estimates: Floats, where: Bools) -> float:
    """Share of the steps from estimate to estimate in which a chosen angle bin jumps; 0..1."""
    steps = apart(estimates[1:], estimates[:-1])[..., where]
    return float((steps > STEP).mean())


def overlap(found: Bools, true: Bools) -> Floats:
    """Intersection by union (...,) of two sets of angle bins; 1 where both are empty."""
    both, either = (found & true).sum(axis=-1), (found | true).sum(axis=-1)
    return np.asarray(np.where(either, both / np.maximum(either, 1), 1.0))
