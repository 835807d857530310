"""Events over time, of boxes that come and go in a round room, as three levels see them."""

import numpy as np
import pytest

from tests.changes.rooms import RADIUS, Box, compare_rings, estimate, ring
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Turn
from timemap_cli.changes.track import Track
from timemap_cli.changes.tracker import Tracker
from timemap_cli.model.nodes import Node

LEVELS = ("short", "mid", "long")
HERE, BESIDE, FAR = Node(0.0, 0.0), Node(0.0, 1.0), Node(40.0, 0.0)
BOX, OTHER = Box(2.3, 0.0), Box(-2.3, 1.0)
SECOND = 10**9


class House:
    """Rounds of estimates of some nodes, at ever later times."""

    def __init__(self, nodes=(HERE, BESIDE), levels=LEVELS):
        self.nodes, self.levels = nodes, levels
        self.tracker = Tracker(levels, RADIUS)
        self.newest = {level: {} for level in levels}
        self.now = 0

    def round(self, short=(), mid=None, long=None, renewed=None):
        """Boxes that each level shows; a slower level shows what the faster one does unless it is told otherwise."""
        mid = short if mid is None else mid
        boxes = dict(zip(LEVELS, (short, mid, mid if long is None else long), strict=True))
        self.now += 30 * SECOND
        made = []
        for level in self.levels:
            for number in range(len(self.nodes)) if renewed is None else renewed:
                node = self.nodes[number]
                seen = ring(HERE) if node is FAR else ring(node, boxes[level])
                rings = estimate(number, seen, stamp_ns=self.now)
                object.__setattr__(rings, "level", level)
                self.newest[level][number] = rings
                made.append(rings)
        return self.tracker.update(self.nodes, self.newest, made)

    def turns(self, *args, **values):
        return [(t.turn, t.level) for t in self.round(*args, **values)]

    @property
    def event(self):
        (event,) = self.tracker.events
        return event


@pytest.fixture
def house():
    """A house that has long been empty."""
    found = House()
    found.round()
    found.round()
    return found


def test_where_nothing_changes_there_is_no_event(house):
    assert house.turns() == []
    assert house.tracker.events == ()


def test_what_was_there_from_the_first_look_is_no_event():
    house = House()
    for _ in range(3):
        assert house.turns([BOX]) == []
    assert house.tracker.events == ()


def test_a_passer_by_that_only_the_fastest_level_shows_is_no_event(house):
    assert house.turns([BOX], mid=[]) == []
    assert house.turns() == []
    assert house.tracker.events == ()


def test_what_a_slower_level_adopts_is_reported_with_the_time_of_the_first_sighting(house):
    assert house.turns([BOX], mid=[]) == []
    first_ns = house.now
    assert house.turns([BOX], long=[]) == [(Turn.SEEN, None), (Turn.ADOPTED, "short"), (Turn.ADOPTED, "mid")]
    event = house.event
    assert (event.id, event.kind) == (0, Kind.APPEARED)
    assert (event.first_seen_ns, event.last_seen_ns, event.looked_ns) == (first_ns, house.now, house.now)
    assert event.adopted == {"short": first_ns, "mid": house.now, "long": None}
    assert event.nodes == (0, 1)
    assert event.against == ()
    assert event.centre == pytest.approx((2.0, 0.0), abs=0.1)
    assert event.holds


def test_adoption_by_the_slowest_level_is_told_once(house):
    house.round([BOX], long=[])
    assert house.turns([BOX]) == [(Turn.ADOPTED, "long")]
    assert house.turns([BOX]) == []
    assert house.event.adopted["long"] == 30 * SECOND * 4


def test_levels_that_turn_at_once_give_one_event_that_all_have_adopted(house):
    """In a young memory a new majority turns every level in the same round."""
    assert [turn for turn, _ in house.turns([BOX])] == [Turn.SEEN] + 3 * [Turn.ADOPTED]
    assert set(house.event.adopted.values()) == {house.now}


def test_a_thing_that_is_gone_has_vanished():
    house = House()
    house.round([BOX])
    house.round([], long=[BOX])
    event = house.event
    assert (event.kind, event.holds) == (Kind.VANISHED, True)
    assert event.centre == pytest.approx((2.0, 0.0), abs=0.1)


def test_an_event_that_reverts_is_closed_when_it_was_first_seen_undone_and_not_doubled(house):
    house.round([BOX], long=[])
    assert house.turns([], mid=[BOX], long=[]) == []  # one word of the fastest level alone is not enough
    undone_ns = house.now
    assert house.turns([]) == [(Turn.CLOSED, None)]
    assert house.turns([]) == []
    event = house.event
    assert (event.kind, event.closed_ns) == (Kind.APPEARED, undone_ns)
    assert len(event.episodes) == 1


def test_what_all_levels_had_adopted_and_goes_again_is_still_one_event(house):
    house.round([BOX])
    house.round([BOX])
    house.round([], mid=[BOX], long=[BOX])
    house.round([], mid=[], long=[BOX])
    assert house.event.closed_ns is not None
    house.round([])
    assert len(house.tracker.events) == 1


def test_a_door_that_opens_and_shuts_is_one_recurring_event_with_its_share(house):
    """The slower levels never follow: it is the third visit that makes it sure."""
    for _ in range(3):
        for _ in range(2):
            house.round([BOX], mid=[])
        for _ in range(2):
            house.round([])
    event = house.event
    assert event.recurring
    assert len(event.episodes) == 3
    assert event.share_held == pytest.approx(0.5)
    assert event.adopted["mid"] is None


def test_somebody_who_stood_there_once_is_forgotten_until_it_recurs(house):
    for _ in range(2):
        house.round([BOX], mid=[])
    for _ in range(2):
        house.round([])
    assert house.tracker.events == ()


def test_one_look_that_fails_does_not_close_an_event(house):
    house.round([BOX], long=[])
    house.round([], mid=[BOX], long=[])
    house.round([BOX], long=[])
    assert len(house.event.episodes) == 1
    assert house.event.holds


def test_what_nobody_looks_at_stays_as_it_was():
    house = House((HERE, FAR))
    house.round()
    house.round()
    house.round([BOX], long=[])
    seen_ns = house.now
    for _ in range(3):
        assert house.turns([], renewed=[1]) == []
    assert house.event.holds
    assert house.event.looked_ns == seen_ns


def test_a_thing_seen_by_two_nodes_one_after_the_other_is_one_event(house):
    house.round([BOX], long=[], renewed=[0])
    house.round([BOX], long=[], renewed=[1])
    assert house.event.nodes == (0, 1)


def test_two_things_apart_are_two_events(house):
    house.round([BOX, OTHER], long=[])
    assert [event.id for event in house.tracker.events] == [0, 1]
    assert {event.kind for event in house.tracker.events} == {Kind.APPEARED}


def test_a_thing_pushed_aside_has_moved_and_is_one_event():
    house = House((HERE,))
    board, aside = Box(3.0, 0.0, 0.1, 0.5), Box(3.0, 0.8, 0.1, 0.5)
    house.round([board])
    house.round([board])
    house.round([aside], long=[board])
    event = house.event
    assert event.kind is Kind.MOVED
    assert event.moved_from == pytest.approx((2.95, 0.0), abs=0.05)
    assert event.centre == pytest.approx((2.95, 0.8), abs=0.05)


def test_the_place_that_a_moved_thing_left_is_no_event_of_its_own():
    """Another node, which cannot have seen that it is the same thing, sees only that its old place is empty."""
    house = House((HERE, BESIDE))
    board, aside = Box(3.0, 0.0, 0.1, 0.5), Box(3.0, 0.8, 0.1, 0.5)
    house.round([board])
    house.round([board])
    house.round([aside], long=[board], renewed=[0])
    house.round([], long=[board], renewed=[1])
    assert house.event.kind is Kind.MOVED


def test_the_second_of_two_things_of_one_kind_can_be_dropped():
    both = compare_rings(ring(HERE, [BOX, OTHER]), ring(HERE))
    first, second = (Track.of(change, LEVELS) for change in both.changes)
    assert (first.kind, len(first.points)) != (
        second.kind,
        len(second.points),
    )  # arrays that cannot be compared
    assert first.kind is second.kind
    tracker = Tracker(LEVELS, RADIUS)
    tracker._tracks += [first, second]
    tracker._drop(second)
    assert [one is first for one in tracker._tracks] == [True]


def test_somebody_in_front_of_a_thing_does_not_undo_it(house):
    house.round([BOX], long=[])
    in_front = Box(1.2, 0.0, 0.3, 1.2)
    for _ in range(3):
        house.round([BOX, in_front], mid=[BOX], long=[])
    assert [event.holds for event in house.tracker.events] == [True]


def test_unknown_angle_bins_say_nothing(house):
    house.round([BOX], long=[])
    for number in (0, 1):
        blind = estimate(number, np.full(360, np.nan), stamp_ns=house.now + 1)
        house.newest["short"][number] = blind
    assert house.tracker.update(house.nodes, house.newest, [blind]) == []
    assert house.event.holds


def test_one_level_alone_has_no_events():
    house = House(levels=("short",))
    house.round()
    assert house.round([BOX]) == []


def test_of_two_levels_the_slower_must_adopt():
    house = House(levels=("short", "long"))
    house.round()
    house.round()
    assert house.turns([BOX], long=[]) == []
    assert (Turn.SEEN, None) in house.turns([BOX], long=[BOX])


def test_the_order_of_the_nodes_does_not_matter():
    def told(nodes):
        house = House(nodes)
        house.round()
        house.round([BOX], long=[])
        house.round([OTHER, BOX])
        return sorted((e.kind.value, *np.round(e.centre, 6), e.first_seen_ns) for e in house.tracker.events)

    assert told((HERE, BESIDE)) == told((BESIDE, HERE))


def test_a_thing_that_had_vanished_and_turns_up_beside_its_place_is_one_event_among_others():
    house = House((HERE,))
    board, aside = Box(3.0, 0.0, 0.1, 0.5), Box(3.0, 0.8, 0.1, 0.5)
    house.round([board, OTHER])
    house.round([board, OTHER])
    for _ in range(2):
        house.round([board], long=[board, OTHER])
    for _ in range(2):
        house.round([], long=[board, OTHER])
    assert [event.kind for event in house.tracker.events] == [Kind.VANISHED, Kind.VANISHED]
    house.round([aside], long=[board, OTHER])
    assert [event.kind for event in house.tracker.events] == [Kind.VANISHED, Kind.MOVED]
