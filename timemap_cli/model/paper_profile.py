"""The estimate with the paper's own states and weights, beside the default; see docs/method.md for how they differ."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from timemap_cli.model.chains import best_states
from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE
from timemap_cli.model.elementary import logarithms
from timemap_cli.model.estimator import Estimated, assembled
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States, borders_at, how_many_known, known_ranges
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN
from timemap_cli.model.vote import neighbouring_rows, pair_counts, shares

Floats = npt.NDArray[np.float64]

MISSING_EDGE = 1e-12  # probability of two states never seen side by side, where no closed path does without


def estimate_as_in_paper(memory: Remembered, range_bin: float) -> Estimated:
    """Estimate m nodes of one level; `range_bin` [m] is the width of the paper's slices of range."""
    angle_bins = memory.samples.shape[1]
    states = states_from_range_bins(memory, range_bin)
    share = shares(replace(memory, ages=np.zeros_like(memory.ages)), states)  # the paper's samples do not age
    own = share.states / np.maximum(share.states.sum(axis=1, keepdims=True), 1e-300)
    weights = _EdgeWeights(memory, states, own, strict=True)
    prior = _prior(states, own, angle_bins)
    best = best_states(prior, weights, states.rows, angle_bins)
    here = weights.edges[weights.of_states(best) == IMPOSSIBLE, 0]
    if len(here):
        loose = best_states(prior, _EdgeWeights(memory, states, own, strict=False), states.rows, angle_bins)
        node = states.rows // angle_bins
        best = np.where(np.isin(node, node[here]), loose, best)  # only where no closed path does without
    return assembled(memory, states, share, best)


def states_from_range_bins(memory: Remembered, range_bin: float) -> States:
    """Every angle bin of which anything is known is a row; its states are the slices of range with anything in them."""
    rows = np.flatnonzero(how_many_known(memory))
    known = known_ranges(memory, rows)
    width = round(range_bin * 1000)
    cell = np.where(known < CLEAR, known // width, known).astype(np.int64)
    new = cell[:, 1:] != cell[:, :-1]
    new &= known[:, 1:] < UNSEEN
    return States(rows, borders_at(known, new), known)


class _EdgeWeights:
    """Log of the weights in the caption of the paper's Fig. 5: a pair's count among all counts of its angle bin.

    A state without any pair takes the next angle bin's own distribution. What was never seen side by side is
    impossible, or, not `strict`, as good as.
    """

    def __init__(self, memory: Remembered, states: States, own: Floats, *, strict: bool) -> None:
        self.edges = neighbouring_rows(states.rows, memory.samples.shape[1])
        count = pair_counts(memory, states, self.edges).astype(np.float64)
        of_state, of_bin = count.sum(axis=2, keepdims=True), count.sum(axis=(1, 2), keepdims=True)
        following = own[self.edges[:, 1], None, :]
        self._tables: npt.NDArray[np.int64] = _log(
            np.where(of_state > 0, count / np.maximum(of_bin, 1), following), strict=strict
        )

    def of_states(self, chosen: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        here, there = self.edges.T
        scores: npt.NDArray[np.int64] = self._tables[np.arange(len(here)), chosen[here], chosen[there]]
        return scores

    def tables(self, edges: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        return self._tables[edges]


def _prior(states: States, own: Floats, angle_bins: int) -> npt.NDArray[np.int64]:
    """Scores of the states by themselves: only the first angle bin has any, the log of its own distribution."""
    scores = np.where(states.exists, 0, IMPOSSIBLE)
    first = _first_rows(states, angle_bins)
    scores[first] = np.where(states.exists[first], _log(own[first], strict=False), IMPOSSIBLE)
    return scores


def _first_rows(states: States, angle_bins: int) -> npt.NDArray[np.int64]:
    """For each node the row with the fewest states: there the circle is cut."""
    node, choices = states.rows // angle_bins, states.exists.sum(axis=1)
    order = np.lexsort((choices, node))
    return order[np.flatnonzero(np.diff(node[order], prepend=-1))]


def _log(probability: Floats, *, strict: bool) -> npt.NDArray[np.int64]:
    score = np.rint(logarithms(np.maximum(probability, MISSING_EDGE)) * SCALE).astype(np.int64)
    return np.where(probability > 0, score, IMPOSSIBLE) if strict else score
