"""How far the ends of one ring lie from the surfaces of another."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

_REACH_DEG = 20.0  # a surface is looked for so far to both sides of an end
_TIE_M = 1e-6
_JOINED_M = 0.3  # ends of neighbouring angle bins this near are one surface,
_JOINED_SHARE = 0.1  # or within this share of their range: walls are met at flat angles


@dataclass(frozen=True, slots=True)
class Offsets:
    """Of every end, where the nearest surface of the other ring is; NaN where there is no end."""

    x: Floats  # (rows, angle_bins) [m] from the nearest place of the other's surface to the end
    y: Floats  # (rows, angle_bins) [m]
    normal_x: Floats  # (rows, angle_bins) unit vector across that surface; 0, 0 at a lone end
    normal_y: Floats  # (rows, angle_bins)

    @property
    def distance(self) -> Floats:
        """(rows, angle_bins) [m]; +inf where the other ring has no surface near this bearing."""
        return np.asarray(np.hypot(self.x, self.y))


def ends(ranges: Floats) -> tuple[Floats, Floats]:
    """X and y (rows, angle_bins) [m] of the ends of ranges [m], from their node; NaN where there is none."""
    bins = ranges.shape[1]
    bearings = (np.arange(bins) + 0.5) * (2 * np.pi / bins)
    finite = np.where(np.isfinite(ranges), ranges, np.nan)
    return finite * np.cos(bearings), finite * np.sin(bearings)


def offsets(ranges: Floats, other: Floats, apart: Floats) -> Offsets:
    """Of each end of `ranges` (rows, angle_bins) [m] from the surfaces of `other`.

    `apart` (rows, 2) [m] leads from each node to the other's, which stands at nearly the same place.
    """
    x, y = ends(ranges)
    other_x, other_y = ends(other)
    other_x, other_y = other_x + apart[:, :1], other_y + apart[:, 1:]
    best = np.full(ranges.shape, np.inf)
    none = np.where(np.isfinite(ranges), np.inf, np.nan)
    found = [none, np.zeros_like(best), np.zeros_like(best), np.zeros_like(best)]
    reach = max(1, round(_REACH_DEG * ranges.shape[1] / 360))
    joined = _joined(other, other_x, other_y)
    for step in sorted(range(-reach, reach + 1), key=abs):
        start_x, start_y, is_joined = (np.roll(a, -step, axis=1) for a in (other_x, other_y, joined))
        along_x = np.where(is_joined, np.roll(other_x, -step - 1, axis=1) - start_x, 0.0)
        along_y = np.where(is_joined, np.roll(other_y, -step - 1, axis=1) - start_y, 0.0)
        length2 = along_x**2 + along_y**2
        far = length2 > 0
        share = np.divide(
            (x - start_x) * along_x + (y - start_y) * along_y, length2, out=np.zeros_like(best), where=far
        ).clip(0.0, 1.0)
        dx, dy = x - start_x - share * along_x, y - start_y - share * along_y
        distance = np.hypot(dx, dy)
        nearer = distance < best  # False for NaN
        best[nearer] = distance[nearer]
        length = np.sqrt(np.where(far, length2, 1.0))
        for target, value in zip(found, (dx, dy, -along_y / length, along_x / length), strict=True):
            target[nearer] = value[nearer]
    return Offsets(*found)


def farther(distance: Floats, step_m: float) -> Bools:
    """Whether distances are more than a step, which ranges of whole centimetres often are to the last bit.

    The last bit is another one with another processor, and must not decide.
    """
    return np.asarray(distance > step_m + _TIE_M)


def _joined(ranges: Floats, x: Floats, y: Floats) -> Bools:
    """Whether the end of each angle bin and that of the next one are of one surface."""
    apart = np.hypot(np.roll(x, -1, axis=1) - x, np.roll(y, -1, axis=1) - y)
    nearer = np.minimum(ranges, np.roll(ranges, -1, axis=1))
    return np.asarray(apart <= np.maximum(_JOINED_M, _JOINED_SHARE * nearer) + _TIE_M)
