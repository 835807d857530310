"""The parts of an alignment, held against plain ways to the same values."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from timemap_cli.maps.grid import Grid, sample, thinned
from timemap_cli.maps.icp import _solved
from timemap_cli.maps.offset import Offset
from timemap_cli.maps.surface import Surface

millimetres = st.integers(-3000, 3000).map(lambda value: value / 1000)
clouds = arrays(np.float64, st.tuples(st.integers(1, 40), st.just(2)), elements=millimetres)


@given(clouds, clouds)
def test_the_nearest_point_is_the_nearest_of_all(points, queries):
    which, point, squares = Grid(points, 0.5).nearest(queries)
    apart = np.linalg.norm(queries[:, None] - points, axis=2)
    near = np.rint(apart.min(axis=1) ** 2 * 1e8) <= 0.25e8
    np.testing.assert_array_equal(which, np.flatnonzero(near))
    np.testing.assert_allclose(apart[which, point], apart[near].min(axis=1), atol=1e-4)
    np.testing.assert_allclose(squares, apart[near].min(axis=1) ** 2 * 1e8, atol=1)


def test_of_two_alike_the_first_is_the_nearest():
    _, point, _ = Grid(np.array([[0.1, 0.0], [-0.1, 0.0]]), 0.5).nearest(np.array([[0.0, 0.0]]))
    assert point.tolist() == [0]


def test_a_cell_keeps_the_middle_of_its_points():
    points = np.array([[0.01, 0.01], [0.03, 0.02], [0.06, 0.01], [-0.01, 0.01]])
    assert thinned(points, 0.05).tolist() == [[-0.01, 0.01], [0.02, 0.015], [0.06, 0.01]]


def test_a_sample_is_spread_evenly():
    y, x = np.mgrid[0:100, 0:100] * 0.05
    chosen = sample(thinned(np.stack((x.ravel(), y.ravel()), axis=1), 0.05), 1000, 0.05)
    assert len(chosen) == 1000
    count, _, _ = np.histogram2d(*chosen.T, bins=2, range=((-0.01, 4.99),) * 2)
    assert count.min() > 200  # 250 each


@given(clouds)
def test_a_line_holds_nothing_along_itself(points):
    line = Surface(np.stack((np.arange(40) * 0.05, np.zeros(40)), axis=1), 0.05)
    pairs = line.nearest(points)
    np.testing.assert_allclose(pairs.across[:, 0], 0, atol=1e-9)
    np.testing.assert_allclose(pairs.across[:, 1], -points[pairs.which, 1], atol=1e-9)


@given(st.floats(-math.pi, math.pi))
def test_a_line_may_run_any_way(heading):
    along = np.array([math.cos(heading), math.sin(heading)])
    line = Surface(np.arange(40)[:, None] * 0.05 * along, 0.05)
    beside = np.array([-along[1], along[0]]) * 0.1 + along
    (across,) = line.nearest(beside[None]).across
    np.testing.assert_allclose(across, along - beside, atol=0.005)


def test_points_on_no_line_hold_all_ways():
    three = Surface(np.array([[1.0, 1.0], [0.8, 1.0], [1.0, 1.2]]), 0.05)
    pairs = three.nearest(np.array([[1.1, 0.9], [2.0, 2.0]]))
    assert pairs.which.tolist() == [0]
    np.testing.assert_allclose(pairs.across, [[-0.1, 0.1]])


@given(
    arrays(np.float64, (6, 3), elements=st.integers(-9, 9).map(float)),
    arrays(np.float64, 3, elements=millimetres),
)
@settings(max_examples=50)
def test_the_three_unknowns_are_those_of_any_solver(rows, right):
    matrix = rows.T @ rows + np.eye(3)
    expected = np.linalg.solve(matrix, right)
    found = _solved(tuple(map(tuple, matrix.tolist())), tuple(right.tolist()))
    np.testing.assert_allclose(found, expected, atol=1e-9)


@given(clouds, millimetres, millimetres, millimetres)
def test_offsets_follow_each_other(points, dx, dy, yaw):
    one, other = Offset(dx, dy, yaw), Offset(dy, yaw, dx)
    np.testing.assert_allclose(one.then(other).moved(points), other.moved(one.moved(points)), atol=1e-9)


def test_a_turn_about_a_place_leaves_it_there():
    turn = Offset(0.0, 0.0, math.pi / 2).about(3.0, 1.0)
    np.testing.assert_allclose(turn.moved(np.array([[3.0, 1.0], [4.0, 1.0]])), [[3, 1], [3, 2]], atol=1e-12)
    assert turn.yaw == pytest.approx(math.pi / 2)
