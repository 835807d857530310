"""Which remembered ranges are the same surface."""

from itertools import pairwise

import numpy as np
import pytest

from tests.model.memories import learnt, recalled
from tests.model.reference import stretched
from timemap_cli.model.paper_profile import states_from_range_bins
from timemap_cli.model.states import MAX_STATES, states_from_data
from timemap_cli.model.virtual_scan import UNSEEN

NAN, INF = np.nan, np.inf


def surfaces(*ranges, width=0.10, window=400):
    """Groups of ranges [m] that one angle bin was seen to have, each a list in mm."""
    scans = np.full((len(ranges), 3), NAN)
    scans[:, 1] = ranges  # no neighbours: no pairs
    memory = recalled(learnt(scans, window))
    states = states_from_data(memory, width)
    if 1 not in states.rows:
        known = sorted(v for v in memory.samples[0, 1].tolist() if v < UNSEEN)
        return [known] if known else []
    (row,) = np.flatnonzero(states.rows == 1)
    known = [v for v in states.known[row].tolist() if v < UNSEEN]
    borders = [int(border) for border in states.borders[row] if border < UNSEEN] + [UNSEEN]
    return [[v for v in known if low <= v < high] for low, high in pairwise(borders)]


def test_ranges_farther_apart_than_half_a_width_are_two_surfaces():
    assert surfaces(1.0, 1.05) == [[1000, 1050]]
    assert surfaces(1.0, 1.051) == [[1000], [1051]]


def test_no_border_stands_at_a_fixed_range():
    """A surface on the edge of a slice of range would be cut in two by fixed slices, wherever they begin."""
    random = np.random.default_rng(1)
    for middle in np.arange(1.0, 1.2, 0.007):
        assert len(surfaces(*np.round(random.normal(middle, 0.012, 60), 3))) == 1


def test_a_chain_of_near_ranges_up_to_two_widths_is_one_surface():
    assert surfaces(1.0, 1.05, 1.1, 1.15, 1.2) == [[1000, 1050, 1100, 1150, 1200]]


def test_what_is_wider_is_cut_into_its_densest_windows():
    values = [1.0, 1.04, 1.08, 1.12, 1.121, 1.122, 1.123, 1.16, 1.18, 1.201, 1.24]
    assert surfaces(*values) == [[1000, 1040], [1080, 1120, 1121, 1122, 1123, 1160, 1180], [1201, 1240]]


def test_of_equally_dense_windows_the_nearest_is_cut_out_first():
    values = [1.0, 1.05, 1.1, 1.15, 1.2, 1.25]
    assert surfaces(*values) == [[1000, 1050, 1100], [1150, 1200, 1250]]


def test_clear_is_a_state_of_its_own():
    assert surfaces(59.0, INF) == [[59000], [65534]]
    assert surfaces(INF, INF) == [[65534, 65534]]


@pytest.mark.parametrize("width", [0.1, 0.5, 0.6, 1.0])
@pytest.mark.parametrize("metres", [50.0, 56.0, 58.0, 60.0])
def test_clear_stays_apart_from_the_farthest_ranges_whatever_the_width(metres, width):
    assert surfaces(metres, INF, width=width) == [[metres * 1000], [65534]]


def test_beyond_1_6_metres_surfaces_are_wider_in_proportion():
    """Half of 10 cm at 1.6 m is a factor of exp(0.05 / 1.6) = 1.0317 beyond."""
    assert len(surfaces(1.54, 1.592)) == 2
    assert len(surfaces(5.0, 5.15)) == 1
    assert len(surfaces(5.0, 5.17)) == 2
    assert len(surfaces(9.5, 9.79)) == 1
    assert len(surfaces(9.5, 9.82)) == 2


def test_the_stretched_scale_is_even_up_to_the_bend_and_logarithmic_beyond():
    assert [stretched(mm) for mm in (1000, 1600, 5000, 10_000)] == pytest.approx(
        [1000, 1600, 3423.1, 4532.1], abs=0.1
    )


def test_an_angle_bin_with_one_surface_or_none_has_no_choice():
    assert surfaces() == []
    assert surfaces(2.0, 2.01, 2.02) == [[2000, 2010, 2020]]
    assert len(states_from_data(recalled(learnt([[2.0, 2.0, NAN]] * 3, 5)), 0.1).rows) == 0


def test_states_are_found_in_samples_and_in_both_ends_of_pairs():
    """Angle bin 1 forgot the pairs' ranges among its samples; its own pairs and its predecessor's still tell."""
    old, alone = np.tile([1.0, 2.0, 3.0], (20, 1)), np.tile([NAN, 4.0, NAN], (300, 1))
    states = states_from_data(recalled(learnt(np.vstack((old, alone)), 5)), 0.1)
    (row,) = np.flatnonzero(states.rows == 1)
    assert states.borders[row].tolist() == [0, 4000, UNSEEN]
    assert [v for v in states.known[row].tolist() if v < UNSEEN] == [2000] * 10 + [4000] * 5


def test_noise_without_end_is_bounded_in_its_states():
    """A laser that returns noise: the surfaces with the smallest gaps are joined."""
    found = surfaces(*np.arange(0.2, 2.4, 0.06), window=100)
    assert len(found) == MAX_STATES
    assert sum(map(len, found)) == 37


def test_random_ranges_of_any_density_are_all_in_exactly_one_surface():
    random = np.random.default_rng(4)
    for _ in range(40):
        ranges = np.round(random.uniform(0.3, random.choice([0.6, 1.5, 9.0]), random.integers(1, 100)), 3)
        found = surfaces(*ranges, width=random.choice([0.05, 0.1, 0.3]), window=100)
        assert sorted(value for surface in found for value in surface) == sorted(
            np.rint(ranges * 1000).astype(int).tolist()
        )
        assert all(found)


def test_hundreds_of_slices_of_range_keep_their_numbers():
    ranges = np.round(0.3 + 0.02 * np.arange(400), 3)
    memory = recalled(learnt(np.repeat(ranges[:, None], 3, axis=1), 400))
    states = states_from_range_bins(memory, 0.01)
    assert states.labels(np.sort(memory.samples[0]), np.arange(3)).tolist() == [list(range(400))] * 3
