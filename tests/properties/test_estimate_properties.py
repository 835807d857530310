"""The estimate against a slow reference, and what must hold of it whatever was remembered."""

import copy
import random as standard_random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.model.memories import told
from tests.model.reference import CLEAR as SLOW_CLEAR
from tests.model.reference import SlowEstimate, SlowMemory
from timemap_cli.model.estimator import estimate
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

WIDTH = 0.10


def memory_of(angle_bins, window, scans, seed, *, spread=15, unseen=0.25, clear=0.1, far=False):
    """A memory that saw a few scenes in turn, each angle bin of them now and then unseen or clear."""
    random = standard_random.Random(seed)
    top = 9000 if far else 3200
    scenes = [[random.randint(300, top) for _ in range(angle_bins)] for _ in range(3)]
    memory = SlowMemory(angle_bins, window, random.randrange)
    for _ in range(scans):
        scene = random.choice(scenes)
        scan = [max(1, round(random.gauss(value, spread))) for value in scene]
        scan = [SLOW_CLEAR if random.random() < clear else value for value in scan]
        memory.learn([None if random.random() < unseen else value for value in scan])
    return memory


memories = st.builds(
    memory_of,
    angle_bins=st.integers(2, 6),
    window=st.integers(2, 8),
    scans=st.integers(0, 40),
    seed=st.integers(0, 2**32),
    spread=st.sampled_from([0, 5, 15, 60, 200]),
    unseen=st.sampled_from([0.0, 0.25, 0.7]),
    clear=st.sampled_from([0.0, 0.1, 0.5]),
    far=st.booleans(),
)


def slow_code(value):
    return {CLEAR: SLOW_CLEAR, UNSEEN: None}.get(value, value)


def assert_estimate_is_the_references(memory, found, row=0):
    """The chosen path has the best score there is; what is reported of it is what the reference would report."""
    slow = SlowEstimate(memory, WIDTH * 1000)
    path = []
    for a in slow.bins:
        value = slow_code(int(found.ranges[row, a]))
        i = 0 if value is None else slow.state_of(a, value)
        assert value == slow.reported(a, i)
        assert found.support[row, a] == pytest.approx(slow.support(a, value), abs=1e-4)
        assert found.known[row, a] == pytest.approx(sum(slow.share[a]), abs=2e-6)
        assert found.samples[row, a] == len(memory.samples[a])
        assert found.status[row, a] == slow.status(a, i) or slow.status(a, i) is None
        path.append(i)
    assert slow.score(path) == pytest.approx(slow.best_score(), abs=len(path) * 2e-6)
    return slow, path


@given(memories)
@settings(max_examples=250)
def test_the_estimate_is_the_slow_references(memory):
    slow, path = assert_estimate_is_the_references(memory, estimate(told(memory), WIDTH))
    if np.prod([len(states) for states in slow.states]) < 3000:
        assert slow.score(path) == pytest.approx(slow.brute_force(), abs=1e-4)


@pytest.mark.parametrize("seed", range(6))
def test_the_estimate_of_a_long_circle_is_the_slow_references(seed):
    memory = memory_of(90, 12, 40, seed, unseen=0.3, clear=0.05)
    assert_estimate_is_the_references(memory, estimate(told(memory), WIDTH))


def test_nodes_estimated_together_are_estimated_as_if_alone():
    several = [memory_of(20, 6, scans, seed=scans, unseen=0.2) for scans in (0, 1, 5, 9, 30, 31, 32)]
    together = estimate(told(several), WIDTH)
    for row, memory in enumerate(several):
        assert_estimate_is_the_references(memory, together, row)


@given(
    st.lists(st.integers(0, 2**32), min_size=2, max_size=6),
    st.integers(1, 8),
    st.sampled_from([4, 5, 12, 16]),
)
@settings(max_examples=120)
def test_an_estimate_depends_on_its_own_node_alone(seeds, scans, angle_bins):
    """Small memories are full of ties: they too must be decided the same in any company."""
    several = [memory_of(angle_bins, 4, scans, seed, spread=0, unseen=0.1, clear=0.0) for seed in seeds]
    together = estimate(told(several), WIDTH)
    for row, memory in enumerate(several):
        np.testing.assert_array_equal(estimate(told(memory), WIDTH).ranges[0], together.ranges[row])


def turned(memory, by):
    twin = copy.deepcopy(memory)
    for name in ("samples", "pairs", "spared"):
        entries = getattr(memory, name)
        setattr(twin, name, entries[-by:] + entries[:-by] if by else list(entries))
    return twin


def mirrored(memory):
    twin = copy.deepcopy(memory)
    twin.samples, twin.spared = memory.samples[::-1], memory.spared[::-1]
    swapped = [[(there, here) for here, there in pairs] for pairs in memory.pairs[::-1]]
    twin.pairs = swapped[1:] + swapped[:1]  # the pair of (a, a + 1) now joins (n - 1 - (a + 1), n - 1 - a)
    return twin


@given(memories, st.integers(0, 5))
@settings(max_examples=100)
def test_turning_or_mirroring_what_is_remembered_turns_or_mirrors_the_estimate(memory, by):
    """No direction and no origin: up to ties, which only the scores can tell."""
    by %= memory.angle_bins
    best = SlowEstimate(memory, WIDTH * 1000).best_score()
    for twin in (turned(memory, by), mirrored(memory)):
        slow, path = assert_estimate_is_the_references(twin, estimate(told(twin), WIDTH))
        assert slow.score(path) == pytest.approx(best, abs=1e-4)


@given(memories)
@settings(max_examples=100)
def test_every_reported_range_was_measured_in_that_angle_bin(memory):
    found = estimate(told(memory), WIDTH)
    slow = SlowEstimate(memory, WIDTH * 1000)
    for a in slow.bins:
        value = slow_code(int(found.ranges[0, a]))
        assert value in slow.known(a) if slow.known(a) else value is None
    assert (found.support <= 1 + 1e-9).all()
    assert (found.support >= 0).all()
    assert (found.known >= 0).all()
    assert (found.known <= 1 + 1e-9).all()
