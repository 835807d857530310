"""Truth and events taken apart into places."""

import pytest

from benchmarks.changes.places import (
    Event,
    claims,
    moved_from,
    places_of_changes,
    places_of_transitions,
    read_events,
)
from tests.benchmarks.changes.making import S, change, event, square, truth

DOCUMENT = {
    "schema": "timemap.changes/1",
    "events": [
        {
            "id": 7, "kind": "appeared", "x": 1.0, "y": 2.0, "bounds": [0.5, 1.5, 1.5, 2.5],
            "first_seen_ns": "100", "last_seen_ns": "900", "adopted": {"short": "200", "mid": None},
            "nodes": [3, 4], "support": 0.9,
        }
    ],
}  # fmt: skip


def told(**more: object) -> Event:
    (one,) = read_events(DOCUMENT | {"events": [DOCUMENT["events"][0] | more]})
    return one


def test_an_event_needs_no_more_than_the_fixed_fields():
    (one,) = read_events(DOCUMENT)
    assert one == Event("7", "appeared", (0.5, 1.5, 1.5, 2.5), 100, 900, {"short": 200, "mid": None}, (3, 4))


def test_another_schema_is_refused():
    with pytest.raises(ValueError, match=r"'timemap.diff/1', not 'timemap.changes/1'"):
        read_events({"schema": "timemap.diff/1", "events": []})


def test_a_closed_event_has_toggled_twice():
    assert told().toggles == 1
    assert told(closed_ns=None).toggles == 1
    assert told(closed_ns="900").toggles == 2


def test_episodes_tell_every_toggle():
    episodes = [{"closed_ns": "200"}, {"closed_ns": "400"}, {"closed_ns": None}]
    assert told(episodes=episodes, recurring=True).toggles == 5
    assert told(episodes=episodes, recurring=True).recurring


def test_a_moved_event_claims_both_places():
    one = event("moved", (4, 0, 5, 2), 210, moved_from=(0, 0, 1, 2))
    assert [(c.kind, c.bounds) for c in claims([one])] == [
        ("appeared", (4, 0, 5, 2)),
        ("vanished", (0, 0, 1, 2)),
    ]


def test_a_centre_that_a_thing_moved_from_gets_its_size():
    assert moved_from([1.0, 1.0], (4, 0, 5, 2)) == (0.5, 0.0, 1.5, 2.0)
    assert moved_from([0.0, 0.0, 1.0, 1.0], (4, 0, 5, 2)) == (0.0, 0.0, 1.0, 1.0)
    assert moved_from(None, (4, 0, 5, 2)) is None


def test_a_move_is_two_places():
    moved = change("moved", square(4, 0), (190, None), origin=square(0, 0))
    found = [(set(p.kinds), p.bounds) for p in places_of_changes(truth(moved))]
    assert found == [({"appeared"}, (4, 0, 5, 1)), ({"vanished"}, (0, 0, 1, 1))]


def test_a_visit_is_one_place_of_two_toggles_and_two_transitions():
    parcel = change("appeared", square(0, 0), (190, 390))
    (place,) = places_of_changes(truth(parcel))
    assert (place.since_ns, place.until_ns, place.toggles) == (190 * S, 390 * S, 2)
    came, went = places_of_transitions(truth(parcel))
    assert (set(came.kinds), came.since_ns, came.until_ns) == ({"appeared"}, 190 * S, 390 * S)
    assert (set(went.kinds), went.since_ns, went.until_ns) == ({"vanished"}, 390 * S, None)


def test_what_recurs_is_one_place_of_either_kind_and_many_transitions():
    door = change("vanished", square(0, 0), (190, 290), (390, 490))
    (place,) = places_of_changes(truth(door))
    assert place.kinds == {"appeared", "vanished"}
    assert (place.since_ns, place.until_ns, place.toggles) == (190 * S, None, 4)
    found = [
        (*p.kinds, p.since_ns // S, p.until_ns and p.until_ns // S)
        for p in places_of_transitions(truth(door))
    ]
    assert found == [
        ("vanished", 190, 290), ("appeared", 290, 390), ("vanished", 390, 490), ("appeared", 490, None),
    ]  # fmt: skip


def test_what_happens_after_the_last_patrol_is_not_to_be_told():
    parcel = change("appeared", square(0, 0), (490, 900))
    (place,) = places_of_changes(truth(parcel))
    assert place.toggles == 1
    assert len(places_of_transitions(truth(parcel))) == 1
