"""The estimate from pairs alone, with the paper's two readings of an edge's weight."""

from typing import Literal

import numpy as np
import numpy.typing as npt

from sample_logs.rays import Floats
from timemap_cli.model.chains import best_states
from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE
from timemap_cli.model.estimator import assembled
from timemap_cli.model.memory import Remembered
from timemap_cli.model.paper_profile import MISSING_EDGE
from timemap_cli.model.states import States, how_many_known, known_ranges
from timemap_cli.model.virtual_scan import UNSEEN, Ranges
from timemap_cli.model.vote import neighbouring_rows, pair_counts, shares

Ints = npt.NDArray[np.int64]


def estimate_by_weights(memory: Remembered, states: States, *, of: Literal["state", "bin"]) -> Ranges:
    """The closed path with the most probable edges (m, angle_bins) [mm]; `states` of every angle bin that knows any.

    An edge's weight is the pair's count by those of its state (the paper's eq. 4) or of its whole angle bin (the
    caption of Fig. 5). As in `profile: paper` a state without pairs takes the next angle bin's own distribution, and
    a pair never seen is impossible, unless no closed path does without.
    """
    share = shares(memory, states)
    own = share.states / np.maximum(share.states.sum(axis=1, keepdims=True), 1e-300)
    edges = neighbouring_rows(states.rows, memory.samples.shape[1])
    weight = _weights(pair_counts(memory, states, edges).astype(np.float64), own[edges[:, 1]], of)
    node = states.rows // memory.samples.shape[1]
    prior = _prior(states, own, node)
    strict = _Tables(edges, np.where(weight > 0, _log(weight), IMPOSSIBLE))
    best = _search(prior, strict, states, memory)
    stuck = node[edges[strict.of_states(best) <= IMPOSSIBLE, 0]]
    if len(stuck):
        loose = _search(prior, _Tables(edges, _log(weight)), states, memory)
        best = np.where(np.isin(node, stuck), loose, best)
    return assembled(memory, states, share, best).ranges


def every_angle_bin(memory: Remembered, states: States) -> States:
    """The same states, and a single one for each other angle bin of which anything is known."""
    rows = np.flatnonzero(how_many_known(memory))
    borders = np.full((len(rows), states.size + 1), UNSEEN, np.uint16)
    borders[:, 0] = 0
    borders[np.searchsorted(rows, states.rows)] = states.borders
    return States(rows, borders, known_ranges(memory, rows))


class _Tables:
    """A Coupling from whole tables of scores."""

    def __init__(self, edges: Ints, scores: Ints) -> None:
        self.edges = edges
        self._scores = scores

    def of_states(self, chosen: Ints) -> Ints:
        """Scores (edges,) of the chosen states (rows,)."""
        here, there = self.edges.T
        found: Ints = self._scores[np.arange(len(here)), chosen[here], chosen[there]]
        return found

    def tables(self, edges: Ints) -> Ints:
        """Scores (k, states, states) of these edges."""
        return self._scores[edges]


def _weights(count: Floats, following: Floats, of: str) -> Floats:
    of_state, of_bin = count.sum(axis=2, keepdims=True), count.sum(axis=(1, 2), keepdims=True)
    total = of_state if of == "state" else of_bin
    return np.where(of_state > 0, count / np.maximum(total, 1), following[:, None, :])


def _prior(states: States, own: Floats, node: Ints) -> Ints:
    """Each node's first angle bin, that with the fewest states, scores its own distribution; others nothing."""
    scores = np.where(states.exists, 0, IMPOSSIBLE)
    order = np.lexsort((states.exists.sum(axis=1), node))
    first = order[np.flatnonzero(np.diff(node[order], prepend=-1))]
    scores[first] = np.where(states.exists[first], _log(own[first]), IMPOSSIBLE)
    return scores


def _search(prior: Ints, tables: _Tables, states: States, memory: Remembered) -> Ints:
    return best_states(prior, tables, states.rows, memory.samples.shape[1])


def _log(probability: Floats) -> Ints:
    score: Ints = np.rint(np.log(np.maximum(probability, MISSING_EDGE)) * SCALE).astype(np.int64)
    return score
