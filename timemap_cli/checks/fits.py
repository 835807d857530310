"""By how much each node's surfaces are shifted and turned as a whole."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.surfaces import Offsets

Floats = npt.NDArray[np.float64]

_NEAR_M = 0.3  # ends farther off their surface are of something that moved, and say nothing of the whole
_SCALE_M = 0.02  # an offset of this size counts half: noise of scanner and poses
_LEAST_ENDS = 20
_ROUNDS = 4
_FIRM = 1e-6  # keeps directions that nothing shows (along a corridor) at zero


@dataclass(frozen=True, slots=True)
class Fits:
    """The rigid motion of each node's surfaces about the node's centre; NaN where too little is seen."""

    x: Floats  # (nodes,) [m] map frame
    y: Floats  # (nodes,) [m]
    turn: Floats  # (nodes,) [rad] counter-clockwise

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """(nodes,) whether a motion could be told."""
        return ~np.isnan(self.x)


def fitted(x: Floats, y: Floats, off: Offsets) -> Fits:
    """The motion that explains the offsets of ends `x`, `y` (nodes, angle_bins) [m, from their node] best.

    Only offsets across a surface count, and great ones less and less (weights of a Cauchy distribution).
    """
    use = (off.distance < _NEAR_M) & (np.hypot(off.normal_x, off.normal_y) > 0)
    normal_x, normal_y = (np.where(use, part, 0.0) for part in (off.normal_x, off.normal_y))
    seen_x, seen_y = np.where(use, x, 0.0), np.where(use, y, 0.0)
    across = normal_x * np.where(use, off.x, 0.0) + normal_y * np.where(use, off.y, 0.0)
    columns = np.stack([normal_x, normal_y, normal_y * seen_x - normal_x * seen_y], axis=-1)
    motion = np.zeros((len(x), 3))
    for _ in range(_ROUNDS):
        rest = across - np.einsum("nbk,nk->nb", columns, motion)
        weighted = columns * (use / (1 + (rest / _SCALE_M) ** 2))[..., None]
        squares = np.einsum("nbi,nbj->nij", weighted, columns) + _FIRM * np.eye(3)
        sums = np.einsum("nbi,nb->ni", weighted, across)
        motion = np.linalg.solve(squares, sums[..., None])[..., 0]
    motion[use.sum(axis=1) < _LEAST_ENDS] = np.nan
    return Fits(motion[:, 0], motion[:, 1], motion[:, 2])
