"""The vote: what each state of an angle bin has for itself, and what cannot stand side by side.

Every angle bin votes with its share of the level's window; pairs only forbid. With weights from pairs alone the
votes of a coherent object cancel, and one angle bin plus the noise of a table decides; see docs/method.md.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States
from timemap_cli.model.virtual_scan import UNSEEN

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

FORBIDDEN = 100.0  # score of two states that were never seen together though they should have been
PAIR_PRIOR = 0.1  # pairs added to both sides of a ratio, so that an empty table says nothing
OLDEST = 1e-4  # least weight of a sample: where all are old, their number decides


@dataclass(frozen=True, slots=True)
class Scores:
    """What the best closed path is chosen by; scores are whole numbers of 1 / SCALE."""

    unary: Ints  # (rows, states)
    edges: Ints  # (edges, 2) neighbouring rows, in the direction of the bearing
    pairwise: Ints  # (edges, states, states), never above 0


@dataclass(frozen=True, slots=True)
class Shares:
    """How much of the level's window speaks for what, each a share 0..1."""

    known: Floats  # (m * angle_bins,) all samples of the angle bin
    states: Floats  # (rows, states)


def shares(memory: Remembered, states: States) -> Shares:
    """Shares of the window, each sample weighted by what the level would have forgotten had it looked."""
    angle_bins, window = memory.samples.shape[1:]
    weight = _freshness(window).take(memory.ages, mode="clip").reshape(-1, window)
    samples = memory.samples.reshape(-1, window)
    weight *= samples < UNSEEN
    full = np.maximum(1, np.minimum(memory.taken, window)) * float(SCALE)
    full = np.repeat(full, angle_bins)
    known = weight.sum(axis=1, dtype=np.int32) / full
    per_state = _sums(states.labels(samples[states.rows]), weight[states.rows], states.starts.shape[1])
    return Shares(known, per_state / full[states.rows, None])


def vote(memory: Remembered, states: States, share: Shares) -> Scores:
    """Scores of the rows of `states`.

    Unary: log of the share of the window that does not contradict a state. Pairwise: where two states are rarer side by side than chance
    would have them by half, they are forbidden; else nothing.
    """
    window = memory.window
    against = share.known[states.rows, None] - share.states
    unary = _whole(np.log(np.maximum(0.5 / window, 1 - against)))
    unary[~states.exists] = IMPOSSIBLE
    edges = neighbouring_rows(states.rows, memory.samples.shape[1])
    count = pair_counts(memory, states, edges)
    row, column = count.sum(axis=2, keepdims=True), count.sum(axis=1, keepdims=True)
    expected = row * column / np.maximum(1, count.sum(axis=(1, 2), keepdims=True))
    ratio = (count + PAIR_PRIOR) / (expected + PAIR_PRIOR)
    return Scores(unary, edges, _whole(-FORBIDDEN * np.maximum(0, 1 - 2 * ratio)))


def neighbouring_rows(rows: Ints, angle_bins: int) -> Ints:
    """Places (edges, 2) in `rows` of angle bins next to each other in one node."""
    following = rows + 1
    following[following % angle_bins == 0] -= angle_bins
    place = np.searchsorted(rows, following)
    found = np.flatnonzero(np.append(rows, -1)[place] == following)
    return np.stack((found, place[found]), axis=1)


def pair_counts(memory: Remembered, states: States, edges: Ints) -> Ints:
    """How often each two states of neighbouring rows were remembered side by side (edges, states, states)."""
    size = states.starts.shape[1]
    flat = states.rows[edges[:, 0]]
    left = memory.left.reshape(-1, memory.window)[flat]
    right = memory.right.reshape(-1, memory.window)[flat]
    label = states.labels(left, edges[:, 0]).astype(np.int64) * size
    label += states.labels(right, edges[:, 1])
    return _sums(label, left < UNSEEN, size * size).reshape(-1, size, size)


def _sums(labels: npt.NDArray[np.integer], weights: npt.NDArray[np.generic], size: int) -> Ints:
    """Sum of the weights of each label 0 .. size - 1 in each row (rows, size); exact below 2^53."""
    labels = labels + np.arange(len(labels))[:, None] * size
    sums = np.bincount(labels.ravel(), weights.ravel(), len(labels) * size)
    return sums.astype(np.int64).reshape(-1, size)


@cache
def _freshness(window: int) -> npt.NDArray[np.int32]:
    """Weight of a sample by the scans taken since that did not see its angle bin [1 / SCALE]."""
    kept = 1 - 1 / window
    weights = [1.0]
    while weights[-1] > OLDEST:
        weights.append(weights[-1] * kept)
    return np.array([round(max(OLDEST, weight) * SCALE) for weight in weights], np.int32)


def _whole(scores: Floats) -> Ints:
    return np.rint(scores * SCALE).astype(np.int64)
