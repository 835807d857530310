"""A block of laser scans with their poses: what the model takes in."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class Sweeps:
    """Consecutive scans of one scanner, in stamp order, placed in the map.

    `ranges` are resolved: a finite number is a hit, `+inf` a missing return (REP 117), NaN no evidence.
    The laser turns and moves between its first and its last beam; the pose at both is given, and
    both are equal where the recording holds no time per beam. Points of the laser's plane have z = 0 in
    the laser frame; a tilted or upside-down mount is in the transforms.
    """

    stamps_ns: npt.NDArray[np.int64]  # (n,) header stamps, ascending
    ranges: npt.NDArray[np.float32]  # (n, beams) [m]
    bearings: npt.NDArray[np.float64]  # (beams,) [rad] in the laser frame, ascending or descending
    clear_range: float  # [m] how far a missing return frees space
    map_from_laser_first: npt.NDArray[np.float64]  # (n, 3, 4) at the first beam
    map_from_laser_last: npt.NDArray[np.float64]  # (n, 3, 4) at the last beam
    scanner: int = 0  # which scanner, where the robot has several

    def __len__(self) -> int:
        return len(self.stamps_ns)

    def rows(self, rows: slice | npt.NDArray[np.int64]) -> "Sweeps":
        """These scans alone."""
        return Sweeps(
            self.stamps_ns[rows],
            self.ranges[rows],
            self.bearings,
            self.clear_range,
            self.map_from_laser_first[rows],
            self.map_from_laser_last[rows],
            self.scanner,
        )
