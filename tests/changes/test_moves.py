"""When a vanished and an appeared thing are told as one that moved."""

import numpy as np
import pytest

from tests.changes.rooms import CENTRE, Box, compare_rings, ring
from timemap_cli.changes.difference import Kind
from timemap_cli.model.nodes import Node

HERE, THERE = Box(3.0, 0.0, 0.1, 0.5), Box(3.0, 0.8, 0.1, 0.5)  # a board, its face toward the node


def kinds(difference) -> list[str]:
    return sorted(change.kind.value for change in difference.changes)


def test_box_pushed_aside_has_moved():
    (change,) = compare_rings(ring(CENTRE, [HERE]), ring(CENTRE, [THERE])).changes
    assert change.kind is Kind.MOVED
    assert (change.x, change.y) == pytest.approx((2.95, 0.8), abs=0.03)  # where its face stands now
    assert change.moved_from == pytest.approx((2.95, 0.0), abs=0.02)
    assert change.bounds[1] > 0.4


def test_moved_box_has_the_sector_it_left_and_the_one_it_entered():
    (change,) = compare_rings(ring(CENTRE, [HERE]), ring(CENTRE, [THERE])).changes
    entered, left = change.sectors
    assert (entered.range_from_m, left.range_to_m) == pytest.approx((5.0, 5.0))
    assert left.range_from_m == pytest.approx(2.95, abs=0.02)
    assert entered.range_to_m == pytest.approx(3.06, abs=0.05)
    assert left.start_bin > left.stop_bin  # over bearing 0


def test_box_seen_to_move_by_two_nodes_is_one_change():
    nodes = [Node(0.0, 0.0), Node(0.0, -1.0)]
    before, after = ([ring(node, [box]) for node in nodes] for box in (HERE, THERE))
    (change,) = compare_rings(before, after, nodes=nodes).changes
    assert change.kind is Kind.MOVED
    assert change.nodes == (0, 1)


def test_box_that_went_far_away_vanished_and_another_appeared():
    assert kinds(compare_rings(ring(CENTRE, [HERE]), ring(CENTRE, [Box(3.0, 1.2, 0.1, 0.5)]))) == [
        "appeared",
        "vanished",
    ]


def test_thing_of_another_shape_has_not_moved():
    assert kinds(compare_rings(ring(CENTRE, [HERE]), ring(CENTRE, [Box(3.0, 0.9, 0.1, 0.9)]))) == [
        "appeared",
        "vanished",
    ]


def test_box_shifted_along_itself_leaves_two_edges_in_doubt():
    """Only the ends of a cabinet changed: what lies between may be the same cabinet or not."""
    before, after = Box(3.0, 0.0, 0.4, 1.2), Box(3.0, 0.5, 0.4, 1.2)
    assert kinds(compare_rings(ring(CENTRE, [before]), ring(CENTRE, [after]))) == ["appeared", "vanished"]


def test_two_places_that_fit_leave_it_open_which():
    after = [THERE, Box(3.0, -0.8, 0.1, 0.5)]
    assert kinds(compare_rings(ring(CENTRE, [HERE]), ring(CENTRE, after))) == [
        "appeared",
        "appeared",
        "vanished",
    ]


def test_a_thing_whose_two_places_two_nodes_saw_has_moved():
    nodes = [Node(0.0, 0.0), Node(0.05, 0.0)]
    before, after = ([ring(node, [box]) for node in nodes] for box in (HERE, THERE))
    unknown = slice(10, 30), np.r_[0:8, 352:360]  # node 0 never sees the new place, node 1 never the old one
    for index, gap in enumerate(unknown):
        before[index][gap] = after[index][gap] = np.nan
    (change,) = compare_rings(before, after, nodes=nodes).changes
    assert (change.kind, change.nodes) == (Kind.MOVED, (0, 1))
    assert change.moved_from == pytest.approx((2.95, 0.0), abs=0.03)
