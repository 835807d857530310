"""The estimate against the experiment's own reference, where that lies beside the checkout."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from timemap_cli.model.estimator import estimate
from timemap_cli.model.memory import Remembered
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

PATH = Path(__file__).parents[2].parent / "shared" / "notes" / "estimator_reference.py"


@pytest.fixture(scope="module")
def reference():
    if not PATH.exists():
        pytest.skip("no reference beside the checkout")
    spec = importlib.util.spec_from_file_location("estimator_reference", PATH)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def learnt(reference, angle_bins, window, scans, seed):
    """The reference's memory of two scenes that take turns, far enough apart to be told apart by any rule."""
    random = np.random.default_rng(seed)
    scenes = np.stack((random.uniform(0.4, 0.9, angle_bins), random.uniform(1.3, 1.8, angle_bins)))
    memory = reference.Memory(angle_bins, window, seed=seed, young=False)
    for _ in range(scans):
        scan = np.round(scenes[random.integers(2)] + random.normal(0, 0.008, angle_bins), 3)
        scan[random.random(angle_bins) < 0.25] = np.nan
        scan[random.random(angle_bins) < 0.05] = np.inf
        memory.add(scan)
    return memory


def told(reference, memory):
    def codes(metres):
        mm = np.rint(np.nan_to_num(metres, nan=0) * 1000)
        mm[metres == reference.FREE] = CLEAR
        return np.where(np.isnan(metres), UNSEEN, mm).astype(np.uint16)[None]

    ages = np.where(np.isnan(memory.r), 0, memory.D[:, None] - memory.d).astype(np.uint32)[None]
    return Remembered(
        codes(memory.r),
        ages,
        codes(memory.pa),
        codes(memory.pb),
        memory.n[None],
        memory.m[None],
        np.zeros((1, len(memory.m)), np.int64),
        np.array([memory.T]),
        np.array([0]),
        memory.N,
    )


@pytest.mark.parametrize("seed", range(60))
def test_ranges_and_shares_are_those_of_the_experiments_reference(reference, seed):
    memory = learnt(reference, 4 + seed % 20, 3 + seed % 7, 1 + seed, seed)
    ranges, share, known = reference.estimate(memory, 0.1)
    found = estimate(told(reference, memory), 0.1)
    metres = np.where(
        found.ranges == CLEAR, np.inf, np.where(found.ranges == UNSEEN, np.nan, found.ranges / 1000)
    )
    if (metres[0] == ranges).sum() + np.isnan(ranges).sum() < len(
        ranges
    ):  # a tie: the scores must be the same
        unary, pairwise, *_ = reference.potentials(memory, 0.1)
        best = reference.best_cycle(unary, pairwise)[1]
        assert path_score(reference, memory, metres[0], unary, pairwise) == pytest.approx(best, abs=1e-4)
        return
    np.testing.assert_array_equal(metres[0], ranges)
    np.testing.assert_allclose(found.known[0], known, atol=2e-6)
    np.testing.assert_allclose(found.support[0], share / np.maximum(known, 1e-9), atol=1e-4)


def path_score(reference, memory, metres, unary, pairwise):
    """Score that the reference gives to what the model estimated."""
    known = np.concatenate([memory.r, memory.pa, np.roll(memory.pb, 1, axis=0)], axis=1)
    cuts = reference.make_cuts(known, 0.1)
    values = np.where(np.isposinf(metres), reference.FREE, metres)[:, None]
    path = np.maximum(reference.label(values, cuts)[:, 0], 0)
    n = len(path)
    return sum(unary[a, path[a]] + pairwise[a, path[a], path[(a + 1) % n]] for a in range(n))
