"""Ray casting against distances worked out by hand, and against testing every ray with every segment."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_logs.rays import cast, cast_circles

SQUARE = np.array([[-1, -1, 3, -1], [3, -1, 3, 2], [3, 2, -1, 2], [-1, 2, -1, -1]], dtype=float)


def from_origin(bearings_deg, at=(0.0, 0.0)):
    bearings = np.deg2rad(np.array([bearings_deg], dtype=float))
    return np.broadcast_to(np.array(at), (*bearings.shape, 2)), bearings


def brute_force(segments, origins, bearings):
    ranges = np.full(bearings.shape, np.inf)
    for index in np.ndindex(bearings.shape):
        along = np.array([np.cos(bearings[index]), np.sin(bearings[index])])
        for x1, y1, x2, y2 in segments:
            start, edge = np.array([x1, y1]) - origins[index], np.array([x2 - x1, y2 - y1])
            matrix = np.array([along, -edge]).T
            if abs(np.linalg.det(matrix)) > 1e-12:
                distance, share = np.linalg.solve(matrix, start)
                if distance > 0 and 0 <= share <= 1:
                    ranges[index] = min(ranges[index], distance)
    return ranges


def test_distances_in_a_rectangle_are_those_worked_out_by_hand():
    ranges, sides = cast(SQUARE, *from_origin([-90, -45, 0, 30, 90, 135, 180]))
    expected = [1, np.sqrt(2), 3, 3 / np.cos(np.deg2rad(30)), 2, np.sqrt(2), 1]
    np.testing.assert_allclose(ranges[0], expected, rtol=1e-12)
    assert sides[0, [0, 2, 4, 6]].tolist() == [0, 1, 2, 3]


def test_a_segment_is_seen_from_both_sides():
    pane = np.array([[2.0, -1.0, 2.0, 1.0]])
    assert cast(pane, *from_origin([-10, 0, 10]))[0][0, 1] == pytest.approx(2.0)
    assert cast(pane, *from_origin([170, 180, 190], at=(5.0, 0.0)))[0][0, 1] == pytest.approx(3.0)


def test_the_nearer_of_two_segments_hides_the_other():
    segments = np.array([[4.0, -1.0, 4.0, 1.0], [2.5, -1.0, 2.5, 1.0]])
    ranges, hit = cast(segments, *from_origin([-5, 0, 5]))
    assert ranges[0, 1] == pytest.approx(2.5)
    assert hit[0, 1] == 1


def test_rays_that_meet_nothing_are_infinite_and_name_no_segment():
    ranges, hit = cast(np.array([[2.0, -1.0, 2.0, 1.0]]), *from_origin([60, 90, 120]))
    assert np.isposinf(ranges).all()
    assert (hit == -1).all()


def test_nothing_is_seen_beyond_the_reach():
    ranges, _ = cast(np.array([[2.0, -9.0, 2.0, 9.0]]), *from_origin([0, 30, 60]), reach=3.0)
    np.testing.assert_allclose(ranges[0], [2.0, 2 / np.cos(np.pi / 6), np.inf])


def test_a_world_without_segments_is_empty():
    assert np.isposinf(cast(np.empty((0, 4)), *from_origin([0, 1, 2]))[0]).all()


def test_a_single_beam_is_cast_too():
    assert cast(SQUARE, *from_origin([0]))[0][0, 0] == pytest.approx(3.0)


@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, -1.0]), st.floats(30, 360), st.floats(0, 1))
def test_culling_loses_no_hit_whatever_the_laser_does_during_the_sweep(seed, turning, view_deg, travel):
    rng = np.random.default_rng(seed)
    beams = 19
    segments = rng.uniform(-5, 5, (12, 4))
    share = np.linspace(0, 1, beams)
    bearings = rng.uniform(-9, 9, (2, 1)) + turning * np.deg2rad(view_deg) * share + 0.02 * rng.random(beams)
    origins = rng.uniform(-3, 3, (2, 1, 2)) + travel * rng.uniform(-1, 1, (2, 1, 2)) * share[:, None]
    ranges, hit = cast(segments, origins, bearings)
    np.testing.assert_allclose(ranges, brute_force(segments, origins, bearings), rtol=1e-6)
    assert ((hit >= 0) == np.isfinite(ranges)).all()


def test_a_circle_is_met_on_its_near_side():
    centres = np.array([[[3.0, 0.0], [np.nan, np.nan]]])
    ranges = cast_circles(centres, 0.5, *from_origin([0, np.rad2deg(np.arcsin(0.3 / 3.0)), 20, 180]))
    oblique = 3 * np.cos(np.arcsin(0.1)) - 0.4
    np.testing.assert_allclose(ranges[0], [2.5, oblique, np.inf, np.inf])
