"""The definitions that stand beside the program's own."""

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, median, paper
from benchmarks.paper.weights import estimate_by_weights
from tests.model.memories import codes, learnt, recalled
from timemap_cli.model.paper_profile import states_from_range_bins


def remembered(scans, window=50):
    return recalled(learnt(scans, window))


def noisy(values, n, seed):
    random = np.random.default_rng(seed)
    return np.asarray(values, float) + random.normal(0, 0.01, (n, len(values)))


def test_the_median_is_the_lower_one_and_clear_is_farthest():
    scans = [[1.0, 1.0], [2.0, np.inf], [3.0, np.inf], [np.nan, 1.0]]
    assert np.array_equal(median(remembered(scans))[0], codes([2.0, 1.0]))


def test_caption_weights_written_anew_agree_with_the_profile():
    for seed in range(8):
        scans = np.concatenate(
            [noisy([1.0, 1.2, 1.4, 1.1], 20, seed), noisy([0.6, 0.8, 1.0, 0.7], 15, seed + 50)]
        )
        scans[np.random.default_rng(seed).random(scans.shape) < 0.2] = np.nan
        memory = remembered(scans)
        again = estimate_by_weights(memory, states_from_range_bins(memory, 0.075), of="bin")
        assert np.array_equal(again, paper(memory))


def test_all_definitions_show_a_world_that_never_changed():
    values = [1.01, 1.24, 1.39, 1.09]  # near the middle of fixed range bins of 7.5 cm
    memory = remembered(noisy(values, 50, 3))
    for name, estimate in DEFINITIONS.items():
        assert np.abs(estimate(memory)[0] / 1000 - values).max() < 0.02, name
