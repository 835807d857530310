"""Which node a scan goes to."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import NO_NODE, Placement


def assigned(placement, *places):
    return placement.assign(np.array(places, float).reshape(-1, 2))[0].tolist()


def test_the_first_scan_makes_a_node_where_the_robot_is():
    placement = Placement(1.0)
    assert assigned(placement, (3.0, -4.0)) == [0]
    assert placement.nodes == [Node(3.0, -4.0)]


def test_a_node_is_made_beyond_the_spacing_and_not_at_it():
    placement = Placement(1.0)
    assert assigned(placement, (0, 0), (1.0, 0), (0, -1.0), (1.001, 0)) == [0, 0, 0, 1]
    assert placement.nodes == [Node(0, 0), Node(1.001, 0)]


def test_a_scan_goes_to_the_nearest_node_alone():
    placement = Placement(1.0)
    assigned(placement, (0, 0), (1.5, 0))
    assert assigned(placement, (0.7, 0), (0.8, 0), (0.75, 0)) == [0, 1, 0]


def test_a_node_never_moves():
    placement = Placement(1.0)
    assigned(placement, (0, 0))
    for i in range(50):
        assigned(placement, (0.5, 0.01 * i))
    assert placement.nodes == [Node(0, 0)]


def test_given_nodes_are_all_there_will_be():
    placement = Placement(1.0, [Node(0, 0), Node(5, 0)])
    assert assigned(placement, (0.4, 0), (4.2, 0), (2.5, 0), (90, 90)) == [0, 1, NO_NODE, NO_NODE]
    assert len(placement.nodes) == 2


def test_nodes_stand_on_whole_millimetres():
    placement = Placement(1.0)
    assigned(placement, (0.12345678, -7.00049))
    assert placement.nodes == [Node(0.123, -7.0)]


def test_nodes_stand_farther_apart_than_the_spacing_and_every_scan_has_one_near():
    places = np.random.default_rng(2).uniform(-6, 6, (600, 2))
    placement = Placement(1.5)
    nodes, _ = placement.assign(places)
    centres = placement.centres
    apart = np.linalg.norm(centres[:, None] - centres, axis=2) + np.eye(len(centres)) * 9
    assert apart.min() > 1.5 - 0.002
    assert np.linalg.norm(places - centres[nodes], axis=1).max() <= 1.5


@pytest.mark.parametrize("block", [1, 7, 100])
def test_nodes_do_not_depend_on_blocks(block):
    places = np.cumsum(np.random.default_rng(3).normal(0, 0.3, (300, 2)), axis=0)
    whole, pieces = Placement(1.0), Placement(1.0)
    expected = whole.assign(places)[0].tolist()
    parts = [pieces.assign(places[i : i + block])[0] for i in range(0, 300, block)]
    assert np.concatenate(parts).tolist() == expected
    assert pieces.nodes == whole.nodes


def test_no_scans_make_no_node():
    placement = Placement(1.0)
    assert assigned(placement) == []
    assert placement.centres.shape == (0, 2)


def test_a_place_that_is_not_finite_has_no_node_and_makes_none():
    placement = Placement(1.0)
    assert assigned(placement, (0.0, 0.0), (math.nan, 0.0), (0.0, math.inf), (5.0, 0.0)) == [0, -1, -1, 1]
    assert placement.nodes == [Node(0.0, 0.0), Node(5.0, 0.0)]


def test_every_scan_knows_the_nodes_of_those_before_it_and_its_own():
    placement = Placement(1.0)
    _, known = placement.assign(np.array([(0.0, 0.0), (0.5, 0.0), (2.0, 0.0), (4.0, 0.0), (4.1, 0.0)]))
    assert known.tolist() == [1, 1, 2, 3, 3]


def farther(placement, places, known, choice):
    near, node = placement.farther(np.array(places, float), np.array(known), choice)
    return [number if there else None for there, number in zip(near.tolist(), node.tolist(), strict=True)]


def test_farther_nodes_come_in_the_order_of_their_distance():
    placement = Placement(1.0, [Node(0, 0), Node(0.6, 0), Node(-0.8, 0), Node(5, 0)])
    places = [(0.1, 0.0), (5.0, 0.0)]
    assert farther(placement, places, [4, 4], 1) == [1, None]
    assert farther(placement, places, [4, 4], 2) == [2, None]
    assert farther(placement, places, [4, 4], 3) == [None, None]
    assert farther(placement, places, [4, 4], 4) == [None, None]


def test_nodes_that_were_made_later_are_no_choice():
    placement = Placement(1.0, [Node(0, 0), Node(0.6, 0)])
    assert farther(placement, [(0.1, 0.0)] * 2, [1, 2], 1) == [None, 1]
    assert Placement(1.0).farther(np.empty((0, 2)), np.empty(0, np.int64), 1)[0].tolist() == []


def test_an_inserted_node_undoes_those_made_from_its_number_on():
    placement = Placement(1.0)
    placement.assign(np.array([(0.0, 0.0), (2.0, 0.0), (4.0, 0.0)]))
    placement.insert(np.array([0.51234, 0.0]), 1)
    assert placement.nodes == [Node(0, 0), Node(0.512, 0)]


def test_there_are_never_more_nodes_than_the_bound_however_far_the_robot_jumps(monkeypatch):
    monkeypatch.setattr("timemap_cli.model.placement.MOST_NODES", 3)
    placement = Placement(1.0)
    jumps = np.array([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0], [30.0, 0.0], [10.2, 0.0], [np.nan, 0.0]])
    assert placement.assign(jumps)[0].tolist() == [0, 1, 2, NO_NODE, 1, NO_NODE]
    assert placement.assign(jumps)[0].tolist() == [0, 1, 2, NO_NODE, 1, NO_NODE]
    assert len(placement.nodes) == 3


@given(st.lists(st.tuples(st.integers(-30, 30), st.integers(-30, 30)), max_size=40), st.integers(1, 40))
def test_each_scan_goes_where_one_after_the_other_would(steps, at_once):
    """Against the rule written down plainly: the nearest node within the spacing, else a new one."""
    places = np.array(steps, np.float64).reshape(-1, 2) / 10
    expected, nodes = [], []
    for x, y in places.tolist():
        squares = [(x - a) * (x - a) + (y - b) * (y - b) for a, b in nodes]
        if not squares or min(squares) > 1.0:
            nodes.append((x, y))
            squares.append(0.0)
        expected.append(squares.index(min(squares)))
    placement = Placement(1.0)
    found = [placement.assign(places[i : i + at_once])[0] for i in range(0, len(places), at_once)]
    assert [node for some in found for node in some.tolist()] == expected
    assert [(node.x, node.y) for node in placement.nodes] == nodes
