"""Which looks count, and how they are put together."""

import numpy as np
import pytest

from tests.changes.rooms import CENTRE, Box, estimate, estimates, ring, side_of
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.testimony import Testimony as Said
from timemap_cli.changes.testimony import testimony as hear
from timemap_cli.model.nodes import Node

RULES = Rules()
BOX = Box(2.3, 0.0)
FACE = np.array([(2.0, 0.1)])
MINUTE = 60 * 10**9
ROUND = [Node(0.0, 0.1), Node(0.0, -0.4), Node(-0.5, 0.1)]


def votes(*seen: tuple[list[Box], int]) -> tuple[int, int]:
    """How many show a point of the box's face, and see past it, of nodes that saw these boxes at these times [ns]."""
    nodes = ROUND[: len(seen)]
    held = {
        i: estimate(i, ring(node, boxes), stamp_ns=stamp_ns)
        for i, (node, (boxes, stamp_ns)) in enumerate(zip(nodes, seen, strict=True))
    }
    said = hear(FACE, side_of(nodes, held), RULES)
    return int(said.shown[0]), int(said.past[0])


def test_every_node_that_can_tell_has_a_vote():
    assert votes(([BOX], 1), ([], 1), ([BOX], 1)) == (2, 1)
    assert votes(([], 1), ([], 1), ([], 1)) == (0, 3)


@pytest.mark.parametrize(
    ("older_ns", "expected"),
    [(9 * MINUTE, (1, 1)), (10 * MINUTE, (1, 1)), (10 * MINUTE + 1, (0, 1)), (11 * MINUTE, (0, 1))],
)
def test_the_newest_looks_come_first(older_ns, expected):
    newest_ns = 100 * MINUTE
    assert votes(([BOX], newest_ns - older_ns), ([], newest_ns)) == expected
    assert votes(([], newest_ns), ([BOX], newest_ns - older_ns)) == expected


def test_what_was_seen_through_lately_and_what_was_put_there_since():
    assert votes(([], MINUTE), ([BOX], 90 * MINUTE)) == (1, 0)


def test_a_newer_look_that_cannot_tell_leaves_the_word_to_the_older_one():
    screen = Box(1.0, -0.4, 0.2, 2.0)  # before both
    assert votes(([BOX], MINUTE), ([BOX, screen], 90 * MINUTE)) == (1, 0)


def test_it_is_the_angle_bin_that_must_be_new_not_its_node():
    held = estimates(ROUND[:2], [], stamp_ns=90 * MINUTE)
    held[1] = estimate(1, ring(ROUND[1], [BOX]), stamp_ns=90 * MINUTE)
    held[1].last_seen_ns[:] = MINUTE
    said = hear(FACE, side_of(ROUND, held), RULES)
    assert (said.shown.tolist(), said.past.tolist()) == ([0], [1])


def test_each_point_has_its_own_newest_look():
    held = {
        0: estimate(0, ring(CENTRE), stamp_ns=MINUTE),
        1: estimate(1, np.r_[np.full(90, np.nan), np.full(270, 5.0)], stamp_ns=90 * MINUTE),
    }
    points = np.array([(1.0, 1.0), (-1.0, 1.0), (1.0, 5.5)])  # only the older knows the first, none the last
    said = hear(points, side_of([CENTRE, CENTRE], held), RULES)
    assert said.past.tolist() == [1, 1, 0]
    assert said.told.tolist() == [True, True, False]


def test_what_nobody_can_tell_is_untold_and_uncontradicted():
    said = hear(np.array([(50.0, 0.0)]), side_of(ROUND, estimates(ROUND)), RULES)
    assert (said.told.tolist(), said.contradicted(0.25).tolist()) == ([False], [False])


COUNTS = Said(shown=np.array([3, 3, 0, 1, 0]), past=np.array([1, 2, 4, 0, 0]))


def test_contradicted_is_more_than_the_share():
    assert COUNTS.contradicted(0.25).tolist() == [False, True, True, False, False]
    assert COUNTS.contradicted(0.4).tolist() == [False, False, True, False, False]


def test_a_thing_is_decided_by_the_votes_on_all_its_points():
    assert COUNTS.stands(np.array([0, 1]), 0.5)  # 6 of 9
    assert not COUNTS.stands(np.array([0, 2]), 0.5)  # 3 of 8
    assert COUNTS.is_gone(np.array([0, 2]), 0.5)  # 5 of 8
    assert not COUNTS.is_gone(np.array([0, 2]), 0.75)
    tie = np.array([0, 2, 3])  # 4 + 1 of 9 see past, 4 show
    assert COUNTS.is_gone(tie, 0.5)
    even = np.array([0, 1, 2, 3])  # 7 of 14
    assert not COUNTS.is_gone(even, 0.5)
    assert not COUNTS.stands(even, 0.5)


def test_of_what_nobody_can_tell_nothing_is_decided():
    assert not COUNTS.stands(np.array([4]), 0.5)
    assert not COUNTS.is_gone(np.array([4]), 0.5)


def test_a_part_is_what_is_said_of_these_points():
    part = COUNTS.part(np.array([2, 0]))
    assert (part.shown.tolist(), part.past.tolist()) == ([0, 3], [4, 1])
