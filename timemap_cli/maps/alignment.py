"""Whether what two drives have seen lies in one frame: the offset between two sets of surface points.

A world that has changed and a map that is shifted contradict each other in as many places. They differ in what
an alignment gains: a shifted map fits again as a whole, a changed world fits nowhere better than where it is.
"""

from dataclasses import dataclass

import numpy as np

from timemap_cli.maps.fit import Fit, is_undetermined, weakest_direction
from timemap_cli.maps.grid import Floats, sample, thinned
from timemap_cli.maps.offset import Offset
from timemap_cli.maps.search import best_offset
from timemap_cli.maps.surface import FINE_M, Scales

_MAX_POINTS = 3000

_MIN_GAIN = 0.10
_MIN_FIT = 0.5  # two rooms that have nothing in common fit better somewhere, too, but nowhere by half
_MIN_COMPARED = 100  # points, 5 m of surface
_MAX_LEFT_BEHIND = 0.05  # of what fitted where it was, beyond what the rest leaves, too


@dataclass(frozen=True, slots=True)
class Alignment:
    """The offset that takes points onto a surface, and how well they fit before and after.

    Shares are of the points that can be compared: those within 1 m of the surface, before or after. What lies
    farther away the other side has not seen.
    """

    offset: Offset  # turn about the origin of the frame, then shift
    shift: tuple[float, float]  # [m] what the offset does to the middle of the points
    inliers_before: float  # share of the points within 0.1 m of the surface where they are
    inliers_after: float  # the same after the offset
    left_behind: float  # share of the points that were inliers before and are none after
    compared: int  # points that can be compared before and after, at most 3000, one per cell of 5 cm
    undetermined: tuple[float, float] | None  # unit vector, x >= 0, along which the place fixes no offset

    @property
    def gain(self) -> float:
        """How much larger the share of inliers is after than before."""
        return round(self.inliers_after - self.inliers_before, 4)

    @property
    def shifted(self) -> bool:
        """Whether the points lie in a frame that is shifted against the surface's, not in a world that changed."""
        by_chance = self.inliers_before * (1 - self.inliers_after)
        return (
            self.compared >= _MIN_COMPARED
            and self.gain >= _MIN_GAIN
            and self.inliers_after >= _MIN_FIT
            and round(self.left_behind - by_chance, 4) <= _MAX_LEFT_BEHIND
        )


def align(points: Floats, surface: Floats) -> Alignment:
    """How points (n, 2) [m] of one result lie to the surface points (m, 2) [m] of another.

    Found from within 0.5 m and 5 degrees at least, turned about the middle of the points or about the origin.
    What is not finite or more than 1e7 m away is left out. The order of points does not matter.
    """
    thin, other = thinned(points, FINE_M), thinned(surface, FINE_M)
    if not len(thin) or not len(other):
        return Alignment(Offset(), (0.0, 0.0), 0.0, 0.0, 0.0, 0, None)
    middle = np.rint(thin.mean(axis=0))
    local, scales = sample(thin, _MAX_POINTS, FINE_M) - middle, Scales.of(other - middle)
    pivots = [(0.0, 0.0), (float(-middle[0]), float(-middle[1]))]
    found = best_offset(local, scales, pivots)
    loose = weakest_direction(found.moved(local), scales.fine)
    if loose is not None and is_undetermined(found.moved(local), scales.fine, loose):
        found = _across(loose, found)
    else:
        loose = None
    fits = Fit.of(local, scales), Fit.of(found.moved(local), scales)
    return _alignment(found.about(float(middle[0]), float(middle[1])), (found.dx, found.dy), *fits, loose)


def _across(loose: tuple[float, float], offset: Offset) -> Offset:
    """The offset without what of its shift is along a direction that the place does not fix."""
    x, y = loose
    along = offset.dx * x + offset.dy * y
    return Offset(offset.dx - along * x, offset.dy - along * y, offset.yaw).rounded()


def _alignment(
    offset: Offset, shift: tuple[float, float], before: Fit, after: Fit, loose: tuple[float, float] | None
) -> Alignment:
    """The offset with its shares."""
    left = int((before.inlier & ~after.inlier).sum()) / max(before.compared, 1)
    return Alignment(
        offset.rounded(),
        shift,
        before.share,
        after.share,
        round(left, 4),
        min(before.compared, after.compared),
        loose,
    )
