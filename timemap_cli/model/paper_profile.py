"""The estimate with the paper's own states and weights, beside the default; see docs/method.md for how they differ."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from timemap_cli.model.chains import best_states
from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE
from timemap_cli.model.estimator import Estimated, assembled
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States, known_ranges
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN
from timemap_cli.model.vote import Scores, neighbouring_rows, pair_counts, shares

Floats = npt.NDArray[np.float64]

MISSING_EDGE = 1e-12  # probability of two states never seen side by side, where no closed path does without


def estimate_as_in_paper(memory: Remembered, range_bin: float) -> Estimated:
    """Estimate m nodes of one level; `range_bin` [m] is the width of the paper's slices of range."""
    angle_bins = memory.samples.shape[1]
    memory = replace(memory, ages=np.zeros_like(memory.ages))  # the paper's samples do not age
    states = states_from_range_bins(memory, range_bin)
    share = shares(memory, states)
    scores = _scores(memory, states, share.states, strict=True)
    best = best_states(scores, states.rows, angle_bins)
    if _is_broken(scores, best):
        best = best_states(_scores(memory, states, share.states, strict=False), states.rows, angle_bins)
    return assembled(memory, states, share, best)


def states_from_range_bins(memory: Remembered, range_bin: float) -> States:
    """Every angle bin of which anything is known is a row; its states are the slices of range with anything in them."""
    known, n_known = known_ranges(memory)
    width = round(range_bin * 1000)
    cell = np.where(known < CLEAR, known // width, known).astype(np.int64)
    new = cell[:, 1:] != cell[:, :-1]
    new &= known[:, 1:] < UNSEEN
    rows = np.flatnonzero(n_known)
    row, column = np.nonzero(new[rows])
    number = np.cumsum(new[rows], axis=1)[row, column]
    starts = np.full((len(rows), int(number.max(initial=0)) + 1), UNSEEN, np.uint16)
    starts[:, 0] = 0
    starts[row, number] = known[rows[row], column + 1]
    return States(rows, starts, known, n_known)


def _scores(memory: Remembered, states: States, share: Floats, *, strict: bool) -> Scores:
    """Log of the caption's weights in the paper's Fig. 5, and the prior at the angle bin with the fewest states.

    A weight is a pair's count among all counts of its angle bin; a state without any pair takes the next angle bin's
    own distribution. Never seen side by side is impossible, or, not `strict`, MISSING_EDGE.
    """
    angle_bins = memory.samples.shape[1]
    edges = neighbouring_rows(states.rows, angle_bins)
    count = pair_counts(memory, states, edges).astype(np.float64)
    own = share / np.maximum(share.sum(axis=1, keepdims=True), 1e-300)
    of_state, of_bin = count.sum(axis=2, keepdims=True), count.sum(axis=(1, 2), keepdims=True)
    weight = np.where(of_state > 0, count / np.maximum(of_bin, 1), own[edges[:, 1], None, :])
    unary = np.where(states.exists, 0, IMPOSSIBLE)
    first = _first_rows(states, angle_bins)
    unary[first] = np.where(states.exists[first], _log(own[first], strict=False), IMPOSSIBLE)
    return Scores(unary, edges, _log(weight, strict=strict))


def _first_rows(states: States, angle_bins: int) -> npt.NDArray[np.int64]:
    """For each node the row with the fewest states: there the circle is cut."""
    node, choices = states.rows // angle_bins, states.exists.sum(axis=1)
    order = np.lexsort((choices, node))
    return order[np.flatnonzero(np.diff(node[order], prepend=-1))]


def _log(probability: Floats, *, strict: bool) -> npt.NDArray[np.int64]:
    score = np.rint(np.log(np.maximum(probability, MISSING_EDGE)) * SCALE).astype(np.int64)
    return np.where(probability > 0, score, IMPOSSIBLE) if strict else score


def _is_broken(scores: Scores, best: npt.NDArray[np.int64]) -> bool:
    """Whether a chosen path steps over a pair that was never seen."""
    here, there = scores.edges.T
    return bool((scores.pairwise[np.arange(len(here)), best[here], best[there]] == IMPOSSIBLE).any())
