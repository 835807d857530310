"""Which scans a level takes."""

import math

import numpy as np
import pytest

from timemap_cli.model import chance
from timemap_cli.model.draw import Draw, Groups
from timemap_cli.model.levels import LONGEST_STEP, Level
from timemap_cli.model.nodes import Node

SECOND = 10**9


def drawn(level, scans, *, step_s=0.1, nodes=None, block=None, keys=None, stamps=None):
    """Which of so many scans are taken, in their order."""
    nodes = np.zeros(scans, np.int64) if nodes is None else nodes
    stamps = (np.arange(scans) * step_s * SECOND).astype(np.int64) if stamps is None else stamps
    count = int(nodes.max(initial=0)) + 1
    keys = (
        np.array([chance.key(0, Node(n, 0), level.name) for n in range(count)], np.uint64)
        if keys is None
        else keys
    )
    draw = Draw(level)
    draw.add_nodes(count)
    taken = np.zeros(scans, bool)
    for start in range(0, scans, block or max(1, scans)):
        part = slice(start, start + (block or scans))
        groups = Groups.of(nodes[part])
        taken[part][groups.order] = draw.taken(groups, stamps[part][groups.order], keys)
    return taken


def half_life_for(window, probability):
    """[scans] of a level that takes a scan with this probability."""
    return math.log(2) / probability / math.log(window / (window - 1))


def test_the_share_one_scan_replaces_follows_from_the_half_life():
    """After a half-life n = q H scans were taken, and (1 - 1/N)^n of the window is left: a half."""
    for window, half_life, share in ((7, 5.0, 0.8993), (25, 20.0, 0.8490), (100, 200.0, 0.3448)):
        level = Level("level", window, half_life)
        assert level.places_replaced(1.0) == pytest.approx(share, abs=1e-4)
        assert (1 - 1 / window) ** (level.places_replaced(1.0) * half_life) == pytest.approx(0.5)


def test_a_half_life_that_the_window_cannot_have_is_told_as_a_shortfall():
    """100 places with a half-life of 30 s at one scan a second: 2.30 places are due, one can be filled."""
    draw = Draw(Level("long", 100, 30.0, in_seconds=True))
    draw.add_nodes(1)
    stamps_ns = np.arange(1, 501) * 1_000_000_000
    draw.taken(Groups.of(np.zeros(500, np.int64)), stamps_ns, np.array([7], np.uint64))
    assert draw.shortfall == pytest.approx(1 - 1 / 2.299, abs=1e-3)


def test_a_half_life_that_the_window_can_have_has_no_shortfall():
    draw = Draw(Level("long", 100, 100.0, in_seconds=True))
    draw.add_nodes(1)
    stamps_ns = np.arange(1, 501) * 1_000_000_000
    draw.taken(Groups.of(np.zeros(500, np.int64)), stamps_ns, np.array([7], np.uint64))
    assert draw.shortfall == 0


def test_stamps_that_begin_anew_stand_for_no_time():
    draw = Draw(Level("mid", 25, 30.0, in_seconds=True))
    draw.add_nodes(1)
    groups, keys = Groups.of(np.zeros(100, np.int64)), np.array([7], np.uint64)
    stamps_ns = np.arange(1, 101) * 1_000_000_000
    draw.taken(groups, stamps_ns, keys)
    assert draw.taken(groups, stamps_ns, keys).sum() > 20


def test_a_young_memory_takes_every_scan_until_its_window_is_full():
    taken = drawn(Level("long", 100, 200.0), 100)
    assert taken.all()


def test_a_young_memory_takes_window_over_age_until_that_is_its_due():
    """N = 100, q = 0.346: N / t falls to q at t = 289; 100 (1 + ln(289 / 100)) = 206 are taken until then."""
    taken = drawn(Level("long", 100, 200.0), 289)
    assert taken.sum() == pytest.approx(206, abs=2)


@pytest.mark.parametrize("probability", [0.9, 0.5, 0.346, 0.25, 0.1, 0.03])
def test_an_old_memory_takes_exactly_its_share(probability):
    window = 10
    level = Level("level", window, half_life_for(window, probability))
    young = math.ceil(window / probability)
    taken = drawn(level, young + 20_000)[young:]
    assert taken.sum() == pytest.approx(20_000 * probability, abs=2)


@pytest.mark.parametrize("turn", [2.3, 4.6, 10.3])
def test_one_scan_is_taken_in_every_turn_at_a_random_place(turn):
    """Turns of 1 / q scans; a coin for each scan would leave some without any and others with several."""
    window = 8
    level = Level("level", window, half_life_for(window, 1 / turn))
    taken = drawn(level, math.ceil(3000 * turn))[math.ceil(2 * window * turn) :]
    gaps = np.diff(np.flatnonzero(taken))
    assert gaps.max() <= 2 * turn
    # uniform places in turns: turn^2 / 6; always the same place: 0; a coin: turn^2 - turn
    assert 0.6 < gaps.var() / (turn * turn / 6) < 1.4


def test_the_decision_does_not_depend_on_blocks():
    level = Level("level", 10, 33.0)
    nodes = np.random.default_rng(1).integers(0, 4, 700)
    whole = drawn(level, 700, nodes=nodes)
    for block in (1, 7, 64, 699):
        np.testing.assert_array_equal(drawn(level, 700, nodes=nodes, block=block), whole)


def test_every_node_draws_for_itself():
    level = Level("level", 10, 70.0)
    alone = drawn(level, 500)
    nodes = np.repeat([0, 1], 500).reshape(2, 500).T.ravel()  # in turns
    together = drawn(level, 1000, nodes=nodes)
    np.testing.assert_array_equal(together[::2], alone)
    assert (together[1::2] != alone).any()


def test_in_seconds_the_rate_of_scans_does_not_matter():
    level = Level(
        "level", 10, 60.0, in_seconds=True
    )  # a tenth of the window each 9.12 s: q = 0.1096 a second
    per_second = {}
    for rate in (5, 10, 40):
        taken = drawn(level, 600 * rate, step_s=1 / rate)
        per_second[rate] = taken[300 * rate :].sum() / 300
    for share in per_second.values():
        assert share == pytest.approx(0.1096, abs=0.003)


def test_a_memory_is_young_until_all_that_was_due_would_have_filled_its_window():
    """Visits of ten scans: 0.329 + 9 * 0.0033 turns are due for each, 10 for 28 visits. From then on so many are taken,
    though N / t = 10 / 300 is still ten times what is due for a scan of a visit.
    """
    level = Level("level", 10, 200.0, in_seconds=True)
    steps = np.where(np.arange(800) % 10 == 0, 3600.0, 0.1)
    taken = drawn(level, 800, stamps=np.cumsum(steps * SECOND).astype(np.int64))
    assert taken[:280].sum() == pytest.approx(10 * (1 + math.log(280 / 10)), abs=2)
    assert taken[290:790].sum() == pytest.approx(50 * 0.3585, abs=2)


@pytest.mark.parametrize("block", [1, 7, 64])
def test_in_seconds_the_decision_does_not_depend_on_blocks(block):
    level, random = Level("level", 10, 33.0, in_seconds=True), np.random.default_rng(1)
    nodes, steps = random.integers(0, 4, 700), random.choice([0.1, 0.7, 60.0], 700)
    stamps = np.cumsum(steps * SECOND).astype(np.int64)
    whole = drawn(level, 700, nodes=nodes, stamps=stamps)
    np.testing.assert_array_equal(drawn(level, 700, nodes=nodes, stamps=stamps, block=block), whole)


def test_a_long_absence_counts_for_ten_seconds():
    """Visits of ten scans, a week apart: 0.329 + 9 * 0.0033 of a turn each; a week for a week would be 1."""
    level = Level("level", 10, 200.0, in_seconds=True)
    steps = np.where(np.arange(6000) % 10 == 0, 7 * 86400.0, 0.1)
    taken = drawn(level, 6000, stamps=np.cumsum(steps * SECOND).astype(np.int64))
    assert LONGEST_STEP == 10.0
    assert taken[3000:].sum() == pytest.approx(300 * 0.3585, abs=2)


def test_scans_with_one_stamp_take_no_time():
    level = Level("level", 2, 10.0, in_seconds=True)
    stamps = np.zeros(500, np.int64)
    taken = drawn(level, 500, stamps=stamps)
    assert taken[:2].all()
    assert taken.sum() == pytest.approx(2 * (1 + math.log(500 / 2)), abs=2)  # only what a young memory takes


def test_no_scans_draw_nothing():
    assert drawn(Level("level", 10, 20.0), 0).shape == (0,)
