"""Only what a round shows anew makes candidates."""

import numpy as np
import pytest

from tests.changes.rooms import Box, estimate, ring, side_of
from timemap_cli.changes.compare import news
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.rules import Rules
from timemap_cli.model.nodes import Node

RULES = Rules()
NODES = [Node(-1.5, 0.0), Node(1.5, 0.0), Node(0.0, -1.0)]
BOX = Box(0.0, 2.3)


def side(boxes_by_node: dict[int, list[Box]]):
    return side_of(NODES, {n: estimate(n, ring(NODES[n], boxes)) for n, boxes in boxes_by_node.items()})


def told(before: dict[int, list[Box]], now: dict[int, list[Box]]) -> list[str]:
    return [change.kind.value for change in news(side(before), side(now), RULES)]


def test_an_unchanged_round_has_no_news():
    held = {0: [BOX], 1: [BOX]}
    assert told(held, held) == []
    assert told(held, {1: [BOX]}) == []


def test_what_nodes_that_look_again_show_anew_is_news():
    assert told({0: [], 1: []}, {0: [BOX], 1: [BOX]}) == ["appeared"]
    assert told({0: [BOX], 1: [BOX]}, {0: [], 1: []}) == ["vanished"]


def test_one_of_several_nodes_is_enough():
    assert told({0: [], 1: []}, {1: [BOX]}) == ["appeared"]
    assert told({0: [BOX], 1: [BOX]}, {1: []}) == ["vanished"]


def test_what_a_new_node_shows_is_fresh():
    """The robot came back on another way: its old nodes know nothing of it."""
    (change,) = news(side({0: []}), side({2: [BOX]}), RULES)
    assert (change.kind, change.nodes) == (Kind.APPEARED, (0,))
    (change,) = news(side({0: [BOX]}), side({2: []}), RULES)
    assert (change.kind, change.nodes) == (Kind.VANISHED, (2,))


def test_what_a_node_had_shown_before_is_no_news_though_others_now_held_something_else():
    """Node 0 shows the box as it did; the others never had it. That is a matter for when it was new."""
    assert told({0: [BOX], 1: [], 2: []}, {0: [BOX]}) == []


@pytest.mark.parametrize(("shift_m", "kinds"), [(0.19, []), (0.21, ["appeared"])])
def test_a_range_within_a_step_of_the_one_before_is_not_fresh(shift_m, kinds):
    before, now = np.full(360, 5.0), np.full(360, 5.0)
    now[80:100] -= shift_m
    before, now = (side_of(NODES, {0: estimate(0, ranges)}) for ranges in (before, now))
    assert [change.kind.value for change in news(before, now, RULES)] == kinds


def test_fewer_than_three_fresh_bins_have_no_news():
    before, now = np.full(360, 8.0), np.full(360, 8.0)
    now[80:82] = 3.0
    rules = Rules(min_thing_bins=1, min_arc_m=0.0)
    sides = [side_of(NODES, {0: estimate(0, ranges)}) for ranges in (before, now)]
    assert news(*sides, rules) == ()
    now[82] = 3.0
    sides[1] = side_of(NODES, {0: estimate(0, now)})
    assert len(news(*sides, rules)) == 1


def test_what_was_clear_and_is_clear_is_not_fresh():
    clear = side_of(NODES, {0: estimate(0, np.full(360, np.inf))})
    assert news(clear, clear, RULES) == ()


def test_what_a_node_saw_past_before_is_no_news_when_it_shows_something_else():
    """Node 2 never had the box that the others hold, and says so still; new is another one behind it."""
    other = Box(0.0, -3.0)
    assert told({0: [BOX], 1: [BOX], 2: []}, {2: [other]}) == ["appeared"]
