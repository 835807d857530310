"""What becomes of every scan."""

import math

import numpy as np

from tests.model.drives import GATE, OPEN_GATE, drive, observer
from tests.model.scenes import ROOM, fan, look_around, pose, sweeps
from timemap_cli.model.nodes import Node
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
