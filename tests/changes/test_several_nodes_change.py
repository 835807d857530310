"""What several nodes say together."""

import numpy as np
import pytest

from tests.changes.rooms import RADIUS, Box, compare_rings, estimate, ring
from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import ComparedNode, Kind
from timemap_cli.model.nodes import Node

NODES = [Node(-1.0, 0.0), Node(1.0, 0.0)]
BOX = Box(0.0, 2.5)


def rings(boxes=(), nodes=NODES):
    return [ring(node, boxes) for node in nodes]


def test_two_nodes_that_see_the_same_thing_give_one_change():
    (change,) = compare_rings(rings([BOX]), rings(), nodes=NODES).changes
    assert change.kind is Kind.VANISHED
    assert change.nodes == (0, 1)
    assert change.bounds == pytest.approx((-0.3, 2.2, 0.3, 2.8), abs=0.1)  # three faces, by bins of 5 cm


def test_things_farther_apart_than_the_reach_are_two_changes():
    boxes = [Box(0.0, 2.5), Box(0.0, -2.5)]
    changes = compare_rings(rings(), rings(boxes), nodes=NODES).changes
    assert sorted(round(change.y) for change in changes) == [-2, 2]


def test_appeared_and_vanished_surfaces_that_touch_are_two_changes():
    before, after = np.full(360, 8.0), np.full(360, 8.0)
    before[80:100], after[100:140] = 2.0, 2.0
    changes = compare_rings(before, after, nodes=NODES[:1]).changes
    assert [change.kind for change in changes] == [Kind.APPEARED, Kind.VANISHED]


def test_order_of_the_mappings_does_not_matter():
    old = {i: estimate(i, r) for i, r in enumerate(rings([BOX]))}
    new = {i: estimate(i, r) for i, r in enumerate(rings())}
    turned = compare(NODES, dict(reversed(old.items())), new, radius=RADIUS)
    assert turned == compare(NODES, old, new, radius=RADIUS)


def test_what_a_node_known_to_the_older_side_only_showed_another_one_can_see_past():
    old = {0: estimate(0, ring(NODES[0], [BOX])), 1: estimate(1, ring(NODES[1], [BOX]))}
    new = {0: estimate(0, ring(NODES[0]))}
    difference = compare(NODES, old, new, radius=RADIUS)
    (change,) = difference.changes
    assert change.nodes == (0,)
    assert change.bounds == pytest.approx((-0.3, 2.2, 0.3, 2.8), abs=0.1)  # the right face, too
    # from node 1 the box spans bearings 104.04 .. 120.58 degrees: 17 bin centres
    assert difference.nodes[1] == ComparedNode(1, 360, 17)
    assert difference.silent_nodes == ()


def test_nodes_of_two_results_without_a_common_one_are_compared_by_place():
    old, new = {0: estimate(0, ring(NODES[0]))}, {1: estimate(1, ring(NODES[1]))}
    difference = compare(NODES, old, new, radius=RADIUS)
    assert difference.changes == ()
    assert difference.nodes == (ComparedNode(0, 360, 0), ComparedNode(1, 360, 0))
    assert difference.silent_nodes == ()


def test_nodes_that_see_nothing_in_common_are_silent():
    far = [Node(0.0, 0.0), Node(100.0, 0.0)]
    old, new = {0: estimate(0, ring(far[0]))}, {1: estimate(1, ring(far[0]))}
    difference = compare(far, old, new, radius=RADIUS)
    assert (difference.changes, difference.nodes, difference.silent_nodes) == ((), (), (0, 1))


def test_node_not_seen_in_between_is_silent_only_when_times_are_compared():
    old = {0: estimate(0, ring(NODES[0], [BOX]), stamp_ns=5)}
    new = {0: estimate(0, ring(NODES[0]), stamp_ns=5)}
    times = compare(NODES, old, new, radius=RADIUS, only_renewed=True)
    levels = compare(NODES, old, new, radius=RADIUS)
    assert (times.changes, times.silent_nodes) == ((), (0,))
    assert len(levels.changes) == 1
    assert levels.silent_nodes == ()


AROUND = [Node(0.0, 0.0), Node(0.3, 0.0), Node(-0.3, 0.0)]


def with_doubters(had: list[list[Box]], *, stamp_ns: int = 9, samples: int = 20):
    """Node 0 saw a box vanish between 1 and 9 ns; the others, who had what is given, show the same still.

    The stamp is that of the others' later estimates, the samples those of both.
    """
    old = {0: estimate(0, ring(AROUND[0], [BOX]), stamp_ns=1)}
    new = {0: estimate(0, ring(AROUND[0]), stamp_ns=9)}
    for i, boxes in enumerate(had, start=1):
        old[i] = estimate(i, ring(AROUND[i], boxes), stamp_ns=1, samples=samples)
        new[i] = estimate(i, ring(AROUND[i], boxes), stamp_ns=stamp_ns, samples=samples)
    return compare(AROUND, old, new, radius=RADIUS, only_renewed=True)


def test_thing_that_most_nodes_never_had_is_not_reported():
    difference = with_doubters([[], []])
    assert difference.changes == ()
    assert difference.changed_bins == 0


def test_thing_that_one_node_had_and_another_never_is_in_doubt():
    assert with_doubters([[]]).changes == ()


def test_two_witnesses_outvote_one_doubter():
    before = [ring(AROUND[0], [BOX]), ring(AROUND[1], [BOX]), ring(AROUND[2])]
    assert len(compare_rings(before, rings(nodes=AROUND), nodes=AROUND).changes) == 1


def test_more_than_half_of_the_looks_must_have_adopted_the_change():
    assert with_doubters([[BOX], [BOX]]).changes == ()  # one of three sees past it
    assert with_doubters([[BOX]]).changes == ()  # one of two
    assert len(with_doubters([[], [BOX]]).changes) == 1  # two of three, and two of three had it


def test_node_not_seen_again_has_a_vote_on_the_older_side_only():
    assert len(with_doubters([[BOX], [BOX]], stamp_ns=1).changes) == 1
    assert with_doubters([[], []], stamp_ns=1).changes == ()  # two of three never had it


@pytest.mark.parametrize(("samples", "changes"), [(2, 1), (3, 0)])
@pytest.mark.parametrize("had", [[[], []], [[BOX], [BOX]]])
def test_node_that_looked_less_than_three_times_has_no_vote(had, samples, changes):
    assert len(with_doubters(had, samples=samples).changes) == changes


def test_nodes_whose_view_is_blocked_have_no_vote():
    nodes = [Node(0.0, 0.0), Node(0.0, 4.5), Node(0.4, 4.5)]
    screen = Box(0.0, 3.6, 6.0, 0.2)  # stands between the box and the two other nodes
    before = [ring(nodes[0], [BOX, screen]), ring(nodes[1], [screen]), ring(nodes[2], [screen])]
    after = [ring(node, [screen]) for node in nodes]
    (change,) = compare_rings(before, after, nodes=nodes).changes
    assert change.nodes == (0,)


def test_every_compared_node_is_listed_with_its_bins():
    far = Node(0.0, -4.0)
    nodes = [Node(0.0, 0.0), far]
    screen = Box(0.0, -2.0, 9.0, 0.2)
    before = [ring(nodes[0], [BOX, screen]), ring(far, [BOX, screen])]
    after = [ring(nodes[0], [screen]), ring(far, [screen])]
    difference = compare_rings(before, after, nodes=nodes)
    # the face at y = 2.2 spans atan(0.3 / 2.2) = 7.77 degrees either way: 16 bin centres
    assert difference.nodes == (ComparedNode(0, 360, 16), ComparedNode(1, 360, 0))
