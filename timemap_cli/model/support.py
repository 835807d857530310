"""How much of what is known of an angle bin agrees with the range shown; docs/method.md, 4.4, has the reasons."""

import numpy as np
import numpy.typing as npt

from timemap_cli.model.contradiction import Bounds
from timemap_cli.model.memory import Remembered
from timemap_cli.model.virtual_scan import CLEAR, Ranges
from timemap_cli.model.vote import Shares

_FARTHEST = CLEAR - 1  # [mm] no node looks so far that a range lies near it: clear agrees with clear alone


def support(memory: Remembered, share: Shares, shown: Ranges) -> npt.NDArray[np.float64]:
    """Share 0..1 of what is known of each angle bin (m * angle_bins,) that does not contradict the range shown there.

    `shown` is (m * angle_bins,) [mm] or a code. What contradicts is a matter of distance (`Bounds`), not of states: a
    surface whose ranges spread over several of them agrees with itself. 0 where nothing is known.
    """
    bounds = Bounds.around(shown, _FARTHEST)
    samples = memory.samples.reshape(share.weights.shape)
    agrees = samples - bounds.low[:, None] <= bounds.width[:, None]  # whole numbers wrap
    agreeing = (share.weights * agrees).sum(axis=1, dtype=np.int64)
    return np.asarray(agreeing / np.maximum(1, share.weights.sum(axis=1, dtype=np.int64)))
