"""What nodes say of a surface."""

import numpy as np

from tests.changes.rooms import CENTRE, RADIUS, Box, estimate, ring
from timemap_cli.changes.rings import place, stack
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import GONE, STANDS, UNTOLD, words
from timemap_cli.model.nodes import Node

FACE = np.stack([np.full(13, 2.0), np.linspace(-0.3, 0.3, 13)], axis=1)  # of a box at x = 2
BOX = Box(2.3, 0.0)
RULES = Rules()


def word(ranges, node=CENTRE, points=FACE, **values):
    side = {0: estimate(0, ranges, **values)}
    (said,) = words(points, stack(side, [0]), place([node], [0], len(ranges), RADIUS), RULES)
    return said


def test_a_surface_that_is_shown_stands():
    assert word(ring(CENTRE, [BOX])) == STANDS


def test_a_surface_that_is_seen_past_is_gone():
    assert word(ring(CENTRE)) == GONE
    assert word(np.full(360, np.inf)) == GONE


def test_what_is_hidden_or_unknown_cannot_be_told():
    assert word(ring(CENTRE, [Box(1.0, 0.0, 0.2, 1.0)])) == UNTOLD
    assert word(np.full(360, np.nan)) == UNTOLD
    assert word(ring(CENTRE, [BOX]), samples=2) == UNTOLD
    assert word(ring(CENTRE, [BOX]), support=0.4) == UNTOLD


def test_a_surface_half_there_is_no_word():
    ranges = ring(CENTRE)
    ranges[:9] = 2.0  # the upper half of the face alone
    assert word(ranges) == UNTOLD


def test_a_node_out_of_reach_says_nothing():
    far = Node(-30.0, 0.0)
    assert word(np.full(360, np.inf), node=far) == UNTOLD


def test_what_was_last_looked_at_an_hour_before_the_nodes_newest_scan_is_no_word():
    hour = 3_600_000_000_000
    side = {0: estimate(0, ring(CENTRE), stamp_ns=3 * hour)}
    for seen_ns, said in ((2 * hour, GONE), (2 * hour - 1, UNTOLD)):
        side[0].last_seen_ns[:] = seen_ns
        rings = stack(side, [0])
        assert words(FACE, rings, place([CENTRE], [0], 360, RADIUS), RULES)[0] == said
