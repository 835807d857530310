"""When a vanished and an appeared thing are told as one that moved."""

from dataclasses import dataclass

import numpy as np
import pytest

from tests.changes.rooms import CENTRE, Box, compare_rings, ring
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.moves import pair_moves
from timemap_cli.changes.rules import Rules
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


ROUND = [Node(0.0, -3.0), Node(-3.0, 3.0), Node(3.0, 3.0)]  # from which two sides and more are seen
CART = Box(-1.5, 0.0, 0.9, 0.5)


def told(after: list[Box], before: Box = CART) -> list[str]:
    held = ([ring(node, boxes, wall=8.0) for node in ROUND] for boxes in ([before], after))
    return kinds(compare_rings(*held, nodes=ROUND))


@pytest.mark.parametrize("turned_deg", [0.0, 30.0, 90.0])
def test_what_was_seen_from_two_sides_is_known_again_anywhere_and_turned(turned_deg):
    assert told([Box(1.5, 0.5, 0.9, 0.5, turned_deg)]) == ["moved"]


def test_another_shape_far_away_is_another_thing():
    assert told([Box(1.5, 0.5, 1.3, 0.5, 90.0)]) == ["appeared", "vanished"]


def test_of_two_alike_far_away_neither_is_known_again():
    assert told([Box(1.5, 0.5, 0.9, 0.5), Box(0.0, 3.0, 0.9, 0.5)]) == ["appeared", "appeared", "vanished"]


@dataclass(frozen=True)
class Outline:
    """Corners of a rectangle along the axes."""

    points: np.ndarray
    alone: bool = True

    @classmethod
    def of(cls, x: float, y: float, width: float, depth: float, *, alone: bool = True) -> "Outline":
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / 2
        return cls((x, y) + corners * (width, depth), alone)


ONE = Outline.of(0.0, 0.0, 0.8, 0.5)


def pairs(gone: list[Outline], come: list[Outline]) -> list[tuple[int, int]]:
    return pair_moves(gone, come, Rules())


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (Outline.of(20.0, 3.0, 0.5, 0.8), [(0, 0)]),  # turned
        (Outline.of(20.0, 3.0, 1.5, 0.5), []),
        (Outline.of(20.0, 3.0, 0.91, 0.5), [(0, 0)]),  # sides 0.12 m apart are as good as one
        (Outline.of(20.0, 3.0, 0.93, 0.5), []),
        (Outline.of(20.0, 3.0, 0.8, 0.63), []),
        (Outline.of(20.0, 3.0, 0.8, 0.5, alone=False), []),
    ],
)
def test_the_rectangle_tells_what_moved(other, expected):
    assert pairs([ONE], [other]) == expected
    assert pairs([other], [ONE]) == expected


@pytest.mark.parametrize(("length_m", "expected"), [(2.7, [(0, 0)]), (2.8, [])])
def test_long_things_may_differ_by_a_tenth(length_m, expected):
    assert pairs([Outline.of(0.0, 0.0, 2.5, 0.5)], [Outline.of(9.0, 0.0, length_m, 0.5)]) == expected


@pytest.mark.parametrize(("length_m", "expected"), [(0.99, [(0, 0)]), (1.01, [])])
def test_what_is_long_and_stands_across_is_told_as_two(length_m, expected):
    """Bounds may differ by half a metre."""
    assert pairs([Outline.of(0.0, 0.0, length_m, 0.5)], [Outline.of(9.0, 0.0, 0.5, length_m)]) == expected


@pytest.mark.parametrize(
    ("depth_m", "away_m", "expected"),
    [(0.0, 0.99, [(0, 0)]), (0.0, 1.01, []), (0.19, 1.01, []), (0.21, 1.01, [(0, 0)])],
)
def test_one_face_moves_a_metre_at_most(depth_m, away_m, expected):
    gone, come = (Outline.of(x, 0.0, 0.8, depth_m) for x in (0.0, away_m))
    assert pairs([gone], [come]) == expected


def test_each_is_used_once_and_what_is_ambiguous_not_at_all():
    again, long = Outline.of(5.0, 0.0, 0.8, 0.5), Outline.of(0.0, 9.0, 2.0, 0.5)
    there = Outline.of(9.0, 9.0, 2.0, 0.5)
    assert pairs([ONE, long], [there, again]) == [(0, 1), (1, 0)]
    assert pairs([ONE, long], [there, again, Outline.of(9.0, 0.0, 0.8, 0.5)]) == [(1, 0)]
    assert pairs([ONE, again, long], [Outline.of(9.0, 0.0, 0.8, 0.5), there]) == [(2, 1)]
    assert pairs([], [ONE]) == pairs([ONE], []) == []
