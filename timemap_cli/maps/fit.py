"""How well points fit a surface, and what the place leaves open."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.maps.grid import Floats
from timemap_cli.maps.surface import Scales, Surface
from timemap_cli.model.elementary import bearings, cos_sin, lengths

_INLIER_M = 0.1
_BETWEEN_POINTS_M = 0.15  # along a line: a node sees a wall from afar as points so far apart
_SLID_M = 0.3
_MIN_LOST = 0.03  # share of the inliers that no longer fit when slid along a direction that the place fixes

_Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Fit:
    """Which of some points can be compared with a surface, and which fit it."""

    near: _Bools  # (n,) within a metre of the surface
    inlier: _Bools  # (n,) within 0.1 m of it

    @classmethod
    def of(cls, points: Floats, surface: Scales) -> "Fit":
        """The fit of points (n, 2) [m]."""
        near = np.zeros(len(points), np.bool_)
        near[surface.wide.nearest(points).which] = True
        inlier = inliers(points, surface.fine)
        return cls(near | inlier, inlier)

    @property
    def compared(self) -> int:
        """How many points can be compared."""
        return int(self.near.sum())

    @property
    def share(self) -> float:
        """How many of those fit, 0..1; none where there are none.

        A share and no number: whoever slides along a wall into what the other side has seen of it fits in more
        points, and no better.
        """
        return round(int(self.inlier.sum()) / max(self.compared, 1), 4)


def inliers(points: Floats, surface: Surface) -> _Bools:
    """Which points (n, 2) [m] lie within 0.1 m of the surface, or of the line through its nearest points."""
    pairs = surface.nearest(points)
    beside, apart = (np.rint(lengths(gap) * 1e4) for gap in (pairs.across, pairs.gaps))
    found = np.zeros(len(points), np.bool_)
    found[pairs.which] = (beside <= _INLIER_M * 1e4) & (apart <= _BETWEEN_POINTS_M * 1e4)
    return found


def weakest_direction(points: Floats, surface: Surface) -> tuple[float, float] | None:
    """Unit vector, x >= 0, along which the fit of the points (n, 2) [m] says least; None where nothing fits.

    It is the eigenvector of the lesser eigenvalue of the normal matrix of the shift.
    """
    fitting = surface.nearest(points[inliers(points, surface)])
    if not len(fitting.which):
        return None
    xx, xy, yy = fitting.metric.sum(axis=0)
    across = bearings(np.array((xx - yy) / 2), np.array(xy)) / 2
    y, x = (round(float(one), 3) for one in cos_sin(across))
    return (x, -y) if (x, -y) > (0.0, -1.0) else (-x, y)


def is_undetermined(points: Floats, surface: Surface, along: tuple[float, float]) -> bool:
    """Whether the points (n, 2) [m] that fit also fit when slid along a direction.

    The eigenvalue itself does not tell a short wall across a long corridor from the noise of the normals.
    """
    fitting = points[inliers(points, surface)]
    still = [int(inliers(fitting + way * np.array(along), surface).sum()) for way in (-_SLID_M, _SLID_M)]
    return max(still) > (1 - _MIN_LOST) * len(fitting)
