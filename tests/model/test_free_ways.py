"""When the way from the laser to its node is known to be free: what was seen, and where the robot was."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.model.scenes import cast, fan, map_directions, pose, rectangle, sweeps
from timemap_cli.model.free_ways import ROBOT_RADIUS, FreeWays

NARROW = fan(181, 180)
HALL = rectangle(-6, -4, 6, 4)
WALL = rectangle(-6, -0.05, 3, 0.05)  # along the hall, open at its right end
EAST, NORTH, WEST, SOUTH = 0.0, math.pi / 2, math.pi, -math.pi / 2


def drive(walls, places, bearings=NARROW, *, upside_down=False):
    """Scans at these places (x, y, yaw), ten a second."""
    poses = [pose(*place, upside_down=upside_down) for place in places]
    ranges = [
        cast(walls, x, y, map_directions(placed, bearings))
        for (x, y, _), placed in zip(places, poses, strict=True)
    ]
    return sweeps(ranges, bearings, poses)


def along(*corners, step=0.1):
    """Places (x, y, yaw) on straight lines between corners, looking ahead."""
    places = []
    for (x1, y1), (x2, y2) in pairwise(corners):
        count = round(math.hypot(x2 - x1, y2 - y1) / step)
        yaw = math.atan2(y2 - y1, x2 - x1)
        places += [(x1 + (x2 - x1) * i / count, y1 + (y2 - y1) * i / count, yaw) for i in range(count + 1)]
    return places


def known(ways, scans, centres):
    """Whether each scan knows a free way to its centre (n, 2), or to the one for all."""
    rows = np.arange(len(scans))
    return ways.look(scans).free(rows, np.broadcast_to(np.asarray(centres, float), (len(scans), 2)))


def free(scans, x, y):
    """Whether each scan knows a free way to (x, y)."""
    return known(FreeWays(), scans, (x, y)).tolist()


@pytest.mark.parametrize("upside_down", [False, True])
@pytest.mark.parametrize("degrees", [180, -180, 270, 360, -359])
@pytest.mark.parametrize("yaw", [0.0, 1.0, 2.5, -2.0])
def test_a_single_scan_knows_the_ways_that_it_sees(degrees, yaw, upside_down):
    scan = drive(HALL, [(0.0, 1.0, yaw)], fan(abs(degrees) + 1, degrees), upside_down=upside_down)
    for bearing in np.radians(np.arange(-177, 180, 10)):
        x, y = 0.9 * math.cos(yaw + bearing), 1.0 + 0.9 * math.sin(yaw + bearing)
        assert free(scan, x, y) == [abs(bearing) < math.radians(abs(degrees) / 2)]


def test_no_way_leads_through_what_a_scan_hit():
    scan = drive(np.concatenate((HALL, WALL)), [(0.0, 0.6, SOUTH)])
    assert free(scan, 0.0, 0.1) == [True]
    assert free(scan, 0.0, -0.1) == free(scan, 0.3, -0.3) == [False]


def test_where_the_robot_stands_is_free_on_every_side():
    scan = drive(HALL, [(0.0, 1.0, EAST)])
    assert free(scan, -ROBOT_RADIUS + 0.01, 1.0) == [True]
    assert free(scan, -ROBOT_RADIUS - 0.2, 1.0) == [False]


def test_a_robot_that_drove_on_knows_the_way_back():
    assert all(free(drive(HALL, along((-2, 1), (0, 1)), fan(61, 60)), -2.0, 1.0))


def blind(places, pause_ns):
    """Scans without evidence at these places, so long one after the other."""
    poses = [pose(*place) for place in places]
    stamps_ns = np.arange(len(places)) * pause_ns
    return sweeps(np.full((len(places), 181), math.nan), NARROW, poses, stamps_ns=stamps_ns)


def test_the_straight_way_between_two_scans_a_moment_apart_is_free():
    scans = blind([(0.0, 1.0, EAST), (0.7, 1.0, EAST), (1.4, 1.0, EAST)], 10**9)
    assert free(scans, 0.0, 1.0) == [True, True, True]
    assert free(scans, 0.3, 1.0 + ROBOT_RADIUS - 0.02) == [False, True, True]
    assert free(scans, 0.3, 1.0 + ROBOT_RADIUS + 0.02) == [False, False, False]


@pytest.mark.parametrize(
    ("places", "pause_ns"),
    [
        ([(0.0, 1.0, EAST), (0.7, 1.0, EAST)], 10**9 + 1),  # it may have gone any way
        ([(0.0, 1.0, EAST), (0.7, 1.0, NORTH)], 10**8),  # round the end of a wall
        ([(0.0, 1.0, EAST), (1.1, 1.0, EAST)], 10**8),  # the pose jumped
    ],
)
def test_the_way_between_two_scans_is_not_known_where_it_may_not_have_been_straight(places, pause_ns):
    assert free(blind(places, pause_ns), 0.0, 1.0) == [True, False]


def test_the_way_between_two_scans_is_known_in_other_blocks_and_in_a_later_replay():
    scans = blind([(0.0, 1.0, EAST), (0.7, 1.0, EAST), (1.4, 1.0, EAST)], 10**9)
    ways, centres = FreeWays(), np.array([[0.0, 1.0]])
    for i in range(3):
        resumed = FreeWays()
        resumed.restore(ways.kept())
        ways = resumed
        assert known(ways, scans.rows(slice(i, i + 1)), centres)[0]


@pytest.mark.parametrize("step", [0.3, 0.5, 0.8])
def test_seldom_scans_know_no_way_through_a_thin_wall(step):
    walls = np.concatenate((HALL, WALL))
    for first in np.arange(0.0, step, 0.1):
        places = along((1.0 + first, 0.4), (3.4, 0.4), (3.4, -0.4), (1.0, -0.4), step=0.1)
        places = places[:: round(step / 0.1)]
        scans = drive(walls, places, fan(271, 270))
        scans = dataclasses.replace(scans, stamps_ns=np.arange(len(places)) * 10**9)
        other_side = np.array([place[1] < 0 and place[0] < 2.4 for place in places])
        assert not np.array(free(scans, 1.0 + first, 0.4))[other_side].any()


def test_a_node_beside_the_track_is_known_from_the_scans_that_saw_it_ahead():
    scans = drive(HALL, along((-2, 1), (1, 1)))
    assert free(scans, 0.3, 1.6)[-1]
    assert not free(scans.rows(slice(-1, None)), 0.3, 1.6)[0]


def test_a_wall_between_two_tracks_is_no_way_whatever_was_seen_of_its_sides():
    """Along the wall, round its end, and back on its other side: the node is 1 m away, and was 1 m away before."""
    places = along((1.0, 0.5), (3.5, 0.5), (3.5, -0.5), (1.0, -0.5))
    known = free(drive(np.concatenate((HALL, WALL)), places), 1.0, 0.5)
    assert all(known[:25])  # on the node's side
    assert not any(known[-20:])


@pytest.mark.parametrize("thickness", [0.1, 0.3])
@pytest.mark.parametrize("degrees", [180, 270, 360])
def test_a_way_is_never_known_through_a_wall(degrees, thickness):
    random = np.random.default_rng(degrees)
    walls = np.concatenate((HALL, rectangle(-6, -thickness / 2, 3, thickness / 2)))
    for _ in range(20):
        y, x = random.uniform(0.3, 0.6) + thickness / 2, random.uniform(-4, 2)
        places = along((x, y), (3.6, y), (3.6, -y), (x, -y), (-4.5, -y))
        scans = drive(walls, places, fan(degrees + 1, degrees))
        known = np.array(free(scans, x, y))
        other_side = np.array([place[1] < 0 and place[0] < 2.4 for place in places])
        assert not known[other_side].any()


def test_a_jump_of_the_pose_forgets_the_views_before_it():
    there, far = along((-2, 1), (0, 1)), along((-4, -3), (-3, -3))
    scans = drive(HALL, [*there, *far, (0.0, 1.0, EAST)], fan(61, 60))
    assert free(scans, -1.0, 1.0)[len(there) - 1]
    assert not free(scans, -1.0, 1.0)[-1]


def of_scanner(scans, scanner):
    return dataclasses.replace(scans, scanner=scanner)


def two_lasers(walls, places, bearings=NARROW, half=0.4):
    """Scans of a laser at the front that looks ahead and of one at the rear that looks back, in turn."""
    front = [(x + half * math.cos(yaw), y + half * math.sin(yaw), yaw) for x, y, yaw in places]
    rear = [(x - half * math.cos(yaw), y - half * math.sin(yaw), yaw + math.pi) for x, y, yaw in places]
    found = []
    for i, both in enumerate(zip(front, rear, strict=True)):
        for scanner, place in enumerate(both):
            stamp = np.array([100_000_000 * i + 50_000_000 * scanner])
            found.append(
                dataclasses.replace(drive(walls, [place], bearings), stamps_ns=stamp, scanner=scanner)
            )
    return found


def known_ways(scans, x, y):
    """Of each scan in turn, by scanner."""
    ways = FreeWays()
    found = [(one.scanner, bool(known(ways, one, (x, y))[0])) for one in scans]
    return [[free for scanner, free in found if scanner == wanted] for wanted in (0, 1)]


def test_what_one_scanner_saw_counts_for_the_other():
    ways = FreeWays()
    scans = drive(HALL, along((-2, 1), (0, 1)), fan(61, 60))
    ways.look(scans)
    last = of_scanner(scans.rows(slice(-1, None)), 1)
    assert known(ways, last, (-1.0, 1.0))[0]
    assert not known(FreeWays(), last, (-1.0, 1.0))[0]


def test_what_one_scanner_saw_in_an_earlier_replay_counts_for_the_other():
    ways, resumed = FreeWays(), FreeWays()
    scans = drive(HALL, along((-2, 1), (0, 1)), fan(61, 60))
    ways.look(scans)
    resumed.restore(ways.kept())
    assert known(resumed, of_scanner(scans.rows(slice(-1, None)), 1), (-1.0, 1.0))[0]


@pytest.mark.parametrize("changed", ["earlier", "elsewhere"])
def test_what_another_scanner_saw_does_not_count_after_a_jump_or_when_the_clock_begins_anew(changed):
    ways = FreeWays()
    scans = drive(HALL, along((-2, 1), (0, 1)), fan(61, 60))
    scans = dataclasses.replace(scans, stamps_ns=scans.stamps_ns + 10**12)
    ways.look(scans)
    last = of_scanner(scans.rows(slice(-1, None)), 1)
    if changed == "earlier":
        last = dataclasses.replace(last, stamps_ns=last.stamps_ns - 10**11)
    else:
        last = dataclasses.replace(
            drive(HALL, [(2.1, 1.0, EAST)], fan(61, 60)), stamps_ns=last.stamps_ns, scanner=1
        )
    assert not known(ways, last, (-1.0, 1.0))[0]


def test_between_two_scanners_of_a_robot_there_is_no_wall():
    """Both look away from each other, and the node stands where the other one does."""
    scans = two_lasers(HALL, [(0.0, 1.0, EAST)] * 2)
    assert known_ways(scans, 0.4, 1.0) == [[True, True], [True, True]]
    assert known_ways(scans, -0.4, 1.0) == [
        [False, True],
        [True, True],
    ]  # at first the other one is not known
    assert known_ways(scans, 0.0, 1.3) == [[False, False], [False, False]]


def test_where_another_scanner_was_long_ago_says_nothing():
    first, second = two_lasers(HALL, [(0.0, 1.0, EAST)])
    late = dataclasses.replace(second, stamps_ns=second.stamps_ns + 2 * 10**9)
    assert known_ways([first, late], 0.0, 1.0) == [[False], [False]]
    assert known_ways([first, second], 0.0, 1.0) == [[False], [True]]


def test_two_scanners_do_not_know_a_way_through_a_wall():
    places = along((1.0, 0.6), (4.0, 0.6), (4.0, -0.6), (1.0, -0.6), (-4.5, -0.6))
    other_side = np.array([place[1] < 0 and place[0] < 1.9 for place in places])
    for known in known_ways(two_lasers(np.concatenate((HALL, WALL)), places), 1.0, 0.6):
        assert all(known[1:15])  # of the first, the front one knew nothing of the rear one
        assert not np.array(known)[other_side].any()


@pytest.mark.parametrize("upside_down", [False, True])
def test_a_way_is_blocked_where_the_scan_hit_something_before_its_end(upside_down):
    scan = drive(np.concatenate((HALL, WALL)), [(0.0, 0.6, SOUTH)], upside_down=upside_down)
    look, row = FreeWays().look(scan), np.array([0])
    assert look.are_blocked(row, np.array([[0.0, -0.1]]))[0]
    assert look.are_blocked(row, np.array([[0.4, -0.1]]))[0]
    assert not look.are_blocked(row, np.array([[0.0, 0.1]]))[0]  # it stands before the wall
    assert not look.are_blocked(row, np.array([[0.0, 1.6]]))[0]  # the scan looks the other way
    assert not look.are_blocked(row, np.array([[0.0, 0.6]]))[0]
    assert not look.are_blocked(row, np.array([[math.nan, math.nan]]))[0]


def test_a_beam_without_evidence_blocks_nothing():
    scan = sweeps([np.full(181, math.nan)], NARROW, [pose(0, 0)])
    assert not FreeWays().look(scan).are_blocked(np.array([0]), np.array([[0.9, 0.0]]))[0]


def test_no_node_and_no_scan_give_no_way():
    scan = drive(HALL, [(0.0, 1.0, EAST)])
    assert free(scan, math.nan, math.nan) == [False]
    assert free(scan.rows(slice(0, 0)), 0.0, 0.0) == []


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_scan_of_missing_beams_is_taken(value):
    scan = sweeps([np.full(181, value)], NARROW, [pose(0, 0)])
    assert free(scan, 0.9, 0.0) == [value == math.inf]


def test_a_single_beam_and_a_laser_on_edge_are_taken():
    assert free(sweeps([[2.0]], [0.0], [pose(0, 0)]), -0.9, 0.0) == [False]
    on_edge = np.array([[[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0]]])
    assert free(sweeps([np.full(181, 3.0)], NARROW, on_edge), 0.5, 0.5) == [False]


TURNING = drive(
    np.concatenate((HALL, WALL)), along((-1.0, 0.6), (3.6, 0.6), (3.6, -0.6), (0.0, -0.6), step=0.15)
)
TOWARDS = (
    np.random.default_rng(2).uniform(-0.9, 0.9, (len(TURNING), 2)) + TURNING.map_from_laser_first[:, :2, 3]
)
WHOLE = known(FreeWays(), TURNING, TOWARDS)


@given(st.sets(st.integers(1, len(TURNING) - 1), max_size=12))
@settings(max_examples=25)
def test_what_is_known_does_not_depend_on_blocks(cuts):
    ways, borders = FreeWays(), [0, *sorted(cuts), len(TURNING)]
    parts = [slice(*part) for part in pairwise(borders)]
    found = np.concatenate([known(ways, TURNING.rows(part), TOWARDS[part]) for part in parts])
    np.testing.assert_array_equal(found, WHOLE)
    assert 0.2 < WHOLE.mean() < 0.99
