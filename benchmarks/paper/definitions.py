"""The definitions of the estimate that are compared: all read the same memory."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.paper.weights import estimate_by_weights, every_angle_bin
from timemap_cli.model.estimator import assembled, estimate
from timemap_cli.model.memory import Remembered
from timemap_cli.model.paper_profile import estimate_as_in_paper, states_from_range_bins
from timemap_cli.model.states import ascending, states_from_data
from timemap_cli.model.virtual_scan import Ranges
from timemap_cli.model.vote import shares, votes

Definition = Callable[[Remembered], Ranges]  # of m nodes: (m, angle_bins) [mm]

STATE_WIDTH = 0.1  # [m] the default of map.range_bin
RANGE_BIN = 0.075  # [m] the paper's


def vote(memory: Remembered) -> Ranges:
    """The program's default."""
    return estimate(memory, STATE_WIDTH).ranges


def paper(memory: Remembered) -> Ranges:
    """The program's `profile: paper`: fixed range bins, the weights in the caption of Fig. 5."""
    return estimate_as_in_paper(memory, RANGE_BIN).ranges


def row_sums(memory: Remembered) -> Ranges:
    """The paper's eq. 4: a pair's count by the row's sum, fixed range bins."""
    memory = _ageless(memory)
    return estimate_by_weights(memory, states_from_range_bins(memory, RANGE_BIN), of="state")


def caption_from_data(memory: Remembered) -> Ranges:
    """The weights in the caption of Fig. 5, but states found in the data."""
    memory = _ageless(memory)
    states = every_angle_bin(memory, states_from_data(memory, STATE_WIDTH))
    return estimate_by_weights(memory, states, of="bin")


def vote_without_pairs(memory: Remembered) -> Ranges:
    """The default's votes, each angle bin for itself."""
    states = states_from_data(memory, STATE_WIDTH)
    share = shares(memory, states)
    return assembled(memory, states, share, votes(memory, states, share).argmax(axis=1)).ranges


def vote_without_freshness(memory: Remembered) -> Ranges:
    """The default, but scans that did not see an angle bin leave the weight of its samples."""
    return vote(_ageless(memory))


def median(memory: Remembered) -> Ranges:
    """Biber and Duckett (RSS 2005, dynamic maps for long-term operation): the median of each angle bin's samples."""
    depth = memory.samples.shape[2]
    ordered = ascending(memory.samples.reshape(-1, depth))
    middle = np.maximum(memory.n_samples.reshape(-1) - 1, 0) // 2
    found: Ranges = ordered[np.arange(len(ordered)), middle].reshape(memory.n_samples.shape)
    return found


def chosen(*names: str) -> dict[str, Definition]:
    """Some of the definitions, by name."""
    return {name: DEFINITIONS[name] for name in names}


def _ageless(memory: Remembered) -> Remembered:
    return replace(memory, ages=np.zeros_like(memory.ages))


DEFINITIONS: dict[str, Definition] = {
    "ours": vote,
    "profile: paper": paper,
    "eq. 4 (row sums)": row_sums,
    "caption, states from data": caption_from_data,
    "vote without pairs": vote_without_pairs,
    "vote without freshness": vote_without_freshness,
    "median per angle bin": median,
}
