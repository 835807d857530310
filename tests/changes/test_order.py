"""The largest change comes first; of equals, by kind and place, not by a last bit."""

import numpy as np
import pytest

from tests.changes.rooms import CENTRE, Box, compare_rings, ring
from timemap_cli.changes.difference import Kind
from timemap_cli.model.nodes import Node

EMPTY = ring(CENTRE)
ROUND = np.array([(one / 3, one / 7) for one in range(1, 40)])  # whose last bits differ


@pytest.mark.parametrize("x", [-2.5, 2.5])
def test_the_largest_comes_first(x):
    boxed = ring(CENTRE, [Box(x, 0.0, 0.4, 0.4), Box(-x, 0.0, 1.2, 1.2)])
    assert [c.x * x > 0 for c in compare_rings(EMPTY, boxed).changes] == [False, True]


def test_of_equal_ones_the_left_one_comes_first_wherever_the_node_is():
    boxed = ring(CENTRE, [Box(-2.5, 0.0), Box(2.5, 0.0)])
    for x, y in ROUND:
        first, second = compare_rings(EMPTY, boxed, nodes=[Node(x, y)]).changes
        assert first.x < second.x


def test_of_equal_ones_above_each_other_the_lower_one_comes_first_wherever_the_node_is():
    boxed = ring(CENTRE, [Box(0.0, -2.5), Box(0.0, 2.5)])
    for x, y in ROUND:
        first, second = compare_rings(EMPTY, boxed, nodes=[Node(x, y)]).changes
        assert first.y < second.y


def test_of_equal_ones_what_appeared_comes_before_what_vanished():
    before, after = ring(CENTRE, [Box(-2.5, 0.0)]), ring(CENTRE, [Box(2.5, 0.0)])
    for x, y in ROUND:
        told = compare_rings(before, after, nodes=[Node(x, y)]).changes
        assert [change.kind for change in told] == [Kind.APPEARED, Kind.VANISHED]
