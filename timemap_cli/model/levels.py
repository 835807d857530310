"""How fast a level forgets (paper, sec. 3), and what a half-life means."""

import math
from dataclasses import dataclass

import numpy as np

from timemap_cli.model.elementary import logarithms

LONGEST_STEP = 10.0  # [s] of observed time between two scans: a week's absence does not wipe the memory


@dataclass(frozen=True, slots=True)
class Level:
    """One time scale of memory: a window of samples, and the half-life after which half of it is replaced.

    The half-life counts scans of the node that reached the level, or seconds in which the node was observed.
    Each scan that is taken replaces one of N samples, so n of them leave the share (1 - 1/N)^n of what was there.
    A level that takes one scan of every 1/q keeps its half-life with q = (ln 2 / half-life) / -ln(1 - 1/N).
    A window of one sample with a half-life of one scan or less takes every scan: it is the last observation as it is.
    """

    name: str
    window: int  # samples per angle bin
    half_life: float  # [scans] or [s]
    in_seconds: bool = False

    def places_replaced(self, step: float) -> float:
        """Places of the window to be replaced for `step` scans or seconds.

        Up to 1 it is the probability with which a scan is taken; above, how many scans must be: each replaces
        1 / N of what the one before it left.
        """
        forgotten = math.log(2) / self.half_life * step
        if self.window == 1:
            if not self.in_seconds and self.half_life <= 1:
                return step
            return -math.expm1(-forgotten)
        return forgotten / -float(logarithms(np.array(1 - 1 / self.window)))
