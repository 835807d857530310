"""What differs between two sides whose nodes looked from different places."""

import numpy as np
import pytest

from tests.changes.rooms import OUTDOORS, RADIUS, Box, estimate, estimates, ring, wall, walls
from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Kind
from timemap_cli.model.nodes import Node

A, B = Node(-1.5, 0.0), Node(1.5, 0.0)
BOX = Box(0.0, 2.3)
MINUTE = 60 * 10**9


def seen_by(number: int, *boxes: Box, stamp_ns: int = 1):
    return {number: estimate(number, ring((A, B)[number], boxes), stamp_ns=stamp_ns)}


def changes(old, new, nodes=(A, B), **values):
    return compare(nodes, old, new, radius=RADIUS, **values).changes


def test_a_box_that_one_node_held_and_only_another_one_sees_past_has_vanished():
    (change,) = changes(seen_by(0, BOX), seen_by(1))
    assert (change.kind, change.nodes) == (Kind.VANISHED, (1,))
    assert (change.x, change.y) == pytest.approx((-0.1, 2.1), abs=0.15)  # of the faces that A saw


def test_a_box_that_one_node_shows_where_another_one_saw_past_has_appeared():
    (change,) = changes(seen_by(0), seen_by(1, BOX))
    assert (change.kind, change.nodes) == (Kind.APPEARED, (0,))
    assert (change.x, change.y) == pytest.approx((0.1, 2.1), abs=0.15)  # of the faces that B sees


def test_a_box_that_both_show_from_either_side_is_no_change():
    assert changes(seen_by(0, BOX), seen_by(1, BOX)) == ()


def test_what_a_side_knew_better_since_is_no_change_to_a_side_that_knows_it():
    """A was not passed again and shows the box; B has seen since that it went: the sides say the same."""
    old = seen_by(0, BOX) | seen_by(1, stamp_ns=20 * MINUTE)
    new = seen_by(0, stamp_ns=30 * MINUTE) | seen_by(1, stamp_ns=30 * MINUTE)
    assert changes(old, new) == ()
    assert changes(seen_by(0, BOX), new)[0].kind is Kind.VANISHED


def test_between_two_times_a_node_not_passed_again_leaves_the_word_to_the_others():
    board = wall(-0.5, 2.0, 0.5, 2.1)  # of which both see the same face
    old = seen_by(0, board) | seen_by(1, board)
    new = seen_by(0, board) | seen_by(1, stamp_ns=2)
    assert changes(old, new) == ()  # one says so, one not
    (change,) = changes(old, new, only_renewed=True)
    assert (change.kind, change.nodes) == (Kind.VANISHED, (1,))


def test_a_box_carried_from_what_one_node_saw_to_what_another_one_sees_has_moved():
    """Two rooms with a door between them, a node in each of them; the box stood in one and stands in the other."""
    rooms = [*walls(-6.0, -3.0, 6.0, 3.0), wall(-0.1, -3.0, 0.1, -0.6), wall(-0.1, 0.6, 0.1, 3.0)]
    nodes = [Node(-4.5, -1.5), Node(-1.5, 1.8), Node(1.5, 1.8), Node(4.5, -1.5)]
    here, there = Box(-3.5, 0.3, 0.9, 0.5), Box(3.0, 0.2, 0.9, 0.5)
    sides = [estimates(nodes, [*rooms, box], wall=OUTDOORS) for box in (here, there)]
    (change,) = changes(*sides, nodes=nodes)
    assert change.kind is Kind.MOVED
    assert (change.x, change.y) == pytest.approx((3.0, 0.2), abs=0.3)
    assert change.moved_from == pytest.approx((-3.5, 0.3), abs=0.3)
    assert set(change.nodes) == {0, 1, 2, 3}


def test_two_drives_on_two_lanes_of_a_hall_differ_by_what_changed_alone():
    hall = [*walls(-8.0, -4.0, 8.0, 4.0), Box(-2.0, 0.0, 0.5, 0.5), Box(2.0, 0.0, 0.5, 0.5)]
    gone, come = Box(-4.0, 3.0, 0.8, 0.6), Box(5.0, -3.0, 1.2, 0.6)
    lanes = [[Node(float(x), y) for x in range(-6, 8, 2)] for y in (-1.5, 1.5)]
    nodes = lanes[0] + lanes[1]
    monday = {i: estimate(i, ring(node, [*hall, gone], OUTDOORS)) for i, node in enumerate(lanes[0])}
    friday = {
        i: estimate(i, ring(node, [*hall, come], OUTDOORS)) for i, node in enumerate(lanes[1], len(monday))
    }
    found = compare(nodes, monday, friday, radius=RADIUS)
    assert sorted((c.kind.value, round(c.x), round(c.y)) for c in found.changes) == [
        ("appeared", 5, -3),
        ("vanished", -4, 3),
    ]
    assert found.silent_nodes == ()
    empty = {i: estimate(i, ring(node, hall, OUTDOORS)) for i, node in enumerate(nodes)}
    quiet = [{i: empty[i] for i in some} for some in (monday, friday)]
    assert compare(nodes, *quiet, radius=RADIUS).changes == ()


def test_a_side_without_estimates_is_silent():
    difference = compare([A, B], {}, seen_by(1), radius=RADIUS)
    assert (difference.changes, difference.nodes, difference.silent_nodes) == ((), (), (1,))


def test_unknown_rings_are_silent():
    blind = {0: estimate(0, np.full(360, np.nan))}
    assert compare([A, B], blind, seen_by(1), radius=RADIUS).silent_nodes == (0, 1)
