"""What one node and level hold to be there."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.state import State


@dataclass(frozen=True, slots=True)
class Estimate:
    """The most probable consistent virtual scan of one node and level.

    Angle bin i covers the bearings [i * d, (i + 1) * d) with d = 2 * pi / angle_bins.
    """

    node: int  # number of the node
    level: str
    stamp_ns: int  # header stamp of the newest scan that the node holds
    ranges: npt.NDArray[np.float32]  # (angle_bins,) [m]; +inf clear, NaN unknown
    support: npt.NDArray[np.float32]  # (angle_bins,) share of what is known that agrees, 0..1
    known: npt.NDArray[np.float32]  # (angle_bins,) share of the level's window that is known, 0..1
    samples: npt.NDArray[np.uint16]  # (angle_bins,) remembered ranges
    status: npt.NDArray[np.uint8]  # (angle_bins,) what it rests on, a `Status` each
    last_seen_ns: npt.NDArray[np.int64]  # (angle_bins,) stamp of the level's newest scan of it; 0 never

    @property
    def plausibility(self) -> npt.NDArray[np.float32]:
        """Share of the level's window that does not contradict the estimate (angle_bins,), 0..1."""
        return np.asarray(1 - self.known * (1 - self.support), np.float32)

    def kept(self) -> State:
        """Everything but the node and the level, for `restored`."""
        arrays = (self.ranges, self.support, self.known, self.samples, self.status, self.last_seen_ns)
        return {"stamp_ns": self.stamp_ns, **dict(zip(_ARRAYS, arrays, strict=True))}

    @classmethod
    def restored(cls, node: int, level: str, state: State) -> "Estimate":
        """The estimate that was kept."""
        return cls(node, level, state["stamp_ns"], *(state[name] for name in _ARRAYS))


_ARRAYS = ("ranges", "support", "known", "samples", "status", "last_seen_ns")
