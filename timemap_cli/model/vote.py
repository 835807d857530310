"""The vote: what each state of an angle bin has for itself, and what cannot stand side by side.

Every angle bin votes with its share of the level's window; pairs only forbid. With weights from pairs alone the
votes of a coherent object cancel, and one angle bin plus the noise of a table decides; see docs/method.md.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE
from timemap_cli.model.elementary import logarithms
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States
from timemap_cli.model.virtual_scan import UNSEEN, Bools, Ranges

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

FORBIDDEN = 100.0  # score of two states that were never seen together though they should have been
PAIR_PRIOR = 0.1  # pairs added to both sides of a ratio, so that an empty table says nothing
OLDEST = 1e-4  # least weight of a sample: where all are old, their number decides


@dataclass(frozen=True, slots=True)
class Shares:
    """How much of the level's window speaks for what, each a share 0..1."""

    known: Floats  # (m * angle_bins,) all samples of the angle bin
    states: Floats  # (rows, states)
    weights: npt.NDArray[np.int32]  # (m * angle_bins, most samples) [1 / SCALE]; 0: no sample


def shares(memory: Remembered, states: States) -> Shares:
    """Shares of the window, each sample weighted by what the level would have forgotten had it looked."""
    angle_bins, depth = memory.samples.shape[1:]
    weight = _freshness(memory.window).take(memory.ages, mode="clip").reshape(-1, depth)
    samples = memory.samples.reshape(-1, depth)
    weight *= samples < UNSEEN
    full = np.maximum(1, np.minimum(memory.taken, memory.window)) * float(SCALE)
    full = np.repeat(full, angle_bins)
    known = weight.sum(axis=1, dtype=np.int32) / full
    rows = np.arange(len(states.rows))
    per_state = _sums(states.labels(samples[states.rows], rows), weight[states.rows], states.size)
    return Shares(known, per_state / full[states.rows, None], weight)


def votes(memory: Remembered, states: States, share: Shares) -> Ints:
    """Score of each state (rows, states): log of the share of the window that does not contradict it.

    Between equal shares the state of the sample at the first place wins. While the window fills that is the oldest;
    later it is a random one that stays for a while. The nearest state would win at one scan and lose at the next.
    """
    against = share.known[states.rows, None] - share.states
    scores = _whole(logarithms(np.maximum(0.5 / memory.window, 1 - against)))
    scores[~states.exists] = IMPOSSIBLE
    first = memory.samples.reshape(-1, memory.samples.shape[2])[states.rows, :1]
    rows = np.flatnonzero(first[:, 0] < UNSEEN)
    scores[rows, states.labels(first[rows], rows)[:, 0]] += 1
    return scores


class Forbidding:
    """What cannot stand side by side: states that are rarer as pairs than chance would have them, by half and more."""

    def __init__(self, memory: Remembered, states: States) -> None:
        self._memory = memory
        self._states = states
        self.edges = neighbouring_rows(states.rows, memory.samples.shape[1])

    def of_states(self, chosen: Ints) -> Ints:
        """Score of each edge (edges,) when every row shows its chosen state (rows,)."""
        here, there = self.edges.T
        left, right = pairs_of(self._memory, self._states.rows[here])
        low, high = self._states.span(here, chosen[here])
        from_here = (left >= low) & (left < high)
        low, high = self._states.span(there, chosen[there])
        to_there = (right >= low) & (right < high)
        count, row, column = (_count(mask) for mask in (from_here & to_there, from_here, to_there))
        pairs = self._memory.n_pairs.reshape(-1)[self._states.rows[here]]
        return _forbidden(count, row * column / np.maximum(1, pairs))

    def tables(self, edges: Ints) -> Ints:
        """Scores (k, states, states) of these edges, for every two states."""
        count = pair_counts(self._memory, self._states, self.edges[edges])
        row, column = count.sum(axis=2, keepdims=True), count.sum(axis=1, keepdims=True)
        return _forbidden(count, row * column / np.maximum(1, count.sum(axis=(1, 2), keepdims=True)))


def _forbidden(count: Ints, expected: Floats) -> Ints:
    """Score, never above 0, of a pair that was seen so often, and would be so often by chance."""
    ratio = (count + PAIR_PRIOR) / (expected + PAIR_PRIOR)
    return _whole(-FORBIDDEN * np.maximum(0, 1 - 2 * ratio))


def neighbouring_rows(rows: Ints, angle_bins: int) -> Ints:
    """Places (edges, 2) in `rows` of angle bins next to each other in one node."""
    following = rows + 1
    following[following % angle_bins == 0] -= angle_bins
    place = np.searchsorted(rows, following)
    found = np.flatnonzero(np.append(rows, -1)[place] == following)
    return np.stack((found, place[found]), axis=1)


def pairs_of(memory: Remembered, rows: Ints) -> tuple[Ranges, Ranges]:
    """Pairs (k, most pairs) of these angle bins: the range there, and in the next."""
    depth = memory.left.shape[2]
    return memory.left.reshape(-1, depth)[rows], memory.right.reshape(-1, depth)[rows]


def pair_counts(memory: Remembered, states: States, edges: Ints) -> Ints:
    """How often each two states of neighbouring rows were remembered side by side (edges, states, states)."""
    left, right = pairs_of(memory, states.rows[edges[:, 0]])
    label = states.labels(left, edges[:, 0]).astype(np.int64) * states.size
    label += states.labels(right, edges[:, 1])
    counts = _sums(label, left < UNSEEN, states.size * states.size)
    return counts.reshape(-1, states.size, states.size)


def _count(mask: Bools) -> Ints:
    """How many are true in each row (rows,)."""
    return np.asarray(mask.view(np.uint8).sum(axis=1, dtype=np.uint16), np.int64)


def _sums(labels: npt.NDArray[np.integer], weights: npt.NDArray[np.generic], size: int) -> Ints:
    """Sum of the weights of each label 0 .. size - 1 in each row (rows, size); exact below 2^53."""
    labels = labels + np.arange(len(labels))[:, None] * size
    sums = np.bincount(labels.ravel(), weights.ravel(), len(labels) * size)
    return sums.astype(np.int64).reshape(-1, size)


@cache
def _freshness(window: int) -> npt.NDArray[np.int32]:
    """Weight of a sample by its age in scans [1 / SCALE]."""
    kept = 1 - 1 / window
    weights = [1.0]
    while weights[-1] > OLDEST:
        weights.append(weights[-1] * kept)
    return np.array([round(max(OLDEST, weight) * SCALE) for weight in weights], np.int32)


def _whole(scores: Floats) -> Ints:
    return np.rint(scores * SCALE).astype(np.int64)
