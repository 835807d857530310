import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.level_map import FREE, OCCUPIED, UNKNOWN, merged_points, occupancy_grid
from timemap_cli.model.nodes import Node
from timemap_cli.model.status import Status

BINS = 360
RADIUS = 5.0


def seen(ranges, node=0, support=0.5):
    ranges = np.broadcast_to(np.asarray(ranges, np.float32), BINS).copy()
    share = np.full(BINS, support, np.float32)
    samples = np.full(BINS, 9, np.uint16)
    status, last_seen_ns = np.full(BINS, Status.MEASURED, np.uint8), np.zeros(BINS, np.int64)
    return Estimate(node, "long", 0, ranges, share, share, samples, status, last_seen_ns)


def bearings():
    return (np.arange(BINS) + 0.5) * 2 * math.pi / BINS


def to_wall(x, node=Node(0.0, 0.0)):  # noqa: B008
    """Ranges to a wall along y at x, out to the radius."""
    with np.errstate(divide="ignore"):
        along = (x - node.x) / np.cos(bearings())
    return np.where((along > 0) & (along < RADIUS), along, np.inf)


def cell(grid, x, y):
    row = math.floor((y - grid.origin_y) / grid.resolution)
    column = math.floor((x - grid.origin_x) / grid.resolution)
    rows, columns = grid.cells.shape
    return int(grid.cells[row, column]) if 0 <= row < rows and 0 <= column < columns else UNKNOWN


def test_points_stand_at_the_centre_of_their_bin_with_their_support():
    ranges = np.full(BINS, np.nan)
    ranges[[0, 90, 181]] = 1.0, 2.0, np.inf
    points = merged_points([Node(10.0, -5.0)], {0: seen(ranges, support=0.75)})
    half = math.radians(0.5)
    expected = [
        [10 + math.cos(half), -5 + math.sin(half), 0.75],
        [10 - 2 * math.sin(half), -5 + 2 * math.cos(half), 0.75],
    ]
    np.testing.assert_allclose(points, expected, atol=1e-6)
    assert points.dtype == np.float32


def test_points_of_several_nodes_come_one_after_the_other():
    nodes = [Node(0.0, 0.0), Node(1.0, 0.0), Node(2.0, 0.0)]
    points = merged_points(nodes, {2: seen(1.0, 2), 0: seen(1.0, 0)})
    assert len(points) == 2 * BINS
    assert points[:BINS, 0].mean() == pytest.approx(2.0, abs=1e-5)


def test_no_estimates_give_no_points_and_one_unknown_cell():
    assert merged_points([], {}).shape == (0, 3)
    assert occupancy_grid([], {}, RADIUS).cells.tolist() == [[UNKNOWN]]


def test_node_that_knows_nothing_frees_nothing():
    grid = occupancy_grid([Node(3.0, 4.0)], {0: seen(np.nan)}, RADIUS)
    assert (grid.cells == UNKNOWN).all()


def test_clear_bins_free_a_disc_out_to_the_radius():
    grid = occupancy_grid([Node(1.0, 2.0)], {0: seen(np.inf)}, RADIUS)
    assert not (grid.cells == OCCUPIED).any()
    area = (grid.cells == FREE).sum() * grid.resolution**2
    assert area == pytest.approx(math.pi * RADIUS**2, rel=0.002)
    assert cell(grid, 1.0 + 4.9, 2.0) == FREE
    assert cell(grid, 1.0 + 3.6, 2.0 + 3.6) == UNKNOWN


def test_wall_is_one_closed_line_with_free_space_before_and_nothing_behind():
    grid = occupancy_grid([Node(0.0, 0.0)], {0: seen(to_wall(2.01))}, RADIUS)
    for y in np.arange(-3.0, 3.0, 0.05):
        assert cell(grid, 2.01, y) == OCCUPIED
        assert cell(grid, 1.9, y) == FREE
    columns = np.flatnonzero((grid.cells == OCCUPIED).any(axis=0))
    assert len(columns) == 1
    assert (grid.cells[:, columns[0] + 1 :] == UNKNOWN).all()


def test_wall_seen_at_a_flat_angle_lets_nothing_leak_behind_it():
    grid = occupancy_grid([Node(0.0, 0.0)], {0: seen(to_wall(0.31))}, RADIUS)
    behind = [(x, y) for x in np.arange(0.42, 1.5, 0.05) for y in np.arange(-4.9, 4.9, 0.05)]
    assert {cell(grid, x, y) for x, y in behind} == {UNKNOWN}


def test_shadow_of_a_box_is_unknown():
    ranges = np.full(BINS, 4.0)
    ranges[40:50] = 2.0
    grid = occupancy_grid([Node(0.0, 0.0)], {0: seen(ranges)}, RADIUS)
    for bearing in np.radians([41.5, 45.0, 48.5]):
        assert cell(grid, 2.0 * math.cos(bearing), 2.0 * math.sin(bearing)) == OCCUPIED
        assert cell(grid, 1.9 * math.cos(bearing), 1.9 * math.sin(bearing)) == FREE
        assert cell(grid, 3.0 * math.cos(bearing), 3.0 * math.sin(bearing)) == UNKNOWN
    for bearing in np.radians([37.0, 53.0]):
        assert cell(grid, 3.0 * math.cos(bearing), 3.0 * math.sin(bearing)) == FREE


def test_gap_between_two_surfaces_is_not_closed():
    ranges = np.full(BINS, np.inf)
    ranges[88:90], ranges[94:96] = 3.0, 3.0  # 0.2 m of doorway between the posts
    grid = occupancy_grid([Node(0.0, 0.0)], {0: seen(ranges)}, RADIUS)
    assert cell(grid, 3.0 * math.cos(math.radians(92)), 3.0 * math.sin(math.radians(92))) == FREE


def test_unknown_bins_stay_unknown_between_free_ones():
    ranges = np.full(BINS, np.inf)
    ranges[40:50] = np.nan
    grid = occupancy_grid([Node(0.0, 0.0)], {0: seen(ranges)}, RADIUS)
    assert cell(grid, 2.0 * math.cos(math.radians(45)), 2.0 * math.sin(math.radians(45))) == UNKNOWN
    assert cell(grid, 2.0 * math.cos(math.radians(39)), 2.0 * math.sin(math.radians(39))) == FREE


def test_occupied_wins_where_nodes_disagree():
    nodes = [Node(0.0, 0.0), Node(0.0, 1.0)]
    for order in ((0, 1), (1, 0)):
        both = {0: seen(to_wall(2.01), 0), 1: seen(np.inf, 1)}
        grid = occupancy_grid(nodes, {n: both[n] for n in order}, RADIUS)
        assert cell(grid, 2.01, 0.0) == OCCUPIED
        assert cell(grid, 2.2, 0.0) == FREE


def test_every_point_lies_in_an_occupied_cell():
    nodes = [Node(0.3, -0.7), Node(1.1, 0.4)]
    estimates = {n: seen(to_wall(2.5, node), n) for n, node in enumerate(nodes)}
    grid = occupancy_grid(nodes, estimates, RADIUS)
    for x, y, _ in merged_points(nodes, estimates).astype(float):
        around = {cell(grid, x + dx, y + dy) for dx in (-1e-5, 1e-5) for dy in (-1e-5, 1e-5)}
        assert OCCUPIED in around


def test_grids_of_several_levels_lie_on_the_same_raster():
    for x in (0.0, 0.017, -3.33):
        grid = occupancy_grid([Node(x, 2 * x)], {0: seen(1.0)}, RADIUS)
        for origin in (grid.origin_x, grid.origin_y):
            assert origin / 0.05 == pytest.approx(round(origin / 0.05), abs=1e-6)


def test_resolution_gives_way_before_the_grid_becomes_huge():
    nodes = [Node(0.0, 0.0), Node(2000.0, 2000.0)]
    grid = occupancy_grid(nodes, {0: seen(1.0, 0), 1: seen(1.0, 1)}, RADIUS)
    assert grid.resolution == 0.8
    assert grid.cells.size <= 1 << 24
    assert cell(grid, 0.0, 0.0) == FREE or cell(grid, 0.0, 0.0) == OCCUPIED


@given(st.lists(st.sampled_from([0.5, 2.0, 4.99, math.inf, math.nan]), min_size=BINS, max_size=BINS))
def test_free_cells_lie_within_the_ranges_of_their_bins(ranges):
    node = Node(0.37, -0.81)
    grid = occupancy_grid([node], {0: seen(ranges)}, RADIUS)
    row, column = np.nonzero(grid.cells == FREE)
    dx = grid.origin_x + (column + 0.5) * 0.05 - node.x
    dy = grid.origin_y + (row + 0.5) * 0.05 - node.y
    bin_of = np.floor(np.arctan2(dy, dx) % (2 * math.pi) / (2 * math.pi) * BINS).astype(int) % BINS
    reach = np.where(np.isnan(ranges), -1.0, np.minimum(ranges, RADIUS))
    around = np.max([np.roll(reach, s) for s in (-1, 0, 1)], axis=0)  # a centre may lie on a border
    assert (np.hypot(dx, dy) <= around[bin_of] + 1e-6).all()


def test_many_nodes_at_once_equal_the_same_nodes_in_parts(monkeypatch):
    nodes = [Node(0.4 * i, 0.1 * i) for i in range(5)]
    estimates = {n: seen(to_wall(3.0, node), n) for n, node in enumerate(nodes)}
    whole = occupancy_grid(nodes, estimates, RADIUS)
    monkeypatch.setattr("timemap_cli.model.level_map._NODES_AT_ONCE", 2)
    parts = occupancy_grid(nodes, estimates, RADIUS)
    assert parts.cells.tobytes() == whole.cells.tobytes()


@pytest.mark.parametrize("far", [1e6, 1e8, 1e10])
def test_nodes_at_any_distance_fit_into_a_grid(far):
    grid = occupancy_grid([Node(-far, -far), Node(far, far)], {0: seen(1.0), 1: seen(1.0, 1)}, RADIUS)
    assert grid.cells.size <= 1 << 24
    assert grid.cells.shape[1] * grid.resolution >= 2 * far
    assert cell(grid, -far + 1, -far) == OCCUPIED
