"""What one level keeps of the scans it takes: two bounded sets per angle bin, samples and pairs."""

from collections import Counter

import numpy as np
import pytest

from tests.model.memories import EVERY_SCAN, NODE, codes, learnt, recalled
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

NAN, INF = np.nan, np.inf


def samples(memory, angle_bin=0, node=0):
    """Remembered ranges [mm] of one angle bin, ascending."""
    kept = memory.samples[node, angle_bin]
    return sorted(kept[kept < UNSEEN].tolist())


def pairs(memory, angle_bin=0, node=0):
    left, right = memory.left[node, angle_bin], memory.right[node, angle_bin]
    return sorted(zip(left[left < UNSEEN].tolist(), right[right < UNSEEN].tolist(), strict=True))


def test_an_empty_memory_keeps_nothing():
    memory = recalled(learnt(np.zeros((0, 12)), 5))
    assert (memory.samples == UNSEEN).all()
    assert (memory.left == UNSEEN).all()
    assert memory.taken == [0]
    assert not memory.n_samples.any()


def test_a_filling_memory_keeps_every_scan():
    memory = recalled(learnt([[1, 2, 3], [1.5, 2.5, 3.5]], 5))
    assert [samples(memory, a) for a in range(3)] == [[1000, 1500], [2000, 2500], [3000, 3500]]
    assert pairs(memory, 0) == [(1000, 2000), (1500, 2500)]
    assert memory.n_samples.tolist() == [[2, 2, 2]]


def test_the_last_angle_bin_pairs_with_the_first():
    assert pairs(recalled(learnt([[1, 2, 3]], 5)), 2) == [(3000, 1000)]


def test_no_pair_across_an_unobserved_angle_bin():
    memory = recalled(learnt([[1, NAN, 3, 4]], 5))
    assert [pairs(memory, a) for a in range(4)] == [[], [], [(3000, 4000)], [(4000, 1000)]]


def test_no_pair_across_time():
    memory = recalled(learnt([[1, NAN, 3, NAN], [NAN, 2, NAN, 4]], 5))
    assert [pairs(memory, a) for a in range(4)] == [[]] * 4


def test_clear_is_remembered_and_pairs_like_a_range():
    memory = recalled(learnt([[INF, 2, NAN]], 5))
    assert samples(memory, 0) == [CLEAR]
    assert pairs(memory, 0) == [(CLEAR, 2000)]
    assert samples(memory, 2) == []


def test_both_ends_of_a_pair_are_of_the_same_scan_for_ever():
    scans = np.arange(1, 301)[:, None] * 0.01 + np.array([0.0, 3.0, 6.0])
    memory = recalled(learnt(scans, 7))
    for a, apart in enumerate((3000, 3000, -6000)):
        assert all(right - left == apart for left, right in pairs(memory, a))
        assert len(pairs(memory, a)) == 7


@pytest.mark.parametrize("window", [2, 5, 25])
def test_a_full_memory_exchanges_one_sample_and_one_pair_for_a_new_one(window):
    """One at a time: a measurement drags nothing else along."""
    scans = np.arange(1, 4 * window)[:, None] * 0.01 + np.array([0.0, 3.0, 6.0])
    before = recalled(learnt(scans, window))
    after = recalled(learnt(np.vstack((scans, [9, NAN, 9.5])), window))
    assert len(samples(after, 0)) == len(samples(after, 2)) == window
    assert sum((Counter(samples(before, 0)) - Counter(samples(after, 0))).values()) == 1
    assert samples(after, 0)[-1] == 9000
    assert samples(after, 1) == samples(before, 1)
    assert pairs(after, 0) == pairs(before, 0)  # no new pair: none evicted, though a new sample came
    assert pairs(after, 1) == pairs(before, 1)
    assert sum((Counter(pairs(before, 2)) - Counter(pairs(after, 2))).values()) == 1
    assert (9500, 9000) in pairs(after, 2)


def test_samples_without_neighbours_never_evict_a_pair():
    """Otherwise the hidden part of an object could not follow its visible part (the paper's Fig. 7)."""
    whole = np.tile([1.0, 2.0, 3.0, 4.0], (30, 1))
    alone = np.tile([9.0, NAN, 9.0, NAN], (500, 1))
    memory = recalled(learnt(np.vstack((whole, alone)), 10))
    assert samples(memory, 0) == [9000] * 10
    assert [pairs(memory, a) for a in range(4)] == [
        [(1000, 2000)] * 10,
        [(2000, 3000)] * 10,
        [(3000, 4000)] * 10,
        [(4000, 1000)] * 10,
    ]


def test_every_place_is_as_likely_to_be_replaced():
    """After the window is full, one more scan: which sample went, over 3600 angle bins."""
    window = 6
    scans = np.repeat(np.arange(1, window + 2)[:, None] * 0.1, 3600, axis=1)
    memory = recalled(learnt(scans, window))
    replaced = Counter(memory.samples[0].argmax(axis=1).tolist())
    assert min(replaced[place] for place in range(window)) > 3600 / window * 0.85
    pair_replaced = Counter(memory.left[0].argmax(axis=1).tolist())
    assert min(pair_replaced[place] for place in range(window)) > 3600 / window * 0.85
    same = (memory.samples[0].argmax(axis=1) == memory.left[0].argmax(axis=1)).mean()
    assert same == pytest.approx(1 / window, abs=0.03)  # samples and pairs are evicted apart


def test_neighbouring_angle_bins_are_evicted_apart():
    scans = np.repeat(np.arange(1, 8)[:, None] * 0.1, 3600, axis=1)
    place = recalled(learnt(scans, 6)).samples[0].argmax(axis=1)
    assert (place == np.roll(place, 1)).mean() == pytest.approx(1 / 6, abs=0.03)


def test_an_old_sample_goes_with_the_rate_of_its_window():
    """After n more scans (1 - 1 / N)^n of the old ones are left."""
    window, more = 20, 15
    scans = np.vstack((np.full((window, 3600), 1.0), np.full((more, 3600), 2.0)))
    left = (recalled(learnt(scans, window)).samples[0] == 1000).mean()
    assert left == pytest.approx((1 - 1 / window) ** more, abs=0.01)


def test_what_a_full_level_does_not_evict_ages():
    """By a scan that did not see the angle bin, and by one that took an empty place there."""
    scans = [[1, 1], [1, NAN], [1, INF], [1, NAN], [1, NAN], [1, 2], [1, NAN], [1, 3], [1, 4], [1, NAN]]
    memory = recalled(learnt(scans, 4))
    assert memory.ages[0, 0, :4].tolist() == [0, 0, 0, 0]  # however often it evicted or filled
    ages = dict(zip(memory.samples[0, 1].tolist(), memory.ages[0, 1].tolist(), strict=True))
    assert {value: ages[value] for value in ages if value in (3000, 4000)} in ({3000: 1, 4000: 1}, {4000: 1})
    assert ages.get(1000, 5) == ages.get(CLEAR, 5) == 5  # scans 5, 6, 7, 8 and 10; scan 9 evicted
    assert memory.taken.tolist() == [10]


def test_nothing_ages_before_a_level_has_taken_a_window_of_scans():
    """Until then it forgets nothing anywhere, so an angle bin seen seldom must not either."""
    scans = [[1, 1]] + [[1, NAN]] * 2 + [[1, 2]]
    assert recalled(learnt(scans, 4)).ages[0, 1, :2].tolist() == [0, 0]
    assert recalled(learnt([*scans, [1, NAN]], 4)).ages[0, 1, :2].tolist() == [1, 1]


def test_an_angle_bin_was_last_seen_in_the_newest_scan_that_shows_anything_there():
    memory = Memory(Level("mid", 2, EVERY_SCAN), 4, 0)
    memory.add_nodes([NODE])
    scans = codes([[1, 1, NAN, NAN], [1, NAN, INF, NAN], [NAN, NAN, NAN, NAN], [1, NAN, NAN, NAN]])
    memory.remember(np.zeros(4, np.int64), np.array([10, 20, 30, 40]), scans)
    assert recalled(memory).last_seen_ns.tolist() == [[40, 10, 20, 0]]
    assert recalled(memory).stamps_ns.tolist() == [40]


def test_a_scan_that_the_level_did_not_take_is_not_when_an_angle_bin_was_last_seen():
    memory = Memory(Level("long", 2, 1e9), 4, 0)
    memory.add_nodes([NODE])
    memory.remember(
        np.zeros(2, np.int64), np.array([10, 20]), codes(np.full((2, 4), 1.0))
    )  # fills the window
    later = np.arange(30, 60)
    for stamp in later:  # of which a young memory takes 2 / t
        memory.remember(np.zeros(1, np.int64), np.array([stamp]), codes(np.full((1, 4), 1.0)))
        found = recalled(memory)
        assert (found.last_seen_ns == found.stamps_ns).all()
    assert recalled(memory).taken[0] < 2 + len(later)
    assert recalled(memory).last_seen_ns[0, 0] < later[-1]


def test_a_scan_stands_for_one_sample_however_many_beams_fell_into_the_angle_bin():
    memory = recalled(learnt(np.full((3, 12), 2.0), 50))
    assert memory.n_samples.tolist() == [[3] * 12]


def test_nodes_remember_apart():
    memory = Memory(Level("mid", 5, EVERY_SCAN), 3, 0)
    memory.add_nodes([Node(0, 0), Node(1, 0), Node(2, 0)])
    changed = memory.remember(
        np.array([2, 0, 2]), np.array([10, 20, 30]), codes([[1, 1, 1], [2, 2, NAN], [3, 3, 3]])
    )
    assert changed.tolist() == [0, 2]
    found = memory.recall(np.array([0, 1, 2]))
    assert [samples(found, 0, node) for node in range(3)] == [[2000], [], [1000, 3000]]
    assert found.stamps_ns.tolist() == [20, 0, 30]
    assert found.taken.tolist() == [1, 0, 2]


def test_a_memory_takes_new_nodes_at_any_time():
    memory = Memory(Level("mid", 3, EVERY_SCAN), 4, 0)
    nodes = []
    for number in range(30):
        nodes.append(Node(number, 0))
        memory.add_nodes(nodes)
        memory.remember(np.array([number]), np.array([number]), codes([[number + 1] * 4]))
    found = memory.recall(np.arange(30))
    assert [samples(found, 2, node) for node in range(30)] == [[1000 * (node + 1)] for node in range(30)]


def test_a_block_in_which_nothing_is_taken_changes_nothing():
    memory = Memory(Level("long", 2, 1e9), 4, 0)
    memory.add_nodes([NODE])
    scans = codes(np.full((2000, 4), 1.0))
    memory.remember(np.zeros(2000, np.int64), np.arange(2000), scans)
    before = recalled(memory)
    assert memory.remember(np.zeros(0, np.int64), np.zeros(0, np.int64), scans[:0]).tolist() == []
    assert recalled(memory).taken == before.taken


def test_a_recalled_memory_is_a_copy():
    memory = learnt([[1, 2, 3]], 2)
    before = recalled(memory)
    memory.remember(np.zeros(3, np.int64), np.arange(3), codes(np.full((3, 3), 9.0)))
    assert samples(before, 0) == [1000]


def test_what_is_kept_of_all_nodes_is_the_same_to_the_bit_however_scans_come_in_blocks():
    stamps_ns, ranges = np.arange(300) * 137_000_011, np.full((300, 4), 1000, np.uint16)
    kept = []
    for cuts in ([], [150], [7, 8, 100], range(1, 300)):
        memory = Memory(Level("slow", 7, 0.9, in_seconds=True), 4, 0)
        memory.add_nodes([NODE])
        for part in np.split(np.arange(300), cuts):
            memory.remember(np.zeros(len(part), np.int64), stamps_ns[part], ranges[part])
        kept.append(memory.kept_of_all())
    assert all(one == kept[0] for one in kept)
