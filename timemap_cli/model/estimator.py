"""The most probable consistent scan of a node and level, from what it remembers."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.chains import best_states
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States, ascending, states_from_data
from timemap_cli.model.status import Codes, statuses
from timemap_cli.model.support import support
from timemap_cli.model.virtual_scan import Ranges
from timemap_cli.model.vote import Forbidding, Shares, shares, votes

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Estimated:
    """Estimates of m nodes at one level."""

    ranges: Ranges  # (m, angle_bins) [mm], measured ones or CLEAR or UNSEEN
    support: Floats  # (m, angle_bins) share of what is known that agrees
    known: Floats  # (m, angle_bins) share of the window that is known
    samples: Ints  # (m, angle_bins) remembered ranges
    status: Codes  # (m, angle_bins) a `Status` each


Estimator = Callable[[Remembered], Estimated]


def estimate(memory: Remembered, state_width: float) -> Estimated:
    """Estimate m nodes of one level by the vote; `state_width` [m] as in `states_from_data`."""
    states = states_from_data(memory, state_width)
    share = shares(memory, states)
    angle_bins = memory.samples.shape[1]
    best = best_states(votes(memory, states, share), Forbidding(memory, states), states.rows, angle_bins)
    return assembled(memory, states, share, best)


def assembled(memory: Remembered, states: States, share: Shares, best: Ints) -> Estimated:
    """Put together what the chosen states `best` (rows,) say."""
    ranges = _measured(memory, states, best)
    shape = memory.n_samples.shape
    return Estimated(
        ranges.reshape(shape),
        support(memory, share, ranges).reshape(shape),
        share.known.reshape(shape),
        memory.n_samples,
        statuses(memory, states, share, best).reshape(shape),
    )


def _measured(memory: Remembered, states: States, best: Ints) -> Ranges:
    """The lower median of each angle bin's samples in its state (m * angle_bins,) [mm].

    Where the samples of the state are gone, its pairs' ranges stand in for them.
    """
    low, high = states.span(np.arange(len(best)), best)
    samples = ascending(memory.samples.reshape(-1, memory.samples.shape[2]))
    n_samples = memory.n_samples.reshape(-1)
    begin, end = np.zeros_like(n_samples), n_samples.copy()
    begin[states.rows], end[states.rows] = _between(samples[states.rows], low, high)
    median: Ranges = samples[np.arange(len(samples)), np.maximum(begin + end - 1, 0) // 2]
    lost = np.flatnonzero(begin[states.rows] == end[states.rows])
    begin, end = _between(states.known[lost], low[lost], high[lost])
    median[states.rows[lost]] = states.known[lost, (begin + end - 1) // 2]
    return median


def _between(ordered: Ranges, low: Ranges, high: Ranges) -> tuple[Ints, Ints]:
    """First place, and one past the last, of each row's values in [low, high)."""
    return (ordered < low).sum(axis=1), (ordered < high).sum(axis=1)
