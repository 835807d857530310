"""Which scans a level takes: one at a random place of every 1/q (stratified), so that the half-life is exact.

A coin for each scan would cost a tenth of the half-life. The decision falls for a scan as a whole, so that
neighbouring angle bins stay together.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from timemap_cli.model import chance
from timemap_cli.model.levels import LONGEST_STEP, Level
from timemap_cli.model.state import State

Ints = npt.NDArray[np.int64]
Count = TypeVar("Count", np.int64, np.uint32)

_ONE = 1 << 32  # shares are summed as whole 2^-32, so that a sum does not depend on how scans come in blocks
_NEVER = np.iinfo(np.int64).min


@dataclass(frozen=True, slots=True)
class Groups:
    """The scans of a block, ordered by node and within a node by time."""

    order: Ints  # (n,) index of the scan in the block
    nodes: Ints  # (n,) its node, ascending
    starts: Ints  # (groups,) where a node's scans begin
    ranks: Ints  # (n,) 0 for the node's first scan in the block

    @classmethod
    def of(cls, nodes: Ints) -> "Groups":
        """Group scans of the given nodes (n,), which are in time order."""
        order = np.argsort(nodes, kind="stable")
        ordered = nodes[order]
        starts = np.flatnonzero(np.diff(ordered, prepend=-1))
        lengths = np.diff(starts, append=len(nodes))
        return cls(order, ordered, starts, np.arange(len(nodes)) - np.repeat(starts, lengths))

    @property
    def distinct(self) -> Ints:
        """The nodes, ascending."""
        return self.nodes[self.starts]

    def running_sums(
        self, values: npt.NDArray[np.bool_] | Ints, totals: npt.NDArray[Count]
    ) -> npt.NDArray[Count]:
        """Sums (n, ...) of each node's values up to and with each scan, on top of its total so far.

        `totals` (nodes, ...) is brought up to date.
        """
        sums: npt.NDArray[Count] = np.cumsum(values, axis=0, dtype=totals.dtype)
        if not len(sums):
            return sums
        base = totals[self.distinct]
        base[1:] -= sums[self.starts[1:] - 1]  # unsigned arithmetic may pass below 0 and comes back
        stops = np.append(self.starts[1:], len(sums))
        for start, stop, so_far in zip(self.starts.tolist(), stops.tolist(), base, strict=True):
            sums[start:stop] += so_far
        totals[self.distinct] = sums[stops - 1]
        return sums


class Draw:
    """The state of the draw for every node at one level."""

    def __init__(self, level: Level) -> None:
        self._level = level
        self._reached = np.zeros(0, np.int64)  # scans that reached the level
        self._all_due = np.zeros(0, np.int64)  # of what was due for them and a scan could fill [2^-32]
        self._sum = np.zeros(0, np.int64)  # of their shares [2^-32]
        self._next = np.zeros(0, np.int64)  # first turn in which no scan was taken yet
        self._stamp = np.zeros(0, np.int64)  # [ns] the newest scan that reached the level
        self._owed = np.zeros(0)  # places due for time gone by, which the next scans are to fill
        self._wanted = self._granted = 0  # shares due in all, and those of them a scan can fill [2^-32]

    @property
    def shortfall(self) -> float:
        """Share of what was due that no scan could fill, 0..1."""
        return 1 - self._granted / self._wanted if self._wanted else 0.0

    def add_nodes(self, nodes: int) -> None:
        """Make room for so many nodes in all."""
        for name, empty in (("_reached", 0), ("_all_due", 0), ("_sum", 0), ("_next", 0), ("_stamp", _NEVER)):
            array = getattr(self, name)
            setattr(self, name, np.append(array, np.full(nodes - len(array), empty, np.int64)))
        self._owed = np.append(self._owed, np.zeros(nodes - len(self._owed)))

    @property
    def _counts(self) -> tuple[Ints, ...]:
        return (self._reached, self._all_due, self._sum, self._next, self._stamp)

    def kept(self, node: int) -> State:
        """What the draw holds of a node, for `restore`."""
        counts = [int(array[node]) for array in self._counts]
        return {"draw": np.array(counts, np.int64), "owed": float(self._owed[node])}

    def restore(self, node: int, state: State) -> None:
        """Take over what another draw kept of a node."""
        for array, value in zip(self._counts, state["draw"].tolist(), strict=True):
            array[node] = value
        self._owed[node] = state["owed"]

    def kept_of_all(self) -> State:
        """What the draw holds of no node alone, for `restore_of_all`."""
        return {"wanted": self._wanted, "granted": self._granted}

    def restore_of_all(self, state: State) -> None:
        """Take over what another draw kept of no node alone."""
        self._wanted, self._granted = int(state["wanted"]), int(state["granted"])

    def taken(self, groups: Groups, stamps_ns: Ints, keys: chance.Keys) -> npt.NDArray[np.bool_]:
        """Which scans (n,) the level takes; `stamps_ns` is in the groups' order, `keys` per node."""
        share = self._shares(groups, stamps_ns)
        start = groups.running_sums(share, self._sum) - share
        turn = start >> 32
        # counters of turns count down from -1: those of scans taken go up from 1 on the same key
        pick = (turn << 32) + (chance.mixed(keys[groups.nodes], ~turn) >> np.uint64(32)).astype(np.int64)
        candidate = start + share > pick
        # the first candidate of each turn is taken; within a turn, what follows a candidate is one too
        first = groups.ranks == 0
        again = np.zeros(len(turn), np.bool_)
        again[1:] = candidate[:-1] & (turn[1:] == turn[:-1])
        again[first] = self._next[groups.distinct] > turn[first]
        taken = candidate & ~again
        np.maximum.at(self._next, groups.nodes[taken], turn[taken] + 1)
        return np.asarray(taken)

    def _shares(self, groups: Groups, stamps_ns: Ints) -> Ints:
        """Share of a turn that each scan fills [2^-32]: while the memory is young as much as any other before it.

        Else four scans would decide a memory of a hundred places. It is young until all that was due has
        filled a window: in time a scan's own due says little, for it may be a hundredth of the next one's.
        """
        reached = groups.running_sums(np.ones(len(stamps_ns), np.int64), self._reached)
        due = self._due(groups, stamps_ns)
        granted = self._granted_to(groups, due)
        filled = np.asarray(np.rint(granted * _ONE), np.int64)
        all_due = groups.running_sums(filled, self._all_due)
        self._wanted += int(np.rint(due * _ONE).astype(np.int64).sum())
        self._granted += int(filled.sum())
        window = self._level.window
        young = (reached <= window) | (all_due < window * _ONE)
        return np.asarray(
            np.rint(np.where(young, np.minimum(1.0, window / reached), granted) * _ONE), np.int64
        )

    def _granted_to(self, groups: Groups, due: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """What each scan fills of what is due, at most 1; it leaves the rest, of one longest step at most, to the next.

        A robot that passes by stands for 10 s with its first scan, which one scan cannot fill.
        """
        granted = np.minimum(due, 1.0)
        if not self._level.in_seconds:
            return granted
        most = self._level.places_replaced(LONGEST_STEP)
        before, owed = -1, 0.0
        for i, (node, places) in enumerate(zip(groups.nodes.tolist(), due.tolist(), strict=True)):
            if node != before:
                before, owed = node, float(self._owed[node])
            owed = min(owed + places, most)
            granted[i] = min(owed, 1.0)
            owed -= float(granted[i])
            self._owed[node] = owed
        return granted

    def _due(self, groups: Groups, stamps_ns: Ints) -> npt.NDArray[np.float64]:
        """Places of the window that each scan should replace; above 1 where it stands for too long a time."""
        if not self._level.in_seconds:
            return np.full(len(stamps_ns), self._level.places_replaced(1.0))
        before = np.roll(stamps_ns, 1)
        first = groups.ranks == 0
        before[first] = self._stamp[groups.distinct]
        self._stamp[groups.nodes] = stamps_ns
        steps = [
            min(max(now - then, 0) * 1e-9, LONGEST_STEP) if then != _NEVER else 0.0
            for now, then in zip(stamps_ns.tolist(), before.tolist(), strict=True)
        ]
        return np.array([self._level.places_replaced(step) for step in steps])
