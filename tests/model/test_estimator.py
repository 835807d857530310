"""What the estimate says of scenes that change."""

import numpy as np
import pytest

from tests.model.memories import EVERY_SCAN, codes, learnt, recalled
from timemap_cli.model.estimator import estimate
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

NAN, INF = np.nan, np.inf
BINS = 60


def estimated(scans, window=25, half_life=EVERY_SCAN, seed=0):
    """Ranges [mm] (angle_bins,) of one node after scans (n, angle_bins) [m]."""
    return found(scans, window, half_life, seed).ranges[0]


def found(scans, window=25, half_life=EVERY_SCAN, seed=0):
    return estimate(recalled(learnt(scans, window, half_life, seed=seed)), 0.1)


def noisy(scene, scans, seed=1, noise=0.01):
    random = np.random.default_rng(seed)
    return np.round(np.asarray(scene, float) + random.normal(0, noise, (scans, len(scene))), 3)


def test_what_was_never_observed_is_unknown():
    assert (estimated(np.zeros((0, 12))) == UNSEEN).all()
    scans = np.full((3, 12), 2.0)
    scans[:, 4:7] = NAN
    assert estimated(scans).tolist() == [2000] * 4 + [UNSEEN] * 3 + [2000] * 5


def test_an_unobserved_angle_bin_lets_every_neighbour_be_what_it_likes():
    """No weight in or out: on either side of it other scenes may win."""
    scans = np.full((12, 6), NAN)
    scans[:, 0] = [1.0] * 8 + [3.0] * 4
    scans[:, 2] = [1.0] * 4 + [3.0] * 8
    assert estimated(scans).tolist() == [1000, UNSEEN, 3000, UNSEEN, UNSEEN, UNSEEN]


def test_the_reported_range_is_the_lower_median_of_the_chosen_surface():
    ranges = [2.03, 2.0, 2.01, 2.02, 5.0, 5.01, 1.0]
    scans = np.array(ranges)[:, None] * np.ones(3)
    assert estimated(scans).tolist() == [2010] * 3  # of 2.00 2.01 2.02 2.03; over all seven it were 2.02


def test_clear_is_estimated_and_takes_part_in_the_vote():
    scans = np.array([[2.0] * 3] * 4 + [[INF] * 3] * 5)
    assert (estimated(scans) == CLEAR).all()
    assert (estimated(scans[:-2]) == 2000).all()


def test_one_sample_and_one_angle_bin_are_enough():
    scans = np.full((1, 12), NAN)
    scans[0, 11] = 3.333
    assert estimated(scans).tolist() == [UNSEEN] * 11 + [3333]


def test_an_object_is_never_half_in_its_old_and_half_in_its_new_place():
    """Angle by angle the votes differ, 52 to 48; over the object one scene must win."""
    wall, box = np.full(BINS, 3.0), np.full(BINS, 3.0)
    wall[20:30] = 2.0  # here it stood
    box[20:30] = 1.5  # and here it stands now
    for seed in range(8):
        random = np.random.default_rng(seed)
        scans = np.vstack((noisy(wall, 60, seed), noisy(box, 17, seed + 100)))
        scans[:, 20:30][random.random((len(scans), 10)) < 0.1] = NAN
        ranges = estimated(scans, 25, seed=seed)[20:30]
        assert len({value < 1750 for value in ranges.tolist()}) == 1
        alone = scans.copy()
        alone[:, 1::2] = NAN  # without neighbours each angle bin decides alone
        mixed = {value < 1750 for value in estimated(alone, 25, seed=seed)[20:30:2].tolist()}
        if len(mixed) == 2:
            break
    else:
        pytest.fail("the scene never was a close call")


@pytest.mark.parametrize("visible", ["first half", "last half"])
@pytest.mark.parametrize(("window", "half_life"), [(25, 20.0), (50, 34.7)])
def test_the_hidden_part_of_an_object_follows_its_visible_part(window, half_life, visible):
    """The paper's Fig. 7: an object was now here, now there; it goes there and only a part of it is in view."""
    here, there = np.full(BINS, 3.0), np.full(BINS, 3.0)
    here[20:40], there[20:40] = 1.2, 2.2
    old = np.vstack([noisy(here, 30, 1), noisy(there, 30, 2), noisy(here, 35, 3)])
    part = noisy(there, round(2 * half_life), 4)
    hidden = slice(30, 40) if visible == "first half" else slice(20, 30)
    part[:, hidden] = NAN
    before = estimated(old, window, half_life)
    assert (np.abs(before[20:40].astype(int) - 1200) < 60).all()
    after = estimated(np.vstack((old, part)), window, half_life)
    assert (np.abs(after[20:40].astype(int) - 2200) < 60).all()
    assert (np.abs(np.delete(after, np.arange(20, 40)).astype(int) - 3000) < 60).all()


def test_a_hidden_part_without_any_pair_stays_as_it_was():
    """Nothing was ever seen of it together with the new place: no definition can know."""
    here = np.full(BINS, 3.0)
    here[20:40] = 1.2
    part = np.full((80, BINS), NAN)
    part[:, 20:30] = 2.2
    after = estimated(np.vstack((noisy(here, 60), part)), 25, 20.0)
    assert (np.abs(after[30:40].astype(int) - 1200) < 60).all()


def test_the_first_and_the_last_angle_bin_are_neighbours():
    """The hidden part lies on the other side of bearing 0."""
    here, there = np.full(BINS, 3.0), np.full(BINS, 3.0)
    for scene, value in ((here, 1.2), (there, 2.2)):
        scene[:8] = scene[-8:] = value
    old = np.vstack([noisy(here, 30, 1), noisy(there, 30, 2), noisy(here, 35, 3)])
    part = noisy(there, 80, 4)
    part[:, :8] = NAN
    after = estimated(np.vstack((old, part)), 25, 20.0).astype(int)
    assert (np.abs(after[:8] - 2200) < 60).all()
    assert (np.abs(after[-8:] - 2200) < 60).all()


def test_a_border_of_the_view_that_never_moves_is_no_border_of_the_estimate():
    """Half the circle in view all the time, the other half for the first scans only."""
    scans = noisy(np.full(BINS, 3.0), 100)
    scans[30:, 30:] = NAN
    assert (np.abs(estimated(scans).astype(int) - 3000) < 60).all()


def test_support_is_a_share_of_what_is_known_and_that_a_share_of_the_window():
    scans = np.array([[2.0, 2.0, NAN]] * 6 + [[5.0, NAN, NAN]] * 2)
    result = found(scans, window=10)
    assert result.support[0] == pytest.approx([6 / 8, 1, 0], abs=1e-5)
    assert result.known[0] == pytest.approx([1, 6 / 8, 0], abs=1e-5)
    assert result.samples[0].tolist() == [8, 6, 0]


def test_of_what_a_full_level_no_longer_sees_less_is_known_and_nothing_is_contradicted():
    """The window of 10 is full after ten scans; of two more that do not see the angle bin each takes a tenth."""
    result = found(np.array([[2.0, 2.0, NAN]] * 10 + [[2.0, NAN, NAN]] * 2), window=10)
    assert result.known[0] == pytest.approx([1, 0.9**2, 0], abs=1e-5)
    assert result.support[0] == pytest.approx([1, 1, 0], abs=1e-5)


def test_between_equal_shares_a_young_level_keeps_what_it_saw_first():
    """The nearest would win at two scans and lose at three."""
    far_first = [[4.0, 4.0, 4.0], [2.0, 2.0, 2.0], [4.0, 4.0, 4.0]]
    for scans in (2, 3):
        assert found(np.array(far_first[:scans]), window=10).ranges[0].tolist() == [4000] * 3
    assert found(6.0 - np.array(far_first[:2]), window=10).ranges[0].tolist() == [2000] * 3


def test_samples_that_a_full_level_did_not_renew_lose_their_weight():
    scans = np.array([[2.0, 2.0, NAN]] * 6 + [[2.0, NAN, NAN]] * 6)
    assert found(scans, window=10).known[0] == pytest.approx([1, 6 / 10 * 0.9**2, 0], abs=1e-5)


def test_a_full_window_of_one_surface_has_all_the_support():
    result = found(np.full((40, 12), 2.0), window=10)
    assert result.support[0] == pytest.approx(1.0)
    assert result.known[0] == pytest.approx(1.0)


def test_a_window_that_is_not_full_counts_what_it_has():
    """Three scans of a hundred: shares of three, or a young map would know nothing for a day."""
    assert found(np.full((3, 12), 2.0), window=100).known[0] == pytest.approx(1.0)


@pytest.mark.parametrize("angle_bins", [2, 3, 12, 13, 361, 3600])
def test_any_number_of_angle_bins_is_estimated(angle_bins):
    random = np.random.default_rng(angle_bins)
    near = random.uniform(1, 3, angle_bins)
    scenes = np.stack((near, near + random.uniform(0.5, 1, angle_bins)))
    scans = np.round(scenes[random.integers(0, 2, 31)] + random.normal(0, 0.01, (31, angle_bins)), 3)
    ranges = estimated(scans, 9).astype(int)
    assert any((np.abs(ranges - scene * 1000) < 80).all() for scene in scenes)


def test_no_nodes_are_estimated_to_nothing():
    memory = learnt(np.full((2, 12), 1.0), 5)
    result = estimate(memory.recall(np.zeros(0, np.int64)), 0.1)
    assert result.ranges.shape == (0, 12)


def test_ranges_are_told_as_they_were_measured_to_the_millimetre():
    scans = np.array([[1.234, 59.999, 0.001]])
    assert estimated(scans).tolist() == codes(scans)[0].tolist() == [1234, 59999, 1]
