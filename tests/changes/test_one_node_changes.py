"""What one node in the middle of a round room says."""

import numpy as np
import pytest

from tests.changes.rooms import CENTRE, RADIUS, Box, compare_rings, estimate, ring
from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.rules import Rules
from timemap_cli.model.nodes import Node

BOX = Box(2.3, 0.0)  # its face stands at x = 2, y = -0.3..0.3: bearings -8.53..8.53 degrees


def test_box_that_appears_is_one_change_at_its_face():
    difference = compare_rings(ring(CENTRE), ring(CENTRE, [BOX]))
    (change,) = difference.changes
    assert change.kind is Kind.APPEARED
    assert (change.x, change.y) == pytest.approx((2.0, 0.0), abs=0.01)
    assert change.bounds == pytest.approx((2.0, -0.3, 2.0, 0.3), abs=0.02)
    assert change.support == pytest.approx(0.9)
    assert change.nodes == (0,)


def test_box_that_vanishes_is_reported_where_it_stood():
    (change,) = compare_rings(ring(CENTRE, [BOX]), ring(CENTRE)).changes
    assert change.kind is Kind.VANISHED
    assert (change.x, change.y) == pytest.approx((2.0, 0.0), abs=0.01)


def test_sector_over_bearing_zero_is_one_and_runs_counter_clockwise():
    (change,) = compare_rings(ring(CENTRE, [BOX]), ring(CENTRE)).changes
    (sector,) = change.sectors
    assert (sector.start_bin, sector.stop_bin) == (351, 9)  # centres 351.5 .. 8.5 degrees
    assert sector.bins(360) == 18
    assert sector.range_from_m == pytest.approx(2.0, abs=0.02)
    assert sector.range_to_m == pytest.approx(5.0)


def test_sector_that_ends_at_bearing_zero_stops_at_the_last_bin():
    before, after = np.full(360, 5.0), np.full(360, 5.0)
    before[350:] = 2.0
    (sector,) = compare_rings(before, after).changes[0].sectors
    assert (sector.start_bin, sector.stop_bin) == (350, 360)


def test_ring_that_changed_all_round_is_one_sector():
    (change,) = compare_rings(np.full(360, 2.0), np.full(360, 5.0)).changes
    (sector,) = change.sectors
    assert (sector.start_bin, sector.stop_bin, sector.bins(360)) == (0, 360, 360)
    assert (change.x, change.y) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_ring_that_changed_all_round_with_one_jump_is_cut_there():
    before = np.full(360, 2.0)
    before[100:] = np.linspace(3.0, 2.0, 260)  # jumps from 2 to 3 m between bins 99 and 100 only
    (sector,) = compare_rings(before, np.full(360, 8.0)).changes[0].sectors
    assert (sector.start_bin, sector.stop_bin, sector.bins(360)) == (100, 100, 360)


def test_nothing_differs_between_equal_rings():
    difference = compare_rings(ring(CENTRE, [BOX]), ring(CENTRE, [BOX]))
    assert difference.changes == ()
    assert (difference.compared_bins, difference.changed_bins) == (360, 0)


def test_changed_bins_are_counted():
    difference = compare_rings(ring(CENTRE, [BOX]), ring(CENTRE))
    assert (difference.compared_bins, difference.changed_bins) == (360, 18)


@pytest.mark.parametrize(
    ("near", "far", "changes"),
    [
        (2.0, 2.19, 0),
        (2.0, 2.21, 1),
        (9.0, 9.26, 0),  # 3 % of 9 m is 0.27 m
        (9.0, 9.28, 1),
    ],
)
def test_step_must_exceed_the_threshold(near: float, far: float, changes: int):
    before, after = np.full(360, near), np.full(360, far)
    assert len(compare_rings(before, after).changes) == changes


@pytest.mark.parametrize(
    ("range_m", "changes"),
    [(9.41, 1), (9.45, 0)],  # step 0.282 and 0.2835 m: up to 9.436 and 9.433 m counts
)
def test_clear_counts_only_against_what_stands_well_inside_the_radius(range_m: float, changes: int):
    clear, wall = np.full(360, np.inf), np.full(360, range_m)
    assert len(compare_rings(wall, clear).changes) == changes
    assert len(compare_rings(clear, wall).changes) == changes


def test_thing_in_open_space_goes_to_clear():
    (change,) = compare_rings(ring(CENTRE, [BOX], wall=20.0), ring(CENTRE, wall=20.0)).changes
    assert change.kind is Kind.VANISHED
    assert change.sectors[0].range_to_m == np.inf


def test_clear_against_clear_is_no_change():
    assert compare_rings(ring(CENTRE, wall=20.0), ring(CENTRE, wall=20.0)).changes == ()


def test_unknown_bins_are_no_change_and_not_compared():
    before = ring(CENTRE, [BOX])
    before[20:200] = np.nan
    after = ring(CENTRE, [Box(0.0, 2.3)])
    after[300:340] = np.nan
    difference = compare_rings(before, after)
    assert [change.kind for change in difference.changes] == [Kind.VANISHED]
    # a surface shown within two bins can be told of: two at either end of both gaps
    assert difference.compared_bins == 360 - 180 - 40 + 8


def test_thing_whose_bins_are_all_unknown_now_has_not_vanished():
    after = ring(CENTRE)
    after[340:] = after[:20] = np.nan
    assert compare_rings(ring(CENTRE, [BOX]), after).changes == ()


def test_single_unknown_bin_does_not_split_a_sector():
    before = ring(CENTRE, [BOX])
    before[2] = np.nan
    (change,) = compare_rings(before, ring(CENTRE)).changes
    assert [(s.start_bin, s.stop_bin) for s in change.sectors] == [(351, 9)]


FAR_BOX = Box(6.3, 0.0)  # two degrees are 0.21 m at its face, enough to be a sector


def test_view_round_an_edge_from_a_slightly_other_place_is_no_change():
    """At both edges two degrees changed hands between the box and the wall behind."""
    before = ring(CENTRE, [FAR_BOX], wall=9.0, bins=1440)
    after = np.roll(before, 8)
    assert compare_rings(before, after).changes == ()
    assert compare_rings(before, after, Rules(min_apart_m=0.01)).changes == ()
    assert len(compare_rings(before, after, Rules(min_apart_m=0.01, edge_deg=0.5)).changes) == 2


def test_ends_as_close_to_the_surface_as_poses_are_off_are_no_change():
    """Of 0.16 m at each edge less than one bin lies farther from what still stands than 0.15 m; of 0.21 m three do."""
    before = ring(CENTRE, [FAR_BOX], wall=9.0, bins=1440)
    assert compare_rings(before, np.roll(before, 6), Rules(edge_deg=0.5)).changes == ()
    assert len(compare_rings(before, np.roll(before, 8), Rules(edge_deg=0.5)).changes) == 2


@pytest.mark.parametrize(
    ("degrees", "kinds"),
    [
        (6, set()),  # of six bins at either side two are the edge's tolerance; four are less than 0.15 m wide
        (7, {Kind.VANISHED, Kind.APPEARED}),
        (10, {Kind.VANISHED, Kind.APPEARED}),
    ],
)
def test_shift_beyond_the_tolerances_is_a_change(degrees: int, kinds: set[Kind]):
    before = ring(CENTRE, [BOX])
    changes = compare_rings(before, np.roll(before, degrees)).changes
    assert {change.kind for change in changes} == kinds
    assert [s.bins(360) for change in changes for s in change.sectors] == [degrees - 2] * len(kinds)


def test_edge_tolerance_reaches_its_angle_and_no_farther():
    before = ring(CENTRE, [FAR_BOX], wall=9.0, bins=1440)
    kinds = {change.kind for change in compare_rings(before, np.roll(before, 16)).changes}
    assert kinds == {Kind.VANISHED, Kind.APPEARED}


@pytest.mark.parametrize(
    ("bins", "range_m", "changes"),
    [
        (2, 6.0, 0),  # arc 0.21 m, but only two bins
        (3, 3.1, 1),  # arc 0.162 m
        (3, 2.5, 0),  # arc 0.131 m
        (4, 2.5, 1),  # arc 0.175 m
    ],
)
def test_small_sectors_are_left_out(bins: int, range_m: float, changes: int):
    before = np.full(360, 8.0)
    before[100 : 100 + bins] = range_m
    rules = Rules(min_thing_bins=1)
    assert len(compare_rings(before, np.full(360, 8.0), rules).changes) == changes


@pytest.mark.parametrize(("bins", "changes"), [(4, 0), (5, 1)])
def test_thing_of_few_bins_in_all_is_left_out(bins: int, changes: int):
    before = np.full(360, 8.0)
    before[100 : 100 + bins] = 4.0
    assert len(compare_rings(before, np.full(360, 8.0)).changes) == changes


def test_jump_in_range_parts_two_things():
    before = np.full(360, 8.0)
    before[100:110] = 2.0
    before[110:120] = 4.0
    changes = compare_rings(before, np.full(360, 8.0)).changes
    assert [change.sectors[0].start_bin for change in changes] == [110, 100]  # the larger one first


@pytest.mark.parametrize(
    ("support", "samples", "changes"),
    [
        (0.9, 3, 1),
        (0.9, 2, 0),
        (0.5, 20, 1),
        (0.49, 20, 0),
        (0.0, 20, 0),
    ],
)
def test_only_firm_bins_are_compared(support: float, samples: int, changes: int):
    old = {0: estimate(0, ring(CENTRE, [BOX]), support=support, samples=samples)}
    new = {0: estimate(0, ring(CENTRE))}
    assert len(compare([CENTRE], old, new, radius=RADIUS).changes) == changes
    assert len(compare([CENTRE], new, old, radius=RADIUS).changes) == changes


def test_support_is_that_of_the_weaker_side():
    old = {0: estimate(0, ring(CENTRE, [BOX]), support=0.8)}
    new = {0: estimate(0, ring(CENTRE), support=0.6)}
    (change,) = compare([CENTRE], old, new, radius=RADIUS).changes
    assert change.support == pytest.approx(0.6)


def test_place_is_in_the_map_frame_not_the_nodes():
    node = Node(-3.0, 7.0)
    (change,) = compare_rings(np.full(360, 2.0), np.full(360, 4.0), nodes=[node]).changes
    assert change.bounds == pytest.approx((-5.0, 5.0, -1.0, 9.0), abs=0.001)


def test_rules_can_be_changed():
    before = ring(CENTRE, [BOX])
    assert compare_rings(before, ring(CENTRE), Rules(min_arc_m=0.7)).changes == ()


def test_rings_of_different_resolution_are_refused():
    old, new = {0: estimate(0, ring(CENTRE))}, {0: estimate(0, ring(CENTRE, bins=720))}
    with pytest.raises(ValueError, match="360 and 720 angle bins"):
        compare([CENTRE], old, new, radius=RADIUS)
