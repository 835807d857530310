"""What one side has and the other sees past, from several nodes."""

import numpy as np
import pytest

from tests.changes.rooms import OUTDOORS, Box, estimate, estimates, ring, side_of, wall, walls
from timemap_cli.changes.lost import Agreement, lost_things
from timemap_cli.changes.rules import Rules
from timemap_cli.model.nodes import Node

RULES = Rules()
A, B = Node(-1.5, 0.0), Node(1.5, 0.0)
BOX = Box(0.0, 2.3)


def lost(having, lacking, nodes=(A, B), rules=RULES, among=None):
    """Things of estimates by node that other estimates lack."""
    sides = [side_of(nodes, side, rules) for side in (having, lacking)]
    return lost_things(*sides, rules, Agreement(0.5, 0.5), among)


def seen_by(number: int, *boxes: Box, node: Node | None = None):
    return {number: estimate(number, ring(node or (A, B)[number], boxes))}


def test_what_one_node_held_another_one_elsewhere_sees_past():
    (thing,) = lost(seen_by(0, BOX), seen_by(1)).things
    assert [run.row for run in thing.runs] == [0]
    x_min, y_min = thing.points.min(axis=0)
    x_max, y_max = thing.points.max(axis=0)
    # the faces to the left and to the south, as node A sees them; along the left one bins are 0.12 m apart
    assert (x_min, y_min, x_max, y_max) == pytest.approx((-0.3, 2.0, 0.3, 2.6), abs=0.12)
    assert thing.alone


def test_where_it_is_seen_past_is_told_along_its_surface():
    (thing,) = lost(seen_by(0, BOX), seen_by(1)).things
    (passed,) = thing.passed
    assert passed.points.min(axis=0) == pytest.approx((-0.3, 2.0), abs=0.06)
    # from B the corners (-0.3, 2.6) and (0.3, 2.0) of the two faces lie at 124.7 and 121 degrees, (-0.3, 2.0) at 132
    assert 120 <= passed.bins.min() <= 122
    assert 130 <= passed.bins.max() <= 132


def test_what_still_stands_for_another_node_is_not_lost():
    assert lost(seen_by(0, BOX), seen_by(1, BOX)).things == ()


def test_what_another_node_cannot_tell_of_is_not_lost():
    screen = wall(-0.6, 1.4, 1.2, 1.6)  # between B and the box
    assert lost(seen_by(0, BOX), seen_by(1, screen)).things == ()
    assert lost(seen_by(0, BOX), {1: estimate(1, np.full(360, np.nan))}).things == ()


def test_told_are_the_ends_of_which_the_other_side_can_tell():
    behind = {1: estimate(1, np.r_[np.full(180, 20.0), np.full(180, np.nan)].clip(max=9.0))}
    told = lost({0: estimate(0, np.full(360, 2.0))}, behind, nodes=(Node(0.0, 0.0), Node(0.0, 0.0))).told
    assert np.flatnonzero(~told[0]).tolist() == list(range(180, 360))


def test_only_the_bins_that_are_asked_for_count():
    among = np.zeros((1, 360), np.bool_)
    assert lost(seen_by(0, BOX), seen_by(1), among=among).things == ()
    among[0, :180] = True
    assert len(lost(seen_by(0, BOX), seen_by(1), among=among).things) == 1


def test_a_wall_at_a_flat_angle_seen_by_another_node_is_not_lost():
    """The wall along y = 0.5 stands. Poses are off by 0.14 m: at 11 to 30 degrees ranges differ by more than a step."""
    nodes = [Node(-1.0, 0.0), Node(1.0, 0.0)]
    hall = walls(-9.0, -3.0, 9.0, 0.5)
    off = {0: estimate(0, ring(Node(-1.0, -0.14), hall, OUTDOORS))}
    has = {1: estimate(1, ring(nodes[1], hall, OUTDOORS))}
    assert lost(off, has, nodes).things == ()
    assert lost(has, off, nodes).things == ()
    touchy = Rules(min_apart_m=0.01)
    assert lost(off, has, nodes, touchy).things + lost(has, off, nodes, touchy).things != ()


@pytest.mark.parametrize(("beside_m", "things"), [(0.1, 0), (0.2, 1)])
def test_a_thing_right_before_a_wall_that_stands_is_a_part_of_it(beside_m, things):
    hall = walls(-9.0, -3.0, 9.0, 0.5)
    nodes = [Node(0.0, 0.0)]
    board = wall(2.0, 0.5 - beside_m, 3.0, 0.5)
    sides = ({0: estimate(0, ring(nodes[0], boxes, OUTDOORS, 1440))} for boxes in ([*hall, board], hall))
    # from here 0.1 m of depth are 0.4 m of range and more
    assert len(lost(*sides, nodes=nodes).things) == things


def with_ghost_walls(confirmed_deg: int):
    """A lone node with a box that no other has; all but this part of its ring lies 0.8 m before the wall."""
    ranges = ring(A, wall=5.0)
    ranges[confirmed_deg:] -= 0.8
    boxed = ring(A, [BOX])
    ranges[40:60] = boxed[40:60]
    return {0: estimate(0, ranges)}


def box_points(things):
    return [
        thing for thing in things if thing.points[:, 1].min() > 1.5 and abs(thing.points[:, 0]).max() < 0.4
    ]


@pytest.mark.parametrize(("confirmed_deg", "believed"), [(0, 0), (100, 0), (180, 1)])
def test_a_lone_witness_must_be_right_about_120_degrees_of_its_ring(confirmed_deg, believed):
    nodes = [A, B, Node(0.0, -1.5)]
    others = {i: estimate(i, ring(nodes[i])) for i in (1, 2)}
    assert len(box_points(lost(with_ghost_walls(confirmed_deg), others, nodes=nodes).things)) == believed


def test_a_lone_witness_that_sees_past_it_itself_is_believed():
    lacking = {0: estimate(0, ring(A))}
    assert len(box_points(lost(with_ghost_walls(0), lacking).things)) == 1


def test_two_witnesses_are_believed():
    held = with_ghost_walls(0)
    ranges = np.full(360, np.nan)
    ranges[110:150] = ring(B, [BOX])[110:150]
    nodes = [A, B, Node(0.0, -1.5)]
    held[1] = estimate(1, ranges)
    found = lost(held, {2: estimate(2, ring(nodes[2]))}, nodes=nodes).things
    assert [sorted({run.row for run in thing.runs}) for thing in found if thing.runs[-1].row == 1] == [[0, 1]]


def test_most_looks_of_the_side_that_has_it_must_show_it():
    nodes = [A, B, Node(0.0, -1.5)]
    without = estimates(nodes)
    assert len(lost(seen_by(0, BOX) | seen_by(1, BOX) | {2: without[2]}, without, nodes=nodes).things) == 1
    assert lost(seen_by(0, BOX) | {1: without[1], 2: without[2]}, without, nodes=nodes).things == ()


def test_older_looks_that_newer_ones_contradict_do_not_have_it():
    """Node A was not passed again after the box went, which B has seen: the side does not have it any more."""
    minute = 60 * 10**9
    held = {
        0: estimate(0, ring(A, [BOX]), stamp_ns=minute),
        1: estimate(1, ring(B), stamp_ns=12 * minute),
    }
    assert lost(held, seen_by(1)).things == ()
    held[1] = estimate(1, np.full(360, np.nan), stamp_ns=12 * minute)
    assert len(lost(held, seen_by(1)).things) == 1


def test_a_part_that_the_side_itself_knows_better_is_left_out():
    """One node of five still shows the whole of a board of which the right half went long ago."""
    nodes = [Node(-0.5 + 0.25 * i, 0.0) for i in range(5)]
    whole, half = wall(-1.0, 2.0, 1.0, 2.1), wall(-1.0, 2.0, 0.0, 2.1)
    held = estimates(nodes, [half]) | {0: estimate(0, ring(nodes[0], [whole]))}
    (thing,) = lost(held, estimates(nodes), nodes).things
    assert thing.points[:, 0].min() == pytest.approx(-1.0, abs=0.05)
    # at 2 m two degrees are 0.08 m, within which the others do not see past the end
    assert thing.points[:, 0].max() == pytest.approx(0.05, abs=0.1)
