"""The half-life that is stated is the one that is measured: half the window is new when it has gone by.

Each angle bin stands for itself here (no two neighbours are seen together), so a scene is many experiments at once.
"""

import numpy as np
import pytest

from tests.model.memories import codes
from timemap_cli.model.estimator import estimate
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import CLEAR

OLD, NEW = 3.0, 2.0
ANGLE_BINS = 240
NODES = 12


class Experiment:
    """Several nodes that look at the same scene, each angle bin seen in a part of the scans."""

    def __init__(self, level, seen, step_s=0.1):
        self.memory = Memory(level, ANGLE_BINS, 0)
        self.memory.add_nodes([Node(n, 0) for n in range(NODES)])
        self.level, self.seen, self.step_ns, self.now = level, seen, round(step_s * 1e9), 0
        self.random = np.random.default_rng(14)

    def show(self, value, scans, nodes=range(NODES)):
        """So many scans of the nodes with this range [m] in every second angle bin, where it is seen at all."""
        rows = np.full((scans * len(nodes), ANGLE_BINS), np.nan)
        here = self.random.random((len(rows), ANGLE_BINS // 2)) < self.seen
        rows[:, ::2][here] = value
        stamps = (self.now + np.arange(scans)) * self.step_ns
        self.now += scans
        self.memory.remember(np.tile(nodes, scans), np.repeat(stamps, len(nodes)), codes(rows))

    def show_for_long(self, value, scans):
        """So many scans, and a few more of some nodes, so that not all of them stand at the same place of a turn."""
        self.show(value, scans)
        for first in range(1, NODES):
            self.show(value, 1, range(first, NODES))
        self.show(value, 1)

    def share_of_new(self):
        """Share that the new range has in what is known, over all angle bins and nodes."""
        found = estimate(self.memory.recall(np.arange(NODES)), 0.1)
        known, support = found.known[:, ::2], found.support[:, ::2]
        new = known * np.where(found.ranges[:, ::2] == round(NEW * 1000), support, 1 - support)
        return float(new.sum() / known.sum())

    def estimate_is_new(self):
        """(angle bins seen,) whether the estimate shows the new range."""
        ranges = estimate(self.memory.recall(np.arange(NODES)), 0.1).ranges[:, ::2]
        return (ranges == codes([NEW])[0]).ravel()


def age_of(level, step_s=0.1):
    """Scans after which a level has long been full and takes no more than its due."""
    due = level.places_replaced(step_s if level.in_seconds else 1.0)
    return int(1.5 * level.window / due) + 2 * level.window


# N 2^(-t / h) of the old window is left: 0.5 after h; 10 % of the half-life are 0.467..0.537 here
WITHIN_TEN_PERCENT = (1 - 2 ** (-1 / 1.1), 1 - 2 ** (-1 / 0.9))


@pytest.mark.parametrize("seen", [1.0, 0.5, 0.25])
@pytest.mark.parametrize(
    ("window", "half_life"), [(7, 5.0), (10, 20.0), (25, 20.0), (50, 34.7), (100, 200.0), (25, 100.0)]
)
def test_half_the_window_is_new_after_the_half_life_in_scans(window, half_life, seen):
    level = Level("level", window, half_life)
    experiment = Experiment(level, seen)
    experiment.show_for_long(OLD, round(age_of(level) / max(seen, 0.5)))
    assert experiment.share_of_new() == pytest.approx(0.0, abs=1e-9)
    experiment.show(NEW, round(half_life))
    assert WITHIN_TEN_PERCENT[0] < experiment.share_of_new() < WITHIN_TEN_PERCENT[1]


@pytest.mark.parametrize("seen", [1.0, 0.5, 0.25, 0.1])
@pytest.mark.parametrize(("window", "half_life"), [(25, 20.0), (50, 34.7)])
def test_the_half_life_holds_while_an_angle_bin_seen_seldom_still_fills_its_window(window, half_life, seen):
    level = Level("level", window, half_life)
    experiment = Experiment(level, seen)
    experiment.show_for_long(OLD, age_of(level))
    experiment.show(NEW, round(half_life))
    assert WITHIN_TEN_PERCENT[0] < experiment.share_of_new() < WITHIN_TEN_PERCENT[1]


@pytest.mark.parametrize("seen", [1.0, 0.5, 0.25])
def test_a_young_memory_follows_the_majority_of_what_each_angle_bin_saw(seen):
    """57 old and 43 new of a hundred: an angle bin of which fewer scans saw anything has fewer, not newer ones."""
    experiment = Experiment(Level("long", 100, 200.0), seen)
    experiment.show(OLD, 57)
    experiment.show(NEW, 43)
    assert experiment.share_of_new() == pytest.approx(0.43, abs=0.01)


@pytest.mark.parametrize("seen", [1.0, 0.5])
@pytest.mark.parametrize(
    ("window", "half_life", "step_s"), [(25, 10.0, 0.1), (25, 30.0, 0.5), (50, 20.0, 0.2)]
)
def test_half_the_window_is_new_after_the_half_life_in_seconds(window, half_life, step_s, seen):
    level = Level("level", window, half_life, in_seconds=True)
    experiment = Experiment(level, seen, step_s)
    experiment.show_for_long(OLD, round(age_of(level, step_s) / seen))
    experiment.show(NEW, round(half_life / step_s))
    assert WITHIN_TEN_PERCENT[0] < experiment.share_of_new() < WITHIN_TEN_PERCENT[1]


@pytest.mark.parametrize(
    ("window", "half_life", "history"),  # history in half-lives
    [(25, 64.0, 3), (25, 64.0, 10), (100, 320.0, 3), (50, 640.0, 3)],
)
def test_a_robot_that_passes_by_forgets_by_the_time_it_observed(window, half_life, history):
    """15 scans at 0.2 s, then 5 min away: 10 s and 14 times 0.2 s of observed time in each pass."""
    experiment = Experiment(Level("level", window, half_life, in_seconds=True), 1.0, 0.2)

    def passes(value, count):
        for _ in range(count):
            experiment.show(value, 15)
            experiment.now += 1500

    passes(OLD, round(history * half_life / 12.8))
    passes(NEW, round(half_life / 12.8))
    assert WITHIN_TEN_PERCENT[0] < experiment.share_of_new() < WITHIN_TEN_PERCENT[1]


@pytest.mark.parametrize("seen", [1.0, 0.5])
@pytest.mark.parametrize(("window", "half_life"), [(25, 20.0), (50, 34.7)])
def test_the_estimate_changes_after_the_half_life(window, half_life, seen):
    """The median over angle bins of when the new range is reported."""
    level = Level("level", window, half_life)
    experiment = Experiment(level, seen)
    experiment.show_for_long(OLD, 3 * age_of(level))
    first = round(half_life * 0.7)
    experiment.show(NEW, first)
    changed = [experiment.estimate_is_new().mean()]
    while changed[-1] < 0.5 and len(changed) < half_life:
        experiment.show(NEW, 1)
        changed.append(experiment.estimate_is_new().mean())
    assert first + len(changed) - 1 == pytest.approx(half_life, rel=0.1)


def test_open_space_forgets_an_obstacle_like_any_surface():
    level = Level("mid", 25, 20.0)
    experiment = Experiment(level, 0.5)
    experiment.show(OLD, 200)
    experiment.show(np.inf, 12)
    assert (estimate(experiment.memory.recall(np.arange(NODES)), 0.1).ranges[:, ::2] == CLEAR).mean() < 0.1
    experiment.show(np.inf, 16)
    assert (estimate(experiment.memory.recall(np.arange(NODES)), 0.1).ranges[:, ::2] == CLEAR).mean() > 0.9


def test_a_young_memory_follows_the_majority():
    """30 scans of a level of 100 / 200obs: its law is plain majority until it is full."""
    experiment = Experiment(Level("long", 100, 200.0), 1.0)
    experiment.show(OLD, 14)
    experiment.show(NEW, 13)
    assert not experiment.estimate_is_new().any()
    experiment.show(NEW, 2)
    assert experiment.estimate_is_new().all()


def test_scans_that_do_not_see_an_angle_bin_leave_its_estimate():
    experiment = Experiment(Level("mid", 25, 20.0), 1.0)
    experiment.show(OLD, 100)
    experiment.show(np.nan, 400)
    found = estimate(experiment.memory.recall(np.arange(NODES)), 0.1)
    assert (found.ranges[:, ::2] == 3000).all()
    assert found.known[:, ::2].max() < 0.01  # but little of the window still speaks of it
    assert found.support[:, ::2] == pytest.approx(1.0)  # and nothing against it
