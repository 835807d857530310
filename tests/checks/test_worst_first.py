"""What is worst comes first; of equals, by what it was compared with, not by a last bit."""

import numpy as np

from timemap_cli.checks.pairs import Pair
from timemap_cli.checks.places import Ends, moved_places
from timemap_cli.checks.verdict import Measure, Verdict


def measure(name, value, allowed):
    return Measure(name, None, value, allowed, "m", "")


def test_failures_of_equal_excess_keep_the_order_of_comparing():
    # 0.3 / 0.1 is 2.9999999999999996, 0.9 / 0.3 is 3.0000000000000004: both are three times their tolerance
    measures = (measure("first", 0.3, 0.1), measure("second", 0.9, 0.3), measure("worst", 0.4, 0.1))
    failures = Verdict("", "", measures, (), (), None).failures
    assert [one.name for one in failures] == ["worst", "first", "second"]


def test_nodes_of_equal_value_are_named_by_their_place():
    ranges = np.ones((3, 4))
    pair = Pair(ranges, ranges, np.zeros((3, 2)), np.zeros((3, 2)), (0, 1, 2))
    spots = pair.node_spots(np.arange(3), np.array([0.3, 0.1 + 0.2, 0.4]), str)
    assert [spot.nodes for spot in spots] == [(2,), (0,), (1,)]


def test_moved_places_of_equal_x_come_by_y():
    x = np.repeat([0.1 + 0.2, 0.3], 20)  # the lower one lies to the right by a last bit
    y = np.repeat([1.0, 9.0], 20)
    node = np.tile(np.arange(4), 10)
    places = moved_places(Ends(x, y, node, np.full(40, 0.5)), 0.1, nodes=4)
    assert [place.y for place in places] == [1.0, 9.0]
