"""Events of things that other nodes see than those that knew them."""

import numpy as np
import pytest

from tests.changes.rooms import OUTDOORS, RADIUS, Box, estimate, ring, wall, walls
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Turn
from timemap_cli.changes.tracker import Tracker
from timemap_cli.model.nodes import Node

LEVELS = ("short", "mid", "long")
SECOND = 10**9
FLAT = [*walls(-6.0, -3.0, 6.0, 3.0), wall(-0.1, -3.0, 0.1, 3.0)]  # two rooms without a door
LEFT, RIGHT = [Node(-4.5, -1.5), Node(-1.5, 1.8)], [Node(1.5, 1.8), Node(4.5, -1.5)]
NODES = LEFT + RIGHT
HERE, THERE = Box(-3.5, 0.3, 0.9, 0.5), Box(3.0, 0.2, 0.9, 0.5)


class Flat:
    """Rounds of estimates of nodes in two rooms, at ever later times."""

    def __init__(self, nodes=NODES):
        self.nodes = nodes
        self.tracker = Tracker(LEVELS, RADIUS)
        self.newest = {level: {} for level in LEVELS}
        self.now = 0

    def round(self, boxes, renewed, *, long=None):
        """These nodes see these boxes; the slowest level may show other ones still."""
        self.now += 30 * SECOND
        made = []
        for level in LEVELS:
            shown = boxes if long is None or level != "long" else long
            for number in renewed:
                ranges = ring(self.nodes[number], [*FLAT, *shown], OUTDOORS)
                held = estimate(number, ranges, stamp_ns=self.now)
                object.__setattr__(held, "level", level)
                self.newest[level][number] = held
                made.append(held)
        return [turn.turn for turn in self.tracker.update(self.nodes, self.newest, made)]

    @property
    def kinds(self):
        return [event.kind for event in self.tracker.events]


@pytest.fixture
def flat():
    """A flat that was driven through twice, with a box in its left room."""
    found = Flat()
    for _ in range(2):
        found.round([HERE], range(4))
    return found


def test_a_thing_carried_to_another_room_is_one_event_that_moved(flat):
    flat.round([THERE], [0, 1], long=[HERE])
    assert flat.kinds == [Kind.VANISHED]
    turns = flat.round([THERE], [2, 3], long=[HERE])
    assert turns.count(Turn.DROPPED) == 1
    (event,) = flat.tracker.events
    assert event.kind is Kind.MOVED
    assert event.centre == pytest.approx((3.0, 0.2), abs=0.3)
    assert event.moved_from == pytest.approx((-3.5, 0.3), abs=0.3)
    assert set(event.nodes) == {2, 3}


def test_the_place_that_a_moved_thing_left_is_told_for_the_maps(flat):
    flat.round([THERE], [0, 1], long=[HERE])
    flat.round([THERE], [2, 3], long=[HERE])
    (left,) = flat.tracker.left(flat.tracker.levels[0])
    assert left.points.mean(axis=0) == pytest.approx((-3.5, 0.3), abs=0.3)
    assert flat.tracker.left(flat.tracker.levels[-1]) == []  # the slowest level has not adopted it


def test_it_is_one_event_in_whichever_room_the_robot_looks_first(flat):
    flat.round([THERE], [2, 3], long=[HERE])
    assert flat.kinds == [Kind.APPEARED]
    flat.round([THERE], [0, 1], long=[HERE])
    assert flat.kinds == [Kind.MOVED]


def test_the_vanished_one_does_not_come_back_as_an_event_of_its_own(flat):
    flat.round([THERE], [0, 1], long=[HERE])
    flat.round([THERE], [2, 3], long=[HERE])
    for _ in range(2):
        assert flat.round([THERE], range(4)).count(Turn.SEEN) == 0
    assert flat.kinds == [Kind.MOVED]


def test_another_shape_in_the_other_room_is_a_second_event(flat):
    flat.round([], [0, 1], long=[HERE])
    flat.round([Box(3.0, 0.2, 1.3, 0.5)], [2, 3], long=[])
    assert flat.kinds == [Kind.VANISHED, Kind.APPEARED]


def test_what_turns_up_hours_later_is_a_second_event(flat):
    flat.round([], [0, 1], long=[HERE])
    flat.now += 2 * 3600 * SECOND
    flat.round([THERE], [2, 3], long=[])
    assert flat.kinds == [Kind.VANISHED, Kind.APPEARED]


WAY = [Node(-4.5, -1.5), Node(-2.0, -1.5)]
OTHER_WAY = [Node(-4.0, 1.5), Node(-1.5, 1.5)]


@pytest.mark.parametrize(
    ("before", "after", "kind"), [([HERE], [], Kind.VANISHED), ([], [HERE], Kind.APPEARED)]
)
def test_a_robot_that_returns_on_another_way_makes_events(before, after, kind):
    flat = Flat(WAY + OTHER_WAY)
    for _ in range(2):
        flat.round(before, [0, 1])
    flat.round(after, [2, 3])  # nodes that were not there before
    (event,) = flat.tracker.events
    assert event.kind is kind
    assert event.centre == pytest.approx((-3.5, 0.3), abs=0.3)
    assert event.nodes == (2, 3)


def test_one_that_returns_on_another_way_and_finds_all_as_it_was_makes_none():
    flat = Flat(WAY + OTHER_WAY)
    flat.round([HERE], [0, 1])
    for _ in range(2):
        assert flat.round([HERE], [2, 3]) == []
    assert flat.round([HERE], range(4)) == []
    assert flat.kinds == []


def test_what_was_kept_makes_the_same_events_after_a_pause(flat):
    again = Tracker(LEVELS, RADIUS)
    flat.round([THERE], [0, 1], long=[HERE])
    again.restore(flat.tracker.kept())
    for node in range(4):
        again.restore_before(node, flat.tracker.kept_before(node))
    flat.tracker = again
    flat.round([THERE], [2, 3], long=[HERE])
    assert flat.kinds == [Kind.MOVED]
    assert np.isfinite(flat.tracker.events[0].centre).all()
