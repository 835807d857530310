"""In how much of the circle a virtual scan contradicts another one, or an estimate."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Ranges

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

MIN_STEP = 200  # [mm] what differs by less does not contradict: poses off by 0.15 m must not show ...
MIN_STEP_SHARE = 0.03  # ... nor by a smaller share of the range: a heading error at a slanted wall
CLEAR_MARGIN = 2  # in steps: a surface so close to the radius may be clear at the next look
MIN_VIEW = 60 / 360  # of the circle: where both know less nothing is decided
MIN_SUPPORT = 0.5  # of a firm range

ANYTHING = 65535  # width of bounds that say nothing


@dataclass(frozen=True, slots=True)
class Bounds:
    """The ranges that do not contradict, low .. low + width [mm], of each angle bin (rows, angle_bins)."""

    low: Ranges
    width: Ranges

    @classmethod
    def around(cls, ranges: Ranges, reach: int) -> "Bounds":
        """Bounds around virtual scans (rows, angle_bins) of nodes that look as far as `reach` [mm]."""
        at = np.minimum(ranges, reach).astype(np.int64)
        step = np.maximum(MIN_STEP, np.rint(at * MIN_STEP_SHARE).astype(np.int64))
        rim = reach - CLEAR_MARGIN * step
        low = np.maximum(0, np.where(ranges == CLEAR, rim, at - step))
        high = np.where(at > rim, CLEAR, at + step)
        unknown = ranges == UNSEEN
        low[unknown], high[unknown] = 0, ANYTHING
        return cls(low.astype(np.uint16), (high - low).astype(np.uint16))

    @classmethod
    def open(cls, rows: int, angle_bins: int) -> "Bounds":
        """Bounds that nothing contradicts."""
        shape = (rows, angle_bins)
        return cls(np.zeros(shape, np.uint16), np.full(shape, ANYTHING, np.uint16))

    def __len__(self) -> int:
        return len(self.low)

    def rows(self, rows: Ints) -> "Bounds":
        """Copy of these rows."""
        return Bounds(self.low[rows], self.width[rows])

    def say_something(self, row: int) -> bool:
        """Whether a virtual scan can contradict this row."""
        return bool((self.width[row] != ANYTHING).any())

    def with_rows(self, rows: Ints, other: "Bounds") -> "Bounds":
        """These bounds with others in the place of some rows; changes them, and makes room for new rows."""
        low, width = self.low, self.width
        if (missing := int(rows.max(initial=-1)) + 1 - len(self)) > 0:
            more = Bounds.open(missing + len(self) // 2, low.shape[1])
            low, width = np.concatenate((low, more.low)), np.concatenate((width, more.width))
        low[rows], width[rows] = other.low, other.width
        return Bounds(low, width)

    def contradiction(self, ranges: Ranges) -> Floats:
        """Share (rows,) of the angle bins known on both sides in which virtual scans lie outside, row by row.

        NaN where both know less than MIN_VIEW of the circle.
        """
        both = ranges != UNSEEN
        outside = ranges - self.low > self.width  # whole numbers wrap: what lies below is far above
        outside &= both
        both &= self.width != ANYTHING
        known = both.sum(axis=1)
        share = outside.sum(axis=1) / np.maximum(1, known)
        share[known < ranges.shape[1] * MIN_VIEW] = np.nan
        return np.asarray(share, np.float64)


def firm_ranges(estimates: Sequence[Estimate], min_samples: int) -> Ranges:
    """Ranges (estimates, angle_bins) [mm] or CLEAR, and UNSEEN where the estimate has too little behind it."""
    metres = np.stack([found.ranges for found in estimates])
    support = np.stack([found.support for found in estimates])
    samples = np.stack([found.samples for found in estimates])
    firm = (samples >= min_samples) & (support >= MIN_SUPPORT) & ~np.isnan(metres)
    finite = np.isfinite(metres)
    ranges = np.full(metres.shape, CLEAR, np.uint16)
    ranges[finite] = np.rint(metres[finite] * 1000)
    ranges[~firm] = UNSEEN
    return ranges
