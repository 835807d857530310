"""Whether the robot is lost or the world has changed, by what its scans at the last nodes say together.

One scan cannot tell: where all pallets of an aisle were moved, nothing fits. But a lost robot is lost at every node
that it passes, and what it sees there fits elsewhere, everywhere by the same misplacement. Where the world has
changed, the nodes around do not fit any better elsewhere.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.contradiction import Bounds
from timemap_cli.model.misplaced import fits, unmoved
from timemap_cli.model.state import State
from timemap_cli.model.virtual_scan import Ranges

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

NODES = 12  # that are remembered ...
WITNESSES = 5  # ... and so many of them asked whether they fit elsewhere
OWN = 2  # ... while the scan itself counts for so many
EVERYWHERE = (
    0.07  # by so much more than sets aside must contradict at all nodes, with half of what fits elsewhere
)
USUAL, USUAL_NODES = 0.3, 2  # what is taken to contradict at so many nodes before the first
LONGEST_PAUSE_NS = 600_000_000_000  # after it the robot may be anywhere


@dataclass(slots=True)
class _Visit:
    """What a node's scans have said since the robot came to it."""

    node: int
    ranges: Ranges  # (angle_bins,) [mm] its first scan
    contradicting: float = 0.0  # sum of the scans' shares
    scans: int = 0

    @property
    def share(self) -> float:
        return self.contradicting / self.scans


class Whereabouts:
    """Follows one robot from node to node."""

    def __init__(self, max_contradiction: float, angle_bins: int) -> None:
        self._max = max_contradiction
        self._angle_bins = angle_bins
        self._visits: list[_Visit] = []  # the newest last
        self._newest_ns: int | None = None
        self._fits: dict[int, Floats] = {}  # of visits, by node; made again at need

    def come_to(self, stamp_ns: int) -> None:
        """Take note of the time of a scan; after a long pause, or when the clock begins anew, nothing is known."""
        if self._newest_ns is not None and not 0 <= stamp_ns - self._newest_ns <= LONGEST_PAUSE_NS:
            self._visits.clear()
            self._fits.clear()
        self._newest_ns = stamp_ns

    def see(self, node: int, ranges: Ranges, share: float) -> None:
        """Take note of a scan (angle_bins,) of a node, of which that share contradicts."""
        if not self._visits or self._visits[-1].node != node:
            self._fits.pop(node, None)
            self._visits = [visit for visit in self._visits if visit.node != node][1 - NODES :]
            self._visits.append(_Visit(node, ranges.copy()))
        visit = self._visits[-1]
        visit.contradicting += share
        visit.scans += 1

    def forget(self, nodes: set[int]) -> None:
        """What these nodes hold has changed."""
        for node in nodes & self._fits.keys():
            del self._fits[node]

    def are_wrong(self, ranges: Ranges, expected: Bounds) -> bool:
        """Whether the newest scan (angle_bins,), which contradicts its node, is that of a lost robot.

        `expected` holds the bounds of all nodes, a row for each.
        """
        here, *others = self._visits[::-1]
        found = fits(ranges, expected.rows(np.array([here.node])))
        none = unmoved(self._angle_bins)
        usual = USUAL * USUAL_NODES + sum(visit.share for visit in self._visits)
        contradicting = usual / (USUAL_NODES + len(self._visits))
        if contradicting + found.max() / 2 >= self._max + EVERYWHERE:
            return True
        gain = OWN * (found - found[none])
        for visit in others[:WITNESSES]:
            there = self._fits_of(visit, expected)
            gain += there - there[none]
        return bool(gain.max() >= self._max)

    def kept(self) -> State:
        """What is remembered, for `restore`."""
        ranges = np.array([visit.ranges for visit in self._visits], np.uint16)
        return {
            "newest_ns": self._newest_ns,
            "nodes": np.array([visit.node for visit in self._visits], np.int64),
            "ranges": ranges.reshape(len(self._visits), self._angle_bins),
            "contradicting": np.array([visit.contradicting for visit in self._visits], np.float64),
            "scans": np.array([visit.scans for visit in self._visits], np.int64),
        }

    def restore(self, state: State) -> None:
        """Take over what another one kept."""
        self._newest_ns = state["newest_ns"]
        numbers = (state[name].tolist() for name in ("nodes", "contradicting", "scans"))
        self._visits = [
            _Visit(node, ranges, contradicting, scans)
            for ranges, node, contradicting, scans in zip(state["ranges"], *numbers, strict=True)
        ]

    def _fits_of(self, visit: _Visit, expected: Bounds) -> Floats:
        if visit.node not in self._fits:
            self._fits[visit.node] = fits(visit.ranges, expected.rows(np.array([visit.node])))
        return self._fits[visit.node]
