"""What a scan would have been from a node: places, clear, what an off-centre robot may claim."""

import math

import numpy as np
import pytest

from tests.model.scenes import (
    ROOM,
    cast,
    drive_past,
    fan,
    look_around,
    map_directions,
    pillar,
    pose,
    rectangle,
    seen_from,
    sweeps,
)
from timemap_cli.model.outline import outlines
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, virtual_scans

ALL_ROUND = fan(721, 360)
SQUARE = rectangle(-3, -3, 3, 3)


FREE, UNKNOWN = np.array([True]), np.array([False])  # what is known of the way to the node


def virtual(scan, x=0.0, y=0.0, *, angle_bins=360, radius=10.0, way=FREE):
    """Ranges [m] of the only scan, inf clear, NaN unseen."""
    ranges, judged = virtual_scans(scan, np.array([[x, y]]), way, angle_bins, radius)
    assert judged[0] or (ranges == UNSEEN).all()
    return metres(ranges[0])


def metres(ranges):
    return np.where(ranges == UNSEEN, np.nan, np.where(ranges == CLEAR, np.inf, ranges / 1000))


def judges(scan, x=0.0, y=0.0, radius=10.0, way=FREE):
    return bool(virtual_scans(scan, np.array([[x, y]]), way, 360, radius)[1][0])


def seen_bins(ranges):
    return set(np.flatnonzero(~np.isnan(ranges)).tolist())


# ------------------------------------------------------------------ places of points


def test_a_point_is_placed_by_point_minus_centre():
    scan = look_around(SQUARE, 1.0, 0.0, 0.3, ALL_ROUND)
    seen = virtual(scan, 0.5, 0.5)
    assert seen[[0, 90, 180, 270]] == pytest.approx([2.5, 2.5, 3.5, 3.5], abs=0.01)


def test_bearing_zero_looks_along_the_map_whatever_the_robot_faces():
    for yaw in (0.0, 0.7, 2.0, -3.0):
        seen = virtual(look_around(rectangle(-1, -2, 3, 4), 0, 0, yaw, ALL_ROUND))
        assert seen[[0, 90, 180, 270]] == pytest.approx([3, 4, 1, 2], abs=0.01)


def test_points_behind_the_node_stay_behind_it():
    """atan would throw them to the front."""
    behind = look_around(pillar(-2.0, -2.0), 0, 0, 0, ALL_ROUND)
    hit = np.flatnonzero(np.isfinite(virtual(behind)))
    assert len(hit) > 5
    assert set(hit.tolist()) <= set(range(215, 235))


@pytest.mark.parametrize("bearing", [0.0, -0.0, -1e-17, -1e-12, 1e-17, -1e-8, math.tau, -math.tau])
def test_a_beam_a_rounding_beside_bearing_zero_falls_into_the_first_or_the_last_angle_bin(bearing):
    ranges = np.full(361, np.nan)
    bearings = np.radians(np.arange(361.0) - 180)
    bearings[180] = bearing
    ranges[180] = 2.0
    seen = virtual(sweeps([ranges], bearings, [pose(0, 0)]))
    (hit,) = np.flatnonzero(np.isfinite(seen))
    assert hit in {0, 359}
    assert seen[hit] == 2.0


@pytest.mark.parametrize("angle_bins", [12, 13, 61, 360, 361, 720, 3600])
def test_an_angle_bin_holds_its_lower_border_and_not_its_upper(angle_bins):
    width = 2 * math.pi / angle_bins
    for i in (0, 1, angle_bins // 2, angle_bins - 1):
        for part, expected in ((0.001, i), (0.999, i), (1.001, (i + 1) % angle_bins)):
            bearing = (i + part) * width
            scan = sweeps([[np.nan, 2.0, np.nan]], [bearing - 0.9, bearing, bearing + 0.9], [pose(0, 0)])
            assert np.flatnonzero(virtual(scan, angle_bins=angle_bins) == 2.0) == [expected]


def test_an_upside_down_scanner_is_mirrored():
    room = rectangle(-1, -2, 3, 4)
    seen = virtual(look_around(room, 0, 0, 0.4, ALL_ROUND, upside_down=True))
    assert seen[[0, 90, 180, 270]] == pytest.approx([3, 4, 1, 2], abs=0.01)


def test_a_clockwise_scanner_sees_the_same_room():
    room = rectangle(-1, -2, 3, 4)
    np.testing.assert_allclose(
        virtual(look_around(room, 0, 0, 0.4, fan(721, -360))),
        virtual(look_around(room, 0, 0, 0.4, ALL_ROUND)),
        atol=0.03,
    )


def test_a_tilted_scanner_is_laid_flat_in_three_dimensions():
    """Pitched by 60 degrees about y: what lies ahead is half as far in the plane, what lies aside as far."""
    half = math.cos(math.radians(60))
    pitched = np.array([[half, 0, math.sin(math.radians(60)), 0], [0, 1, 0, 0], [0, 0, half, 1.0]])
    seen = virtual(sweeps([np.full(721, 4.0)], ALL_ROUND, [pitched]))
    assert seen[[0, 89, 180, 269]] == pytest.approx([2, 4, 2, 4], abs=0.01)


def test_a_scanner_beside_the_robots_middle_is_placed_by_its_own_pose():
    scan = sweeps([np.full(721, 1.0)], ALL_ROUND, [pose(0.4, 0.0, math.pi / 2)])
    seen = virtual(scan)
    assert seen[[0, 180]] == pytest.approx([1.4, 0.6], abs=0.005)


@pytest.mark.parametrize("upside_down", [False, True])
def test_every_beam_of_a_moving_robot_has_its_own_pose(upside_down):
    """Driving 0.3 m and turning 20 degrees within a scan; without time per beam walls are 0.3 m off."""
    scan = drive_past(ROOM, (0.0, 0.0, 0.1), (0.3, 0.1, 0.45), fan(721, 360), upside_down=upside_down)
    seen = virtual(scan, 0.1, 0.1)
    true = seen_from(ROOM, 0.1, 0.1, 360)
    hit = np.isfinite(seen)
    assert hit.sum() > 320
    assert ((seen > true[:, 0] - 0.02) & (seen < true[:, 1] + 0.05))[hit].mean() > 0.985
    at_once = sweeps(scan.ranges, scan.bearings, scan.map_from_laser_first)
    frozen = virtual(at_once, 0.1, 0.1)
    assert ((frozen > true[:, 0] - 0.02) & (frozen < true[:, 1] + 0.05))[np.isfinite(frozen)].mean() < 0.7


# ------------------------------------------------------------------ one value per angle bin


@pytest.mark.parametrize("upside_down", [False, True])
@pytest.mark.parametrize("turn", [-1.0, -0.3, 0.0, 0.02, 0.5, 1.0])
def test_the_ends_of_a_sweep_that_turns_far_are_where_they_were_measured(turn, upside_down):
    """10 m away, one centimetre."""
    bearings = fan(181, 180)
    first, last = pose(0, 0, 0.3, upside_down=upside_down), pose(0, 0, 0.3 + turn, upside_down=upside_down)
    found = outlines(sweeps([np.full(181, 10.0)], bearings, [first], [last]), np.zeros((1, 2)), FREE, 360)
    yaw = 0.3 + turn * np.arange(181) / 180 + (-bearings if upside_down else bearings)
    assert found.x[0, :181] == pytest.approx(10 * np.cos(yaw), abs=0.01)
    assert found.y[0, :181] == pytest.approx(10 * np.sin(yaw), abs=0.01)


def test_of_several_beams_in_an_angle_bin_the_nearest_point_counts():
    room = np.concatenate((SQUARE, pillar(2.0, 0.3, 0.1)))
    seen = virtual(look_around(room, 0, 0, 0, fan(1441, 360)), angle_bins=12)
    nearest = seen_from(room, 0, 0, 12)[:, 0]
    np.testing.assert_allclose(seen, nearest, atol=0.01)


def test_ranges_stay_measured_ones():
    """No mean of beams, no point between two of them."""
    scan = look_around(ROOM, 0.4, 0.2, 0.3, fan(361, 360))
    directions = map_directions(scan.map_from_laser_first[0], scan.bearings)
    points = (0.4, 0.2) + scan.ranges[0][:, None] * np.stack((np.cos(directions), np.sin(directions)), 1)
    measured = np.linalg.norm(points - (-0.2, 0.5), axis=1)
    seen = virtual(scan, -0.2, 0.5)
    distance = np.abs(seen[np.isfinite(seen)][:, None] - measured).min(axis=1)
    assert len(distance) > 300
    assert distance.max() < 0.001


# ------------------------------------------------------------------ clear, and no evidence


def test_a_missing_return_is_clear():
    seen = virtual(sweeps([np.full(721, np.inf)], ALL_ROUND, [pose(0, 0)]))
    assert np.isposinf(seen).all()


def test_a_range_beyond_the_nodes_radius_is_clear():
    scan = sweeps([np.full(721, 3.0)], ALL_ROUND, [pose(0, 0)])
    assert np.isposinf(virtual(scan, radius=2.99)).all()
    np.testing.assert_array_equal(virtual(scan, radius=3.0), np.full(360, 3.0))


def test_no_evidence_is_neither_clear_nor_a_range():
    ranges = np.full(721, np.inf)
    ranges[300:421] = np.nan  # 60 degrees ahead
    seen = virtual(sweeps([ranges], ALL_ROUND, [pose(0, 0)]))
    assert np.isnan(seen[:30]).all()
    assert np.isnan(seen[-30:]).all()
    assert np.isposinf(seen[31:-31]).all()


def test_a_missing_return_frees_only_out_to_the_scanners_range():
    ranges = [np.full(721, np.inf)]
    short = virtual(sweeps(ranges, ALL_ROUND, [pose(0, 0)], clear_range=8.0))
    assert np.isnan(short).all()
    assert np.isposinf(virtual(sweeps(ranges, ALL_ROUND, [pose(0, 0)], clear_range=10.1))).all()


def test_a_short_free_beam_between_far_hits_leaves_its_angle_bin_open():
    """Both borders are free beyond the radius; what the beam between them says ends at 8 m."""
    ranges = np.full(1200, 12.0)
    ranges[1] = np.inf  # bearing 0.5 degrees
    bearings = np.radians(0.2 + 0.3 * np.arange(1200))
    seen = virtual(sweeps([ranges], bearings, [pose(0, 0)], clear_range=8.0))
    assert np.isnan(seen[0])
    assert np.isposinf(seen[1:]).all()


def test_off_the_centre_the_scanners_range_ends_the_clear_part():
    """From 1 m aside, 10.3 m of free beams reach beyond 10 m only on the robot's side."""
    scan = sweeps([np.full(721, np.inf)], ALL_ROUND, [pose(1.0, 0.0)], clear_range=10.3)
    clear = np.isposinf(virtual(scan))
    bearing = np.radians(np.arange(360) + 0.5)
    reach = np.cos(bearing) + np.sqrt(10.3**2 - np.sin(bearing) ** 2)
    sure = np.abs(reach - 10.0) > 0.05
    np.testing.assert_array_equal(clear[sure], (reach > 10.0)[sure])


def test_a_missing_return_next_to_a_hit_does_not_erase_it():
    ranges = np.full(721, np.inf)
    ranges[360] = 2.0  # bearing 0
    seen = virtual(sweeps([ranges], ALL_ROUND, [pose(0, 0)]), angle_bins=36)
    assert seen[0] == 2.0
    assert np.isposinf(seen[2:-2]).all()


@pytest.mark.parametrize("missing", [1, 2])
def test_one_or_two_beams_without_evidence_are_bridged(missing):
    ranges = np.full(361, np.inf)
    ranges[180 : 180 + missing] = np.nan
    assert np.isposinf(virtual(sweeps([ranges], fan(361, 360), [pose(0, 0)]))).all()


def test_three_beams_without_evidence_are_a_gap():
    ranges = np.full(361, np.inf)
    ranges[180:183] = np.nan
    assert np.isnan(virtual(sweeps([ranges], fan(361, 360), [pose(0, 0)]))).any()


# ------------------------------------------------------------------ what an off-centre robot may claim

WALL_WITH_DOOR = np.array([(2.0, -5.0, 2.0, -0.5), (2.0, 0.5, 2.0, 5.0)])
OFFICE = np.concatenate((rectangle(-2, -5, 6, 5), WALL_WITH_DOOR))


def test_the_far_side_of_a_shadow_beside_a_door_is_not_learnt():
    """The robot looks through the door at a slant and sees what from the node is hidden behind the wall."""
    robot, node = (1.2, -0.7), (1.2, 0.3)
    scan = look_around(OFFICE, *robot, 0.0, ALL_ROUND)
    true = seen_from(OFFICE, *node, 360)
    seen = virtual(scan, *node)
    points = np.array(robot) + scan.ranges[0].astype(float)[:, None] * np.stack(
        (np.cos(ALL_ROUND), np.sin(ALL_ROUND)), 1
    )
    hidden = (
        cast(OFFICE, *node, np.arctan2(*(points - node).T[::-1]))
        < np.linalg.norm(points - node, axis=1) - 0.5
    )
    assert hidden.sum() > 10  # the scene is worth its name
    hit = np.isfinite(seen)
    assert hit.sum() > 250
    assert (seen[hit] < true[hit, 1] + 0.1).all()


def test_an_edge_does_not_hide_what_lies_before_it():
    seen = virtual(look_around(OFFICE, 1.2, 0.1, 0.0, ALL_ROUND), 1.2, 0.0)
    assert (~np.isnan(seen)).mean() > 0.9


def test_an_angle_bin_is_clear_only_where_the_whole_ray_was_seen_free():
    """A pillar near the robot hides open space; from the node no part of that shadow is known."""
    scan = look_around(pillar(1.0, 0.0, 0.5), 0.0, 0.0, 0.0, ALL_ROUND)
    seen = virtual(scan, 0.0, 0.9)
    shadow = np.radians(np.arange(-12, 13))  # as seen from the robot, from 1 m on
    points = 4.0 * np.stack((np.cos(shadow), np.sin(shadow)), 1) - (0.0, 0.9)
    bins = (np.degrees(np.arctan2(points[:, 1], points[:, 0])) % 360).astype(int)
    assert np.isnan(seen[bins]).all()
    assert np.isposinf(seen[30:300]).all()


def test_a_narrow_scanner_judges_a_node_behind_it():
    """The robot's own place counts as free: else a scanner would claim nothing for a third of all nodes."""
    scan = look_around(SQUARE, 0.0, 0.0, 0.0, fan(181, 180))
    seen = virtual(scan, -0.9, 0.3)
    ahead = np.isfinite(seen)
    assert ahead.sum() > 80
    true = seen_from(SQUARE, -0.9, 0.3, 360)
    assert ((seen > true[:, 0] - 0.05) & (seen < true[:, 1] + 0.05))[ahead].all()
    assert np.isnan(seen[90:270]).all()


@pytest.mark.parametrize("degrees", [60, 180, 270])
@pytest.mark.parametrize("away", [0.0, 0.5, 1.0, 2.0, 2.35])
def test_a_near_node_is_judged_from_every_side(degrees, away):
    scan = look_around(SQUARE, 0.0, 0.0, 0.0, fan(degrees + 1, degrees))
    for side in np.radians(np.arange(7, 360, 24)):
        assert judges(scan, away * math.cos(side), away * math.sin(side))


@pytest.mark.parametrize("degrees", [60, 180, 270])
@pytest.mark.parametrize("driven", [0.1, 0.25, 0.4])
def test_a_node_that_is_left_behind_within_the_sweep_is_judged(degrees, driven):
    """The arc behind the field of view is where the laser is by then, not where it was at its first beam."""
    for yaw in (0.0, 0.7, -2.0):
        stop = (driven * math.cos(yaw), driven * math.sin(yaw), yaw)
        scan = drive_past(SQUARE, (0.0, 0.0, yaw), stop, fan(degrees + 1, degrees))
        for away in np.arange(0.0, 1.7, 0.2):
            for aside in (-0.2, 0.0, 0.2):
                x = -away * math.cos(yaw) - aside * math.sin(yaw)
                y = -away * math.sin(yaw) + aside * math.cos(yaw)
                assert judges(scan, x, y)


def test_a_node_to_which_no_way_is_known_must_be_seen_or_be_where_the_robot_stands():
    scan = look_around(SQUARE, 0.0, 0.0, 0.0, fan(181, 180))
    assert judges(scan, 0.9, 0.3, way=UNKNOWN)
    assert judges(scan, -0.2, 0.1, way=UNKNOWN)
    assert not judges(scan, -0.9, 0.3, way=UNKNOWN)


def test_a_node_far_behind_a_narrow_scanner_is_not_judged():
    """The disc where the robot stands is small: it does not reach to where it never was."""
    scan = sweeps([np.full(181, 20.0)], fan(181, 180), [pose(0, 0)])
    assert judges(scan, 2.3, 0.0)
    assert judges(scan, 6.0, 0.0)
    assert not judges(scan, -3.0, 0.0)
    assert not judges(scan, -12.0, 0.0)


@pytest.mark.parametrize("radius", [1.5, 2.0, 4.0])
@pytest.mark.parametrize("away", [0.5, 0.9, 2.0, 3.5, 6.0])
def test_nothing_is_clear_that_only_the_robots_own_disc_covers(radius, away):
    """Ahead 90 degrees are free. From a node on the left, everything to the right of the robot was never seen."""
    scan = sweeps([np.full(181, 30.0)], fan(181, 90), [pose(0, 0)])
    seen = virtual(scan, 0.0, away, radius=radius)
    assert not np.isfinite(seen).any()
    for i in np.flatnonzero(np.isposinf(seen)):
        ray = np.linspace(0, radius, 50)[:, None]
        x, y = (0.0, away) + ray[-1] * (math.cos(math.radians(i + 0.5)), math.sin(math.radians(i + 0.5)))
        assert abs(y) < x + 0.1


def test_a_node_that_the_scan_did_not_see_learns_nothing():
    scan = look_around(ROOM, 0.0, 0.0, 0.0, ALL_ROUND)
    assert judges(scan, 0.5, 0.5)
    assert not judges(scan, -2.0, 1.4)  # inside the pillar
    assert not judges(scan, -2.5, 1.75)  # behind it
    assert not judges(scan, 3.0, 2.5)  # in the other room
    assert not judges(scan, -4.5, 0.0)  # outside
    ranges, _ = virtual_scans(scan, np.array([[3.0, 2.5]]), FREE, 360, 10.0)
    assert (ranges == UNSEEN).all()


def test_holes_between_beams_of_one_surface_take_the_nearer_beams_range():
    scan = look_around(rectangle(-1.5, -1.5, 1.5, 1.5), 0.3, 0.2, 0.0, fan(361, 360))
    seen = virtual(scan, -0.4, -0.3, angle_bins=720)
    assert np.isfinite(seen).mean() > 0.98
    true = seen_from(rectangle(-1.5, -1.5, 1.5, 1.5), -0.4, -0.3, 720)
    error = np.maximum(true[:, 0] - seen, seen - true[:, 1])[np.isfinite(seen)]
    assert np.median(error) < 0.01
    assert error.max() < 0.1


def test_no_surface_is_imagined_between_beams_far_apart():
    """Beams of 1 degree 15 m away are 0.26 m apart: what lies between them in a finer angle bin is not known."""
    scan = sweeps([np.full(361, 15.0)], fan(361, 360), [pose(0, 0)])
    seen = virtual(scan, angle_bins=1440, radius=20.0)
    assert np.isfinite(seen).sum() <= 361
    assert np.isnan(seen).sum() >= 1079


# ------------------------------------------------------------------ odd scanners, odd nodes


@pytest.mark.parametrize("angle_bins", [12, 13, 360, 361, 720, 3600])
@pytest.mark.parametrize("value", [np.nan, np.inf, 2.0, 0.0])
@pytest.mark.parametrize("beams", [1, 2, 3, 5])
def test_a_handful_of_beams_is_taken(beams, value, angle_bins):
    bearings = fan(beams, min(20.0, 5.0 * (beams - 1)))
    seen = virtual(sweeps([[value] * beams], bearings, [pose(0.2, 0.1)]), angle_bins=angle_bins)
    assert len(seen) == angle_bins
    if beams == 1 or not np.isinf(value):
        assert not np.isposinf(seen).any()
    if math.isnan(value):
        assert np.isnan(seen).all()


def test_two_beams_a_whole_turn_apart_are_taken():
    seen = virtual(sweeps([[2.0, 2.0]], [-math.pi, math.pi], [pose(0.2, 0.1)]))
    assert not np.isposinf(seen).any()


def test_a_drivers_largest_number_is_far_away():
    """Its square overflows; it is clear as a hit at 500 m is."""
    seen = {}
    for value in (500.0, float(np.finfo(np.float32).max)):
        ranges = np.full(361, 4.0)
        ranges[100:110] = value
        seen[value] = virtual(sweeps([ranges], fan(361, 360), [pose(0.5, 0.2)]))
    one, other = seen.values()
    np.testing.assert_array_equal(one, other)
    assert np.isposinf(one).sum() >= 4


def test_one_beam_is_one_range():
    seen = virtual(sweeps([[2.0]], [math.radians(45.2)], [pose(0.0, 0.0)]))
    assert seen_bins(seen) == {45}
    assert seen[45] == 2.0


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_scan_without_any_range_is_taken(value):
    seen = virtual(sweeps([np.full(361, value)], fan(361, 360), [pose(0, 0)]))
    assert np.isnan(seen).all() if math.isnan(value) else np.isposinf(seen).all()


def test_the_robot_on_the_nodes_centre():
    seen = virtual(look_around(SQUARE, 0.0, 0.0, 0.0, ALL_ROUND))
    true = seen_from(SQUARE, 0, 0, 360)
    assert np.isfinite(seen).all()
    assert ((seen > true[:, 0] - 0.002) & (seen < true[:, 1] + 0.002)).all()


def test_a_scanner_whose_last_beam_looks_where_its_first_did():
    """361 beams over 360 degrees, and the two disagree by a centimetre: no gap opens between them."""
    bearings = np.radians(np.arange(361.0))
    ranges = np.full(361, 3.0)
    ranges[-1] = 3.01
    seen = virtual(sweeps([ranges], bearings, [pose(0, 0)]))
    assert np.isfinite(seen).all()
    assert seen.max() <= 3.01
    free = virtual(sweeps([np.full(361, np.inf)], bearings, [pose(0, 0)]))
    assert np.isposinf(free).all()


def test_a_full_circle_without_the_doubled_beam_closes():
    bearings = np.radians(np.arange(360.0))
    assert np.isposinf(virtual(sweeps([np.full(360, np.inf)], bearings, [pose(0, 0)]))).all()


def test_a_node_on_a_wall_harms_nothing():
    for x, y in ((3.0, 0.0), (3.0, 3.0), (2.9999, 0.0), (3.0001, 0.0)):
        ranges, judged = virtual_scans(
            look_around(SQUARE, 2.0, 0.0, 0.0, ALL_ROUND), np.array([[x, y]]), FREE, 360, 10.0
        )
        assert ranges.shape == (1, 360)
        assert not (ranges[~judged] != UNSEEN).any()


def test_a_radius_of_sixty_metres_holds():
    scan = sweeps([np.full(721, 59.9)], ALL_ROUND, [pose(0, 0)], clear_range=80.0)
    assert virtual(scan, radius=60.0) == pytest.approx(np.full(360, 59.9))
    free = sweeps([np.full(721, np.inf)], ALL_ROUND, [pose(0, 0)], clear_range=80.0)
    assert np.isposinf(virtual(free, radius=60.0)).all()


def test_no_scans_give_no_virtual_scans():
    scan = look_around(SQUARE, 0, 0, 0, ALL_ROUND).rows(slice(0, 0))
    ranges, judged = virtual_scans(scan, np.zeros((0, 2)), FREE[:0], 360, 10.0)
    assert ranges.shape == (0, 360)
    assert judged.shape == (0,)
