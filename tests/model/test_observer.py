"""What becomes of every scan."""

import dataclasses
import math

import numpy as np
import pytest

from tests.model.drives import GATE, OPEN_GATE, drive, observer
from tests.model.scenes import ROOM, drive_past, fan, look_around, pose, rectangle, sweeps
from tests.model.test_free_ways import along
from tests.model.test_free_ways import drive as drive_along
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import gathered
from timemap_cli.model.sweeps import Sweeps

ROUND = fan(361, 360)


def block(*scans):
    """Scans of one scanner as one block, one second apart."""
    return sweeps(
        np.concatenate([scan.ranges for scan in scans]),
        scans[0].bearings,
        np.concatenate([scan.map_from_laser_first for scan in scans]),
        stamps_ns=np.arange(len(scans)) * 10**9,
    )


def test_every_scan_is_used_or_counted():
    """Seen; no given node near; the node behind a wall."""
    scans = block(
        look_around(ROOM, 0.0, 0.0, 0.0, ROUND),
        look_around(ROOM, -3.5, -2.5, 0.0, ROUND),
        look_around(ROOM, 2.0, -1.0, 0.0, ROUND),
    )
    looking = observer(nodes=[Node(0.3, 0.0), Node(2.8, -1.0)], spacing=1.0)
    found = looking.observe(scans)
    assert len(found) == 1
    assert found.nodes.tolist() == [0]
    assert found.stamps_ns.tolist() == [0]
    assert (found.no_node, found.node_not_seen) == (1, 1)


def test_one_scan_goes_into_one_node():
    found = observer(nodes=[Node(0.0, 0.0), Node(0.4, 0.0), Node(0.9, 0.0)], spacing=1.0).observe(
        block(look_around(ROOM, 0.5, 0.0, 0.0, ROUND))
    )
    assert found.nodes.tolist() == [1]
    assert found.ranges.shape == (1, 72)


def test_a_node_that_cannot_be_judged_is_not_passed_by_the_gate():
    """The scan that sees the node passes, though one before it, from the same place, did not see it."""
    behind = look_around(ROOM, 2.0, -1.0, 0.0, ROUND)
    sees = look_around(ROOM, 2.9, -1.0, 0.0, ROUND)
    looking = observer(nodes=[Node(2.8, -1.0)], spacing=1.0)
    found = looking.observe(block(behind, sees, sees))
    assert found.node_not_seen == 1
    assert found.passes.tolist() == [True, False]


def test_a_scan_without_evidence_judges_nothing():
    """Else it would age the memory of its node."""
    found = observer().observe(sweeps([np.full(361, np.nan)], ROUND, [pose(0, 0)]))
    assert len(found) == 0
    assert found.node_not_seen == 1


def test_observations_can_be_taken_in_parts():
    scans = drive(30)
    found = observer().observe(scans)
    one, two = found.part(slice(0, 11)), found.part(slice(11, None))
    np.testing.assert_array_equal(np.concatenate((one.ranges, two.ranges)), found.ranges)
    assert one.nodes.tolist() + two.nodes.tolist() == found.nodes.tolist()
    assert one.passes.tolist() + two.passes.tolist() == found.passes.tolist()


def test_an_empty_block_is_observed():
    found = observer().observe(drive(3).rows(slice(0, 0)))
    assert len(found) == 0
    assert found.ranges.shape == (0, 72)


def test_the_gate_reads_place_and_yaw_of_the_laser():
    standing = [pose(1.0, 0.5, 0.3)] * 2
    turned = pose(1.0, 0.5, 0.3 + math.radians(10))
    moved = pose(1.06, 0.5, 0.3 + math.radians(10))
    scans = Sweeps(
        np.arange(4) * 10**9,
        np.full((4, 361), 1.0, np.float32),
        ROUND,
        30.0,
        np.array([*standing, turned, moved]),
        np.array([*standing, turned, moved]),
        0,
    )
    assert observer(gate=GATE).observe(scans).passes.tolist() == [True, False, True, True]
    assert observer(gate=OPEN_GATE).observe(scans).passes.all()


# Two lanes beside each other with a wall between them that is open at the right end.
LANES = np.concatenate((rectangle(-4, -1, 4, 1), rectangle(-4, -0.05, 3, 0.05)))


def lanes(degrees, step=0.1):
    """A robot goes along one lane, round the wall's end, and back along the other, 0.45 m from the wall."""
    return along((-3.5, 0.45), (3.5, 0.45), (3.5, -0.45), (-3.5, -0.45), step=step), fan(degrees + 1, degrees)


def test_a_scan_whose_nearest_node_is_behind_a_wall_goes_to_the_next_that_it_sees():
    scan = look_around(LANES, 0.0, 0.45, 0.0, ROUND)
    found = observer(nodes=[Node(0.0, -0.2), Node(0.6, 0.7), Node(-0.7, 0.7)], spacing=1.0).observe(scan)
    assert (found.nodes.tolist(), found.node_not_seen) == ([1], 0)


def test_of_given_nodes_none_that_it_sees_is_near_and_none_is_made():
    scan = look_around(LANES, 0.0, 0.45, 0.0, ROUND)
    looking = observer(nodes=[Node(0.0, -0.2), Node(1.5, 0.7)], spacing=1.0)
    found = looking.observe(scan)
    assert (len(found), found.node_not_seen, len(looking.nodes)) == (0, 1, 2)


def test_a_node_is_made_where_a_wall_hides_all_that_are_near():
    looking = observer(spacing=1.0)
    there, behind = (look_around(LANES, 0.0, y, 0.0, ROUND) for y in (-0.45, 0.45))
    found = looking.observe(block(there, behind, behind))
    assert (found.nodes.tolist(), found.node_not_seen) == ([0, 1, 1], 0)
    assert looking.nodes == [Node(0.0, -0.45), Node(0.0, 0.45)]


def test_a_node_that_a_scan_does_not_look_towards_is_no_reason_to_make_one():
    looking = observer(spacing=1.0)
    looking.observe(look_around(LANES, 0.0, 0.45, 0.0, ROUND))
    away = look_around(LANES, 0.6, 0.45, 0.0, fan(181, 180))
    another_day = dataclasses.replace(away, stamps_ns=away.stamps_ns - 1)
    assert looking.observe(another_day).node_not_seen == 1
    assert len(looking.nodes) == 1


def test_a_scan_that_does_not_look_towards_its_nearest_node_goes_to_the_next_that_it_sees():
    scan = look_around(LANES, 0.0, 0.45, 0.0, fan(181, 180))
    looking = observer(nodes=[Node(-0.5, 0.45), Node(0.7, 0.5)], spacing=1.0)
    found = looking.observe(scan)
    assert (found.nodes.tolist(), found.node_not_seen) == ([1], 0)


@pytest.mark.parametrize("degrees", [180, 240, 270])
@pytest.mark.parametrize("step", [0.05, 0.2, 0.4])
@pytest.mark.parametrize("evidence", [True, False])
def test_a_robot_that_drives_forward_loses_no_scan(degrees, step, evidence):
    """Its sweeps take three quarters of the time from scan to scan; one that sees next to nothing knows its own way."""
    hall = rectangle(-10, -3, 10, 3)
    bearings = fan(degrees + 1, degrees)
    places = along((-8.0, 0.5), (8.0, 0.5), step=step)
    scans = block(
        *(drive_past(hall, place, (place[0] + 0.75 * step, *place[1:]), bearings) for place in places)
    )
    if not evidence:
        scans.ranges[:, 5:] = np.nan
    last = scans.map_from_laser_first.copy()
    last[:, 0, 3] += 0.75 * step
    scans = dataclasses.replace(scans, map_from_laser_last=last)
    found = observer(spacing=1.0).observe(scans)
    assert (len(found), found.node_not_seen) == (len(places), 0)


@pytest.mark.parametrize("degrees", [360, 270])
def test_a_robot_between_thin_walls_loses_no_scan(degrees):
    places, bearings = lanes(degrees)
    looking = observer(spacing=1.0)
    found = looking.observe(drive_along(LANES, places, bearings))
    assert found.node_not_seen == 0
    beside = [places[i][1] * looking.nodes[n].y > 0 or places[i][0] > 2.5 for i, n in enumerate(found.nodes)]
    assert all(beside)
    assert len(looking.nodes) <= 20


@pytest.mark.parametrize("size", [1, 5, 23])
def test_nodes_made_behind_walls_do_not_depend_on_blocks(size):
    scans = drive_along(LANES, *lanes(181))
    whole, pieces = observer(spacing=1.0), observer(spacing=1.0)
    expected = whole.observe(scans)
    parts = [pieces.observe(scans.rows(slice(i, i + size))) for i in range(0, len(scans), size)]
    found = gathered(parts)
    assert pieces.nodes == whole.nodes
    assert (found.nodes.tolist(), found.node_not_seen) == (expected.nodes.tolist(), expected.node_not_seen)
    np.testing.assert_array_equal(found.ranges, expected.ranges)
    np.testing.assert_array_equal(found.passes, expected.passes)


def test_a_narrow_scanner_does_not_judge_a_node_behind_a_wall_beside_it():
    """The wall of the smaller room is at x = 2.5; the robots look along it."""
    beside = look_around(ROOM, 2.9, -1.0, math.pi / 2, fan(181, 180))
    looking = observer(nodes=[Node(2.2, -1.0)], spacing=1.0)
    found = looking.observe(beside)
    assert (len(found), found.node_not_seen) == (0, 1)


def test_a_narrow_scanner_judges_the_node_that_it_has_left_behind():
    scans = block(*(look_around(ROOM, x, 0.0, 0.0, fan(181, 180)) for x in (0.0, 0.3, 0.6, 0.9)))
    found = observer(spacing=1.0).observe(scans)
    assert found.nodes.tolist() == [0, 0, 0, 0]
    assert found.node_not_seen == 0
