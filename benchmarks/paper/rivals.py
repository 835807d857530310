"""What people use today, on the same virtual scans: each small, on a polar grid of the node where it is a grid.

A cell is one angle bin wide and 5 cm deep. The map of a grid, asked for a scan, shows the middle of the nearest
occupied cell in each direction.
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from benchmarks.paper.scene import ANGLE_BINS
from sample_logs.rays import Floats
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Ranges

CELL = 50  # [mm]

Bools = npt.NDArray[np.bool_]


class Rival(Protocol):
    """A map of several nodes that learns virtual scans and can be asked for one."""

    def learn(self, scans: Ranges) -> None:
        """Learn n scans (n, nodes, angle_bins) [mm]."""

    def ranges(self) -> Ranges:
        """What the map shows (nodes, angle_bins) [mm]."""


class LastScan:
    """The newest range of each angle bin."""

    def __init__(self, nodes: int) -> None:
        self._newest = np.full((nodes, ANGLE_BINS), UNSEEN, np.uint16)

    def learn(self, scans: Ranges) -> None:
        """Learn n scans (n, nodes, angle_bins) [mm]."""
        for scan in scans:
            self._newest = np.where(scan != UNSEEN, scan, self._newest)

    def ranges(self) -> Ranges:
        """What the map shows (nodes, angle_bins) [mm]."""
        return self._newest


class _Grid:
    """Cells (nodes, angle_bins, cells) out to `reach` [m], beyond which no scan shows anything."""

    def __init__(self, nodes: int, reach: float) -> None:
        self._cells = int(reach * 1000) // CELL + 1
        self._seen = np.zeros((nodes, ANGLE_BINS), np.bool_)
        self._depth = np.arange(self._cells)

    def _hit_and_passed(self, scan: Ranges) -> tuple[Bools, Bools]:
        """Which cells a scan (nodes, angle_bins) ends in, and which it goes through."""
        self._seen |= scan != UNSEEN
        end = np.where(scan == UNSEEN, -1, scan.astype(np.int64) // CELL)[..., None]
        hit = (self._depth == end) & (scan < CLEAR)[..., None]
        return hit, self._depth < end

    def _nearest(self, occupied: Bools) -> Ranges:
        middle = (occupied.argmax(axis=2) * CELL + CELL // 2).astype(np.uint16)
        found = np.where(occupied.any(axis=2), middle, CLEAR)
        return np.where(self._seen, found, UNSEEN).astype(np.uint16)


class HitsByPasses(_Grid):
    """Karto and slam_toolbox: occupied where hits by visits exceed 0.1, of cells visited more than twice."""

    def __init__(self, nodes: int, reach: float) -> None:
        super().__init__(nodes, reach)
        self._hits = np.zeros((nodes, ANGLE_BINS, self._cells), np.float32)
        self._visits = np.zeros_like(self._hits)

    def learn(self, scans: Ranges) -> None:
        """Learn n scans (n, nodes, angle_bins) [mm]."""
        for scan in scans:
            hit, passed = self._hit_and_passed(scan)
            self._hits += hit
            self._visits += hit | passed

    def ranges(self) -> Ranges:
        """What the map shows (nodes, angle_bins) [mm]."""
        return self._nearest((self._visits > 2) & (self._hits > np.float32(0.1) * self._visits))


class LogOdds(_Grid):
    """OctoMap (Hornung et al. 2013): log-odds +0.85 for a hit, -0.4 for a pass, clamped to -2 .. 3.5."""

    def __init__(self, nodes: int, reach: float) -> None:
        super().__init__(nodes, reach)
        self._odds = np.zeros((nodes, ANGLE_BINS, self._cells), np.float32)

    def learn(self, scans: Ranges) -> None:
        """Learn n scans (n, nodes, angle_bins) [mm]."""
        for scan in scans:
            hit, passed = self._hit_and_passed(scan)
            self._odds += np.float32(0.85) * hit - np.float32(0.4) * passed
            np.clip(self._odds, -2.0, 3.5, out=self._odds)

    def ranges(self) -> Ranges:
        """What the map shows (nodes, angle_bins) [mm]."""
        return self._nearest(self._odds > 0)


class MarkovChains(_Grid):
    """Independent Markov chains (Saarinen, Andreasson, Lilienthal, IROS 2012): each cell learns how often it turns.

    The rates of becoming occupied and free are counted events by counted observations of the other state, and
    carry a belief forward, which each scan corrects with likelihoods of 0.7 for a hit and 0.4 for a pass.
    """

    def __init__(self, nodes: int, reach: float) -> None:
        super().__init__(nodes, reach)
        shape = (nodes, ANGLE_BINS, self._cells)
        self._belief = np.full(shape, 0.5, np.float32)
        self._was_hit, self._observed = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
        self._events = {key: np.ones(shape, np.float32) for key in ("entry", "free", "exit", "taken")}

    def learn(self, scans: Ranges) -> None:
        """Learn n scans (n, nodes, angle_bins) [mm]."""
        for scan in scans:
            hit, passed = self._hit_and_passed(scan)
            now = hit | passed
            both = now & self._observed
            self._count(both, hit)
            entry, leave = (
                self._events[a] / self._events[b] for a, b in (("entry", "free"), ("exit", "taken"))
            )
            ahead = self._belief * (1 - np.minimum(leave, 1)) + (1 - self._belief) * np.minimum(entry, 1)
            self._belief = np.where(now, _corrected(ahead, hit), self._belief).astype(np.float32)
            self._was_hit = np.where(now, hit, self._was_hit)
            self._observed |= now

    def _count(self, both: Bools, hit: Bools) -> None:
        self._events["entry"] += both & ~self._was_hit & hit
        self._events["exit"] += both & self._was_hit & ~hit
        self._events["free"] += both & ~self._was_hit
        self._events["taken"] += both & self._was_hit

    def ranges(self) -> Ranges:
        """What the map shows (nodes, angle_bins) [mm]."""
        return self._nearest(self._observed & (self._belief > np.float32(0.5)))


def _corrected(belief: npt.NDArray[np.float32], hit: Bools) -> Floats:
    likelihood = np.where(hit, np.float32(0.7), np.float32(0.4))
    taken, free = belief * likelihood, (1 - belief) * (1 - likelihood)
    return np.asarray(taken / np.maximum(taken + free, np.float32(1e-9)))


RIVALS: dict[str, Callable[[int, float], Rival]] = {
    "last scan": lambda nodes, _: LastScan(nodes),
    "hits by passes > 0.1": HitsByPasses,
    "log-odds, clamped": LogOdds,
    "Markov chain per cell": MarkovChains,
}


def rivals(nodes: int, reach: float) -> dict[str, Rival]:
    """One of each."""
    return {name: make(nodes, reach) for name, make in RIVALS.items()}
