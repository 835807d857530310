"""Turns that last long enough for a slow level."""

import numpy as np

from benchmarks.changes.days import judged
from benchmarks.changes.lasting import in_sight, lasting
from benchmarks.changes.places import Event, places_of_transitions
from benchmarks.changes.visits import Pace
from tests.benchmarks.changes.making import S, change, square, truth
from timemap_cli.spans import Span

NODES = [(0.5, -1.0)]
NO_WALLS = np.array([[50.0, 50.0, 51.0, 50.0]])
EVERY_10_S = np.arange(110, 560, 10) * S


def places_that_last(half_life_obs: float, *changes, walls=NO_WALLS):
    pace = Pace(Span(half_life_obs, "obs"), {0: EVERY_10_S}, {})
    return lasting(places_of_transitions(truth(*changes)), pace, NODES, walls, 550 * S)


def test_a_turn_lasts_that_holds_for_one_and_a_third_half_lives():
    """From 300 s to 390 s ten scans are taken."""
    parcel = change("appeared", square(0, 0), (300, 400))
    assert [p.kinds for p in places_that_last(7, parcel)] == [{"appeared"}, {"vanished"}]
    assert places_that_last(8, parcel) == []


def test_a_young_memory_turns_when_it_has_seen_the_new_for_as_long_as_the_old():
    """Before 200 s nine scans are taken, from then to 310 s twelve: 1.33 times as many."""
    (place,) = places_that_last(1000, change("appeared", square(0, 0), (200, 320)))
    assert place.kinds == {"appeared"}
    assert places_that_last(1000, change("appeared", square(0, 0), (200, 300))) == []


def test_what_undoes_a_turn_that_did_not_last_does_not_last():
    assert places_that_last(8, change("appeared", square(0, 0), (400, 420))) == []


def test_what_no_node_sees_does_not_last():
    wall = np.array([[-5.0, -0.6, 5.0, -0.6]])
    assert places_that_last(2, change("appeared", square(0, 0), (300, 400)), walls=wall) == []
    assert places_that_last(2, change("appeared", square(9, 0), (300, 400))) == []


def test_a_node_behind_a_wall_is_not_in_sight():
    (place,) = places_of_transitions(truth(change("appeared", square(0, 0), (300, None))))
    nodes = np.array([(0.5, -1.0), (0.5, 2.5), (9.0, 9.0)])
    assert in_sight(place, nodes, NO_WALLS) == [0, 1]
    assert in_sight(place, nodes, np.array([[-5.0, 1.6, 5.0, 1.6]])) == [0]


def test_what_does_not_last_need_not_be_told_and_may_be():
    door = change("vanished", square(0, 0), (190, 290))
    told = Event("1", "vanished", (0, 0, 1, 1), 210 * S, 250 * S, {}, (0,))
    days = judged([told], "long", truth(door), [0.5], lasting=[])
    assert (days.level, days.found.places, days.found.false, days.area) == ("long*", (), [], 0.0)
