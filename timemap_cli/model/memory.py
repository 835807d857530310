"""One level's memory of all nodes: bounded random samples of ranges, and of which ranges stood side by side.

Reading of the paper (sec. 3 and 4): samples and pairs are two bounded sets per angle bin. Once a set is full, a new
sample replaces a random sample, a new pair a random pair, and nothing else evicts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model import chance
from timemap_cli.model.draw import Draw, Groups
from timemap_cli.model.levels import Level
from timemap_cli.model.nodes import Node
from timemap_cli.model.state import State
from timemap_cli.model.virtual_scan import UNSEEN, Bools, Ranges

Ints = npt.NDArray[np.int64]
Counts = npt.NDArray[np.uint32]

_SPARE_ROWS = 8  # room made at a time


@dataclass(frozen=True, slots=True)
class Remembered:
    """The memory of m nodes as the estimate reads it: as deep as the fullest angle bin; empty places are UNSEEN."""

    samples: Ranges  # (m, angle_bins, most samples) [mm]
    ages: Counts  # (m, angle_bins, most samples) scans taken since by a full level that evicted nothing there
    left: Ranges  # (m, angle_bins, most pairs) [mm] a pair's range in this angle bin ...
    right: Ranges  # (m, angle_bins, most pairs) [mm] ... and in the next
    n_samples: Ints  # (m, angle_bins)
    n_pairs: Ints  # (m, angle_bins)
    last_seen_ns: (
        Ints  # (m, angle_bins) header stamp of the newest scan taken that saw the angle bin; 0: none
    )
    taken: Ints  # (m,) scans that the memory took
    stamps_ns: Ints  # (m,) header stamp of the newest of them
    window: int


class Memory:
    """Samples and pairs of every node at one level. Grows with the nodes seen, never with the scans."""

    def __init__(self, level: Level, angle_bins: int, seed: int) -> None:
        self.level = level
        self._seed = seed
        self._draw = Draw(level)
        self._keys = np.zeros(0, np.uint64)  # per node
        self._row = np.zeros(0, np.int64)  # per node: its row in all that follows, or -1 while it has none
        self._rows = 0
        self._taken = np.zeros(0, np.int64)  # scans that the memory took
        self._stamps_ns = np.zeros(0, np.int64)  # the newest of them
        self._n_samples = np.zeros((0, angle_bins), np.uint32)
        self._n_pairs = np.zeros((0, angle_bins), np.uint32)
        self._spared = np.zeros(
            (0, angle_bins), np.uint32
        )  # scans taken after N that evicted no sample there
        self._last_seen_ns = np.zeros((0, angle_bins), np.int64)
        self._samples = np.zeros((0, angle_bins, level.window), np.uint16)
        self._spared_then = np.zeros((0, angle_bins, level.window), np.uint32)  # _spared when a sample came
        self._left = np.zeros((0, angle_bins, level.window), np.uint16)
        self._right = np.zeros((0, angle_bins, level.window), np.uint16)

    @property
    def shortfall(self) -> float:
        """Share of the scans due that could not be taken, because the half-life asks for more than the window holds."""
        return self._draw.shortfall

    def add_nodes(self, nodes: Sequence[Node]) -> None:
        """Take note of the nodes that are new at the end of the list."""
        keys = [chance.key(self._seed, node, self.level.name) for node in nodes[len(self._keys) :]]
        self._keys = np.append(self._keys, np.array(keys, np.uint64))
        self._row = np.append(self._row, np.full(len(keys), -1))
        self._draw.add_nodes(len(nodes))

    def _make_room(self, nodes: Ints) -> None:
        """Give a row to each of these nodes that has none."""
        new = nodes[self._row[nodes] < 0]
        self._row[new] = np.arange(self._rows, self._rows + len(new))
        self._rows += len(new)
        room = len(self._taken)
        if room >= self._rows:
            return
        counts = (self._n_samples, self._n_pairs, self._spared, self._spared_then)
        for array in (self._taken, self._stamps_ns, self._last_seen_ns, *counts):
            array.resize((self._rows + _SPARE_ROWS, *array.shape[1:]), refcheck=False)
        for store in (self._samples, self._left, self._right):
            store.resize((self._rows + _SPARE_ROWS, *store.shape[1:]), refcheck=False)
            store[room:] = UNSEEN

    def remember(self, nodes: Ints, stamps_ns: Ints, ranges: Ranges) -> Ints:
        """Learn n virtual scans (n, angle_bins) of their nodes (n,), in stamp order.

        Returns the numbers of the nodes whose memory changed, ascending.
        """
        groups = Groups.of(nodes)
        chosen = groups.order[self._draw.taken(groups, stamps_ns[groups.order], self._keys)]
        nodes, stamps_ns, ranges = nodes[chosen], stamps_ns[chosen], ranges[chosen]  # by node, then by time
        changed = nodes[np.flatnonzero(np.diff(nodes, prepend=-1))]
        self._make_room(changed)
        groups = Groups.of(self._row[nodes])
        row, order = groups.nodes, groups.order
        ranges = ranges[order]
        count = groups.ranks + 1 + self._taken[row]
        keys = chance.mixed(self._keys[nodes[order]], count)
        random = chance.mixed(keys[:, None], np.arange(ranges.shape[1]))
        seen = ranges != UNSEEN
        self._store_samples(groups, ranges, seen, count, random)
        self._store_pairs(groups, ranges, seen, random << np.uint64(32))
        self._taken[row] = count  # ascending within a node: the last one stays
        self._stamps_ns[row] = stamps_ns[order]
        self._note_when_seen(groups, stamps_ns[order], seen)
        return changed

    def _store_samples(
        self, groups: Groups, ranges: Ranges, seen: Bools, taken: Ints, random: chance.Keys
    ) -> None:
        """Keep each scan's ranges; `taken` (n,) is how many scans its node's memory has taken with it."""
        number = groups.running_sums(seen, self._n_samples)
        evicts = seen & (number > self.level.window)
        spared = groups.running_sums(~evicts & (taken > self.level.window)[:, None], self._spared)
        chosen = np.flatnonzero(seen)
        places = self._places(groups, number, chosen, self._n_samples, random)
        self._samples.reshape(-1)[places] = ranges.take(chosen)
        self._spared_then.reshape(-1)[places] = spared.take(chosen)

    def _store_pairs(self, groups: Groups, ranges: Ranges, seen: Bools, random: chance.Keys) -> None:
        both = seen & np.roll(seen, -1, axis=1)
        number = groups.running_sums(both, self._n_pairs)
        chosen = np.flatnonzero(both)
        places = self._places(groups, number, chosen, self._n_pairs, random)
        self._left.reshape(-1)[places] = ranges.take(chosen)
        self._right.reshape(-1)[places] = np.roll(ranges, -1, axis=1).take(chosen)

    def _note_when_seen(self, groups: Groups, stamps_ns: Ints, seen: Bools) -> None:
        newest = np.maximum.reduceat(np.where(seen, stamps_ns[:, None], 0), groups.starts)
        self._last_seen_ns[groups.distinct] = np.maximum(newest, self._last_seen_ns[groups.distinct])

    def _places(
        self, groups: Groups, number: Counts, chosen: Ints, count: Counts, random: chance.Keys
    ) -> Ints:
        """Flat index of the place that each chosen value takes: the next empty one, else a random one.

        `number` (n, angle_bins) counts an angle bin's values, from 1, and above the window where all places are taken;
        `count` (nodes, angle_bins), of those there are now, is cut to the window. Later scans come later, so where two
        take one place, the later stays.
        """
        window = self.level.window
        place = number.take(chosen).astype(np.int64)
        place -= 1
        full = np.flatnonzero(place >= window)
        place[full] = chance.below(random.take(chosen.take(full)), window)
        np.minimum(count, window, out=count)
        angle_bins = number.shape[1]
        row_start = np.repeat((groups.nodes * angle_bins * window), angle_bins)
        row_start.reshape(-1, angle_bins)[:] += np.arange(angle_bins) * window
        place += row_start.take(chosen)
        return place

    def recall(self, nodes: Ints) -> Remembered:
        """Copy of the memory of m different nodes."""
        self._make_room(nodes)
        rows = self._row[nodes]
        n_samples, n_pairs = self._n_samples[rows].astype(np.int64), self._n_pairs[rows].astype(np.int64)
        samples, pairs = (slice(max(1, int(count.max(initial=0)))) for count in (n_samples, n_pairs))
        return Remembered(
            self._samples[rows, :, samples],
            self._spared[rows][:, :, None] - self._spared_then[rows, :, samples],
            self._left[rows, :, pairs],
            self._right[rows, :, pairs],
            n_samples,
            n_pairs,
            self._last_seen_ns[rows],
            self._taken[rows],
            self._stamps_ns[rows],
            self.level.window,
        )

    def kept(self, node: int) -> State:
        """All that is remembered of a node, for `restore`."""
        state, row = self._draw.kept(node), int(self._row[node])
        if row < 0:
            return state
        samples, pairs = (int(n[row].max(initial=0)) for n in (self._n_samples, self._n_pairs))
        state |= {name: array[row, ...] for name, array in self._by_row().items()}
        state |= {name: array[row, :, :samples] for name, array in self._samples_by_row().items()}
        state |= {name: array[row, :, :pairs] for name, array in self._pairs_by_row().items()}
        return state

    def restore(self, node: int, state: State) -> None:
        """Take over what another memory kept of a node, which must be known."""
        self._draw.restore(node, state)
        if "taken" not in state:
            return
        self._make_room(np.array([node]))
        row = int(self._row[node])
        if max(state[name].max() for name in ("n_samples", "n_pairs")) > self.level.window:
            raise ValueError("more than a window holds")
        for name, array in self._by_row().items():
            array[row] = state[name]
        for name, array in (self._samples_by_row() | self._pairs_by_row()).items():
            array[row, :, : state[name].shape[1]] = state[name]

    def kept_of_all(self) -> State:
        """What is remembered of no node alone, for `restore_of_all`."""
        return self._draw.kept_of_all()

    def restore_of_all(self, state: State) -> None:
        """Take over what another memory kept of no node alone."""
        self._draw.restore_of_all(state)

    def _by_row(self) -> dict[str, npt.NDArray[np.generic]]:
        return {
            "taken": self._taken,
            "stamp_ns": self._stamps_ns,
            "n_samples": self._n_samples,
            "n_pairs": self._n_pairs,
            "spared": self._spared,
            "last_seen_ns": self._last_seen_ns,
        }

    def _samples_by_row(self) -> dict[str, npt.NDArray[np.generic]]:
        return {"samples": self._samples, "spared_then": self._spared_then}

    def _pairs_by_row(self) -> dict[str, npt.NDArray[np.generic]]:
        return {"left": self._left, "right": self._right}
