from timemap_cli.checks.matching import matched
from timemap_cli.model.nodes import Node


def test_the_nearest_are_partners_and_each_has_one():
    found = matched([Node(0, 0), Node(0.2, 0)], [Node(0.11, 0), Node(5, 5)], within_m=0.25)
    assert found.pairs == ((1, 0),)
    assert found.missing == (0,)
    assert found.new == (1,)


def test_of_two_equally_near_nodes_the_lower_number_is_the_partner_though_a_last_bit_says_otherwise():
    here = [Node(0.4, 0), Node(0.2, 0)]  # 0.10000000000000003 m and 0.09999999999999998 m from 0.3
    assert matched([Node(0.3, 0)], here, 0.25).pairs == ((0, 0),)
    assert matched(here, [Node(0.3, 0)], 0.25).pairs == ((0, 0),)


def test_nodes_keep_their_partner_whatever_their_numbers():
    places = [Node(0, 0), Node(1, 0), Node(2, 0)]
    assert matched(places, places[::-1], 0.25).pairs == ((0, 2), (1, 1), (2, 0))


def test_no_nodes_have_no_partners():
    assert matched([], [Node(0, 0)], 0.25).new == (0,)
