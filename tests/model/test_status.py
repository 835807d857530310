"""What an estimate says its angle bins rest on, in scenes small enough to be judged by hand."""

import numpy as np
import pytest

from tests.model.memories import EVERY_SCAN, learnt, recalled
from timemap_cli.model.estimator import estimate
from timemap_cli.model.status import Status

NAN, INF = np.nan, np.inf
BINS = 60


def statuses(scans, window=100, half_life=EVERY_SCAN, seed=0):
    """Status (angle_bins,) of one node after scans (n, angle_bins) [m]."""
    return [Status(code) for code in found(scans, window, half_life, seed).status[0]]


def found(scans, window=100, half_life=EVERY_SCAN, seed=0):
    return estimate(recalled(learnt(scans, window, half_life, seed=seed)), 0.1)


def noisy(scene, scans, seed):
    random = np.random.default_rng(seed)
    return np.round(np.asarray(scene, float) + random.normal(0, 0.01, (scans, len(scene))), 3)


def test_what_was_never_observed_is_unknown_and_what_was_observed_is_measured():
    assert statuses(np.zeros((0, 3))) == [Status.UNKNOWN] * 3
    assert statuses([[2.0, NAN, INF]]) == [Status.MEASURED, Status.UNKNOWN, Status.MEASURED]
    assert statuses([[2.0, NAN, INF]] * 40, 10) == [Status.MEASURED, Status.UNKNOWN, Status.MEASURED]


@pytest.mark.parametrize("other", [5.0, INF])
@pytest.mark.parametrize("times", [1, 5, 50])
def test_two_equally_strong_states_are_contested(times, other):
    assert statuses([[2.0] * 3] * times + [[other] * 3] * times) == [Status.CONTESTED] * 3


@pytest.mark.parametrize(
    ("more", "fewer", "status"),
    [
        (2, 1, Status.CONTESTED),  # 1 ahead of 3: below the root of 3
        (3, 1, Status.MEASURED),  # 2 ahead of 4: it is the root of 4
        (4, 3, Status.CONTESTED),  # a short window of 7
        (5, 2, Status.MEASURED),
        (14, 10, Status.CONTESTED),
        (15, 10, Status.MEASURED),  # 5 ahead of 25
        (54, 46, Status.CONTESTED),
        (55, 45, Status.MEASURED),  # 10 ahead of 100
        (99, 1, Status.MEASURED),
    ],
)
def test_a_lead_of_less_than_one_standard_deviation_is_contested(more, fewer, status):
    assert statuses([[2.0] * 3] * more + [[5.0] * 3] * fewer) == [status] * 3


def test_the_best_rival_counts_and_not_all_that_is_against():
    """6 to 2, 2 and 2: 4 ahead of one of them, which is more than the root of 8."""
    scans = [[value] * 3 for value in (2.0, 3.0, 4.0, 5.0) for _ in range(6 if value == 2.0 else 2)]
    assert statuses(scans) == [Status.MEASURED] * 3


@pytest.mark.parametrize(
    ("window", "last"), [(7, 4), (25, 17), (100, 69)]
)  # the half of a window: so many times ln 2
def test_what_was_not_observed_for_half_a_window_of_scans_is_concluded(window, last):
    seen, unseen = [[2.0, 3.0, 3.0]], [[NAN, 3.0, 3.0]]
    others = [Status.MEASURED] * 2
    assert statuses(seen * window + unseen * last, window) == [Status.MEASURED, *others]
    assert statuses(seen * window + unseen * (last + 1), window) == [Status.CONCLUDED, *others]
    assert statuses(seen * window + unseen * (last + 1) + seen, window) == [Status.MEASURED, *others]


def test_a_tie_of_what_was_not_observed_lately_is_no_contest():
    scans = [[2.0, 3.0, 3.0]] * 12 + [[5.0, 3.0, 3.0]] * 12 + [[NAN, 3.0, 3.0]] * 30
    assert statuses(scans, 25) == [Status.CONCLUDED, Status.MEASURED, Status.MEASURED]


def test_a_state_that_lost_its_last_look_to_another_is_concluded():
    """The wall's samples are old, and the one look since then found something else: not measured like that."""
    scans = [[2.0, 3.0, 3.0]] * 25 + [[NAN, 3.0, 3.0]] * 20 + [[5.0, 3.0, 3.0]]
    result = found(scans, 25)
    assert result.ranges[0, 0] == 2000
    assert result.status[0, 0] == Status.CONCLUDED


@pytest.mark.parametrize("visible", ["first half", "last half"])
@pytest.mark.parametrize(("window", "half_life"), [(25, 20.0), (50, 34.7)])
def test_the_hidden_part_of_an_object_is_concluded_from_its_visible_part(window, half_life, visible):
    """The paper's Fig. 7: an object was now here, now there; it goes there and only a part of it is in view."""
    here, there = np.full(BINS, 3.0), np.full(BINS, 3.0)
    here[20:40], there[20:40] = 1.2, 2.2
    old = np.vstack([noisy(here, 30, 1), noisy(there, 30, 2), noisy(here, 35, 3)])
    part = noisy(there, round(2 * half_life), 4)
    hidden = slice(30, 40) if visible == "first half" else slice(20, 30)
    part[:, hidden] = NAN
    result = found(np.vstack((old, part)), window, half_life)
    assert (np.abs(result.ranges[0, 20:40].astype(int) - 2200) < 60).all()
    assert (result.status[0, hidden] == Status.CONCLUDED).all()
    assert (np.delete(result.status[0], np.arange(60)[hidden]) == Status.MEASURED).all()


def test_an_angle_bin_shown_against_its_own_majority_is_concluded():
    """Its neighbours went on to the new place and it was seen there lately, but too seldom to say so itself."""
    old, new = np.full(BINS, 3.0), np.full(BINS, 3.0)
    old[20:30], new[20:30] = 1.2, 2.2
    rarely = noisy(new, 40, 1)
    rarely[:-4, 25] = NAN
    result = found(np.vstack((noisy(old, 20, 2), rarely)))
    assert abs(int(result.ranges[0, 25]) - 2200) < 60
    assert result.support[0, 25] == pytest.approx(4 / 24)  # scans that saw it, and said so
    assert result.status[0, 25] == Status.CONCLUDED
    assert (np.delete(result.status[0], 25) == Status.MEASURED).all()


def test_no_nodes_have_no_statuses():
    result = estimate(learnt(np.full((2, 12), 1.0), 5).recall(np.zeros(0, np.int64)), 0.1)
    assert result.status.shape == (0, 12)
