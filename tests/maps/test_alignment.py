"""Two sets of surface points: shifted against each other, or of a world that changed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.maps.worlds import box, free_nodes, hall, moved, seen, spots, walls
from timemap_cli.maps.alignment import align

NOISE = 0.015  # [m]


def hall_seen(rng, pieces, nodes=6):
    return seen(hall(pieces), free_nodes(rng, nodes, pieces), noise=NOISE, rng=rng)


def farthest_off(alignment, points, truth):
    """[m] between where the offset takes the points and where they belong."""
    return float(np.linalg.norm(alignment.offset.moved(points) - truth, axis=1).max())


def far_enough(sign, size):
    """A shift of 0.2 m to 0.5 m: no wall of the hall fits where it is."""
    return sign * (0.2 + 0.3 * size)


signs, sizes = st.sampled_from((-1, 1)), st.floats(0, 1)
shifts = st.builds(far_enough, signs, sizes)
seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=15)
@given(seeds, shifts, shifts, st.floats(-5, 5), st.booleans())
def test_any_offset_within_half_a_metre_and_five_degrees_is_found(seed, dx, dy, degrees, changed):
    rng = np.random.default_rng(seed)
    before = spots(rng, 6)
    after = before[:3] + spots(rng, 3, before) if changed else before
    truth = hall_seen(rng, before)
    points = moved(truth, dx, dy, math.radians(degrees))
    found = align(points, hall_seen(rng, after))
    assert farthest_off(found, points, truth) < 0.05
    assert found.shifted
    assert found.undetermined is None


@settings(max_examples=15)
@given(seeds)
def test_furniture_that_was_moved_is_no_shift(seed):
    rng = np.random.default_rng(seed)
    before = spots(rng, 12)
    after = before[:5] + spots(rng, 7, before[:5])
    points = hall_seen(rng, before)
    found = align(points, hall_seen(rng, after))
    assert not found.shifted
    assert farthest_off(found, points, points) < 0.05


def test_a_turn_about_a_distant_origin_is_found():
    rng = np.random.default_rng(1)
    pieces = spots(rng, 6)
    truth, surface = (moved(hall_seen(rng, pieces), 20, 5) for _ in range(2))
    points = moved(truth, 0.3, -0.3, math.radians(6))  # moves the hall by 2 m
    found = align(points, surface)
    assert farthest_off(found, points, truth) < 0.05
    assert found.offset.yaw == pytest.approx(math.radians(-6), abs=0.003)


def test_the_offset_takes_the_points_onto_the_surface():
    rng = np.random.default_rng(2)
    pieces = spots(rng, 6)
    points, surface = hall_seen(rng, pieces), moved(hall_seen(rng, pieces), 0.3, -0.2)
    found = align(points, surface)
    assert (found.offset.dx, found.offset.dy) == pytest.approx((0.3, -0.2), abs=0.02)
    assert found.shift == pytest.approx((0.3, -0.2), abs=0.02)
    assert found.inliers_before < 0.3
    assert found.inliers_after > 0.85
    assert found.gain == pytest.approx(found.inliers_after - found.inliers_before)


def test_all_furniture_pushed_the_same_way_is_no_shift():
    """The walls stay, and they fitted before."""
    rng = np.random.default_rng(3)
    before = spots(rng, 12)
    after = [(x + 0.4, y + 0.2, yaw) for x, y, yaw in before]
    found = align(hall_seen(rng, before), hall_seen(rng, after))
    assert not found.shifted


CORRIDOR = np.array([[(-30, -1), (30, -1)], [(-30, 1), (30, 1)]], float)
ALONG = [(x, 0.1) for x in (-6, -3, 0, 3, 6)]


@settings(max_examples=15)
@given(seeds, st.floats(-math.pi, math.pi), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_a_corridor_fixes_nothing_along_itself(seed, heading, along, across):
    rng = np.random.default_rng(seed)
    points, surface = (seen(CORRIDOR, ALONG, noise=NOISE, rng=rng) for _ in range(2))
    found = align(moved(points, along, across, heading, (along, across)), moved(surface, 0, 0, heading))
    direction = np.array([math.cos(heading), math.sin(heading)])
    assert found.undetermined is not None
    assert found.undetermined[0] >= 0
    assert abs(float(direction @ found.undetermined)) == pytest.approx(1, abs=0.001)
    assert abs(float(direction @ found.shift)) < 0.02  # of what lies along it nothing is claimed


def test_a_corridor_is_found_shifted_across():
    rng = np.random.default_rng(4)
    points, surface = (seen(CORRIDOR, ALONG, noise=NOISE, rng=rng) for _ in range(2))
    found = align(moved(points, 0.4, 0.3), surface)
    assert found.shifted
    assert found.shift == pytest.approx((0.0, -0.3), abs=0.02)
    assert found.undetermined == pytest.approx((1.0, 0.0), abs=0.01)


def test_the_end_of_a_corridor_fixes_it():
    rng = np.random.default_rng(5)
    closed = walls((-9, -1), (9, -1), (9, 1), (-9, 1))
    points, surface = (seen(closed, ALONG, noise=NOISE, rng=rng) for _ in range(2))
    found = align(moved(points, 0.3, 0.0), surface)
    assert found.undetermined is None
    assert found.shift == pytest.approx((-0.3, 0.0), abs=0.03)


def test_two_objects_that_left_a_corridor_are_no_shift():
    rng = np.random.default_rng(6)
    full = np.concatenate([CORRIDOR, box(-4.5, -0.7, 0.6, 0.5), box(4, 0.7, 0.8, 0.4)])
    for before, after in ((full, CORRIDOR), (CORRIDOR, full)):
        found = align(*(seen(one, ALONG, noise=NOISE, rng=rng) for one in (before, after)))
        assert not found.shifted
        assert abs(found.gain) < 0.02


PIERS = [
    box(x, y, width, 0.8) for x, y, width in ((-3.2, 3, 0.5), (-1.1, -3, 0.7), (1.4, 3, 0.9), (2.7, -3, 0.4))
]


def test_what_the_other_side_has_not_seen_does_not_count():
    """Two wings that share a middle: neither drive has seen the other's."""
    rng = np.random.default_rng(7)
    plan = np.concatenate([walls((-25, -3), (25, -3), (25, 3), (-25, 3)), *PIERS])
    west, east = [(x, 0) for x in (-17, -10, -3, 0)], [(x, 0) for x in (0, 3, 10, 17)]
    points, surface = (seen(plan, nodes, radius=9, noise=NOISE, rng=rng) for nodes in (west, east))
    unmoved, other = align(points, surface), align(moved(points, 0.3, 0.3), surface)
    assert not unmoved.shifted
    assert unmoved.inliers_before > 0.6
    assert other.shifted
    assert other.shift == pytest.approx((-0.3, -0.3), abs=0.05)


@pytest.mark.parametrize("door", [None, 0.5, 2.0])
def test_sliding_into_what_the_other_side_has_seen_is_no_shift(door):
    """Two drives share 8 m of a corridor and no more: slid into each other they would share more of it."""
    rng = np.random.default_rng(12)
    plan = walls((-25, -1), (25, -1), (25, 1), (-25, 1))
    if door is not None:
        plan = np.concatenate([plan, box(door, 1, 0.3, 0.4)])
    west, east = [(x, 0) for x in np.arange(-17, 4)], [(x, 0) for x in np.arange(-3, 18)]
    points, surface = (seen(plan, nodes, radius=4, noise=NOISE, rng=rng) for nodes in (west, east))
    found = align(points, surface)
    assert not found.shifted
    assert found.shift == pytest.approx((0, 0), abs=0.03)


def test_two_rooms_with_nothing_in_common_are_no_shift():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        one, other = (
            np.concatenate([box(*rng.uniform(-5, 5, 2), 0.5, 0.5, rng.uniform(0, 3)) for _ in range(15)])
            for _ in range(2)
        )
        nodes = [(-6, -6), (6, -6), (6, 6), (-6, 6)]
        assert not align(seen(one, nodes), seen(other, nodes)).shifted


def test_neither_the_order_of_points_nor_their_last_digits_matter():
    rng = np.random.default_rng(8)
    pieces = spots(rng, 6)
    points, surface = (np.round(hall_seen(rng, pieces), 3) for _ in range(2))
    points += (0.25, 0.25)
    first = align(points, surface)
    shuffled = (rng.permutation(one) + rng.uniform(-1e-7, 1e-7, one.shape) for one in (points, surface))
    assert align(*shuffled) == first
    assert first.compared > 1000


def test_what_is_no_place_is_left_out():
    rng = np.random.default_rng(9)
    points, surface = (hall_seen(rng, []) for _ in range(2))
    wrong = np.array([[np.nan, 0], [np.inf, 1], [1, -np.inf], [1e300, 1], [-1e9, 5]])
    assert align(np.concatenate([wrong, points]), np.concatenate([surface, wrong])) == align(points, surface)


@pytest.mark.parametrize(("points", "surface"), [(0, 0), (0, 300), (300, 0), (1, 300), (300, 1), (3, 3)])
def test_too_few_points_tell_nothing(points, surface):
    line = np.stack((np.arange(300) * 0.05, np.zeros(300)), axis=1)
    found = align(moved(line[:points], 0.0, 0.3), line[:surface])
    assert not found.shifted
    assert found.offset.yaw == pytest.approx(0.0, abs=0.2)


def test_points_far_from_each_other_cannot_be_compared():
    line = np.stack((np.arange(300) * 0.05, np.zeros(300)), axis=1)
    found = align(line, moved(line, 0.0, 100.0))
    assert found.compared == 0
    assert not found.shifted
    assert found.shift == (0.0, 0.0)


def test_a_map_far_from_its_origin_is_as_exact():
    """Coordinates of a surveyor's grid."""
    rng = np.random.default_rng(10)
    pieces = spots(rng, 6)
    away = (456_000.0, 5_425_000.0)
    points, surface = hall_seen(rng, pieces), hall_seen(rng, pieces)
    found = align(points + away + (0.3, 0.25), surface + away)
    assert found.shifted
    assert found.shift == pytest.approx((-0.3, -0.25), abs=0.02)


def test_more_points_are_no_more_work():
    rng = np.random.default_rng(11)
    pieces = spots(rng, 6)
    surface = hall_seen(rng, pieces, nodes=60)
    found = align(moved(surface, 0.2, 0.3), surface)
    assert len(surface) > 20_000
    assert found.compared <= 3000
    assert found.shift == pytest.approx((-0.2, -0.3), abs=0.01)
