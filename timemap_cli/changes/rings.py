"""The estimates of both sides, stacked over the nodes that can be compared."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.rules import Rules
from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Rings:
    """One side's estimates, a row per compared node."""

    ranges: Floats  # (rows, angle_bins) [m]; +inf clear, NaN unknown
    support: Floats  # (rows, angle_bins) share of what is known that agrees, 0..1
    samples: Ints  # (rows, angle_bins) remembered ranges
    last_seen_ns: Ints  # (rows, angle_bins) [ns] newest scan that looked there
    stamps_ns: Ints  # (rows,) newest scan of each row

    def firm(self, rules: Rules, min_samples: int) -> Bools:
        """Angle bins known well enough to be compared, (rows, angle_bins)."""
        return ~np.isnan(self.ranges) & (self.support >= rules.min_support) & (self.samples >= min_samples)


@dataclass(frozen=True, slots=True)
class Places:
    """The compared nodes and the geometry that all their rings share."""

    numbers: Ints  # (rows,) number of each row's node, ascending
    centres: Floats  # (rows, 2) [m] map frame
    angle_bins: int
    radius: float  # [m] how far a node sees

    @property
    def bin_rad(self) -> float:
        """Width of an angle bin [rad]."""
        return 2 * np.pi / self.angle_bins

    def points(self, rows: int | Ints, bins: Ints, ranges: Floats) -> Floats:
        """Ends of ranges (n,) [m] at the centres of angle bins (n,) of one row or of one each, (n, 2) [m] map frame."""
        return np.asarray(self.centres[rows] + ranges[:, None] * _directions(self.angle_bins)[bins])

    def edge_bins(self, rules: Rules) -> int:
        """How many bins to either side an edge may shift; at least one."""
        return max(1, int(np.radians(rules.edge_deg) / self.bin_rad + 1e-9))


@lru_cache(maxsize=8)
def _directions(angle_bins: int) -> Floats:
    """Unit vectors (angle_bins, 2) to the centre of each angle bin."""
    return np.stack(cos_sin(np.arange(0.5, angle_bins) * (2 * np.pi / angle_bins)), axis=1)


def place(nodes: Sequence[Node], numbers: Sequence[int], angle_bins: int, radius: float) -> Places:
    """The nodes of the given numbers."""
    centres = np.array([(nodes[n].x, nodes[n].y) for n in numbers], dtype=np.float64)
    return Places(np.array(numbers, dtype=np.int64), centres.reshape(-1, 2), angle_bins, radius)


def stack(side: Mapping[int, Estimate], numbers: Sequence[int]) -> Rings:
    """One side's estimates of the given nodes.

    Raises ValueError where they differ in their number of angle bins.
    """
    estimates = [side[n] for n in numbers]
    return Rings(
        ranges=np.array([e.ranges for e in estimates], dtype=np.float64),
        support=np.array([e.support for e in estimates], dtype=np.float64),
        samples=np.array([e.samples for e in estimates], dtype=np.int64),
        last_seen_ns=np.array([e.last_seen_ns for e in estimates], dtype=np.int64),
        stamps_ns=np.array([e.stamp_ns for e in estimates], dtype=np.int64),
    )
