"""Which scans are set aside, and when they are believed after all."""

import numpy as np
import pytest

from tests.model.memories import codes
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.guard import Guard
from timemap_cli.model.observer import Observations

MINUTE_NS = 60 * 10**9
HELD, NEW, OTHER = np.full(12, 2.0), np.full(12, 4.0), np.full(12, 6.0)  # [m] three worlds


def estimate(ranges, node=0, samples=15):
    same = np.ones(12, np.float32)
    rest = np.full(12, samples, np.uint16), np.zeros(12, np.uint8), np.zeros(12, np.int64)
    return Estimate(node, "long", 0, np.float32(ranges), same, same, *rest)


ELSEWHERE = range(30, 38)  # nodes at which the robot is lost just before, unless a test says otherwise


def guard(max_contradiction=0.75, *, window=100, samples=15):
    made = Guard(max_contradiction, angle_bins=12, radius=10.0, window=window)
    made.expect([estimate(HELD, samples=samples), *(estimate(HELD, node) for node in ELSEWHERE)])
    return made


def observations(scans, *, every_ns=MINUTE_NS, start_ns=0, moving=True, nodes=None):
    n = len(scans)
    stamps_ns = start_ns + np.arange(n) * every_ns
    nodes = np.array([0] * n if nodes is None else nodes)
    return Observations(nodes, stamps_ns, codes(scans), np.full(n, moving), 0, 0, [])


def believed(judge, scans, *, before=OTHER, **options):
    """Which scans are believed of a robot that saw `before` at nodes elsewhere."""
    seen = observations(scans, **options)
    passing = [before] * len(ELSEWHERE)
    start_ns = int(seen.stamps_ns[0]) - len(passing)
    judge.believed(observations(passing, every_ns=1, start_ns=start_ns, nodes=[*ELSEWHERE]))
    return judge.believed(seen).tolist()


def test_what_contradicts_one_node_alone_is_a_changed_world_and_is_believed_at_once():
    assert believed(guard(), [NEW] * 3, before=HELD) == [True] * 3
    assert believed(guard(), [NEW] * 3, before=OTHER) == [False] * 3


def test_a_scan_that_contradicts_three_quarters_is_set_aside():
    nine, eight = (np.where(np.arange(12) < bins, NEW, HELD) for bins in (9, 8))
    assert believed(guard(), [HELD, nine, eight]) == [True, False, True]


def test_at_1_nothing_is_set_aside():
    assert all(believed(guard(1.0), [OTHER, NEW] * 20))


@pytest.mark.parametrize("samples", [0, 14])
def test_a_young_node_sets_nothing_aside(samples):
    assert all(believed(guard(samples=samples), [NEW, OTHER]))


def test_a_small_window_need_only_be_full():
    assert believed(guard(window=10, samples=10), [NEW]) == [False]
    assert believed(guard(window=10, samples=9), [NEW]) == [True]


def test_a_node_that_was_never_estimated_sets_nothing_aside():
    assert believed(guard(), [NEW, NEW], nodes=[0, 5]) == [False, True]


def test_a_view_too_small_to_judge_is_learnt():
    assert believed(guard(), [[4.0] + [np.nan] * 11]) == [True]


def test_a_changed_world_is_believed_after_15_scans_and_10_minutes():
    judge = guard()
    assert believed(judge, [NEW] * 20, every_ns=MINUTE_NS) == [False] * 14 + [True] * 6
    judge = guard()
    assert believed(judge, [NEW] * 41, every_ns=MINUTE_NS // 4) == [False] * 40 + [True]


def test_the_two_halves_of_a_changed_world_are_one():
    """A scanner with a narrow view sees one on the way there and the other on the way back."""
    there, back = (np.where((np.arange(12) < 6) == side, NEW, np.nan) for side in (True, False))
    assert believed(guard(), [there, back] * 10) == [False] * 14 + [True] * 6


def test_a_lost_robot_that_stands_is_never_believed():
    assert not any(believed(guard(), [NEW] * 600, moving=False))


def test_a_lost_robot_that_moves_contradicts_itself_and_is_never_believed():
    random = np.random.default_rng(0)
    assert not any(believed(guard(), random.uniform(2.5, 9, (600, 12))))


def test_scans_that_contradict_the_majority_of_those_set_aside_are_not_believed():
    scans = [NEW] * 16 + [OTHER] * 2 + [NEW] * 3
    assert believed(guard(), scans) == [False] * 14 + [True] * 2 + [False] * 3 + [True] * 2


def test_one_look_at_the_world_as_held_ends_the_doubt():
    judge = guard()
    assert believed(judge, [NEW] * 14 + [HELD] + [NEW] * 14) == [False] * 14 + [True] + [False] * 14


def test_a_look_that_cannot_judge_ends_no_doubt():
    narrow = [2.0] + [np.nan] * 11
    assert believed(guard(), [NEW] * 14 + [narrow, NEW]) == [False] * 14 + [True, True]


def test_every_node_has_its_own_doubt():
    judge = guard()
    judge.expect([estimate(HELD, node=1)])
    found = believed(judge, [NEW] * 30, nodes=[0, 1] * 15)
    assert found == [False] * 28 + [True] * 2


def test_a_doubt_ends_when_the_slow_level_has_learnt_it():
    judge = guard()
    believed(judge, [NEW] * 20)
    judge.expect([estimate(NEW)])
    assert believed(judge, [NEW, HELD, HELD]) == [True, False, False]
    judge.expect([estimate(HELD)])
    assert believed(judge, [NEW]) == [False]


def test_a_clock_that_begins_anew_does_not_hold_a_doubt_for_ever():
    judge = guard()
    believed(judge, [NEW] * 14, start_ns=10**18)
    assert believed(judge, [NEW]) == [True]


@pytest.mark.parametrize("size", [1, 7])
def test_the_guard_remembers_from_block_to_block(size):
    random = np.random.default_rng(1)
    worlds = np.stack((HELD, NEW, OTHER))
    scans = worlds[random.choice(3, 400, p=(0.03, 0.9, 0.07))]
    nodes, moving = random.integers(0, 2, 400), random.random(400) < 0.7

    def seen(rows):
        part = scans[rows]
        stamps_ns = np.arange(400)[rows] * MINUTE_NS
        return Observations(nodes[rows], stamps_ns, codes(part), moving[rows], 0, 0, [])

    one, other = guard(), guard()
    for judge in (one, other):
        believed(judge, [NEW], start_ns=-MINUTE_NS)
    whole = one.believed(seen(slice(None))).tolist()
    parts = [other.believed(seen(slice(i, i + size))) for i in range(0, 400, size)]
    assert np.concatenate(parts).tolist() == whole
    assert 50 < sum(whole) < 350


def test_nothing_is_kept_of_a_node_that_was_never_estimated_however_much_room_there_is():
    judge = Guard(0.75, angle_bins=12, radius=10.0, window=100)
    judge.expect([estimate(HELD), estimate(HELD, node=9)])
    assert [judge.kept(node) == {} for node in (0, 1, 8, 9, 10)] == [False, True, True, False, True]


def test_what_was_kept_goes_on():
    """A robot that is lost elsewhere and comes to a node: who did not see the way there knows nothing of it."""
    one, other, unknowing = guard(), guard(), guard()
    believed(one, [HELD])
    nodes = [0, *ELSEWHERE]
    for node in nodes:
        other.restore(node, one.kept(node))
        unknowing.restore(node, one.kept(node))
    other.restore_of_all(one.kept_of_all())
    later = observations([NEW] * 3, start_ns=10**9)
    assert one.believed(later).tolist() == other.believed(later).tolist() == [False] * 3
    assert unknowing.believed(later).tolist() == [True] * 3
