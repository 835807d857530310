from dataclasses import replace

from tests.checks.making import EVENT, SECOND
from timemap_cli.checks.event_measures import event_measures
from timemap_cli.checks.tolerances import defaults


def figures(expected, found):
    return {one.name: one for one in event_measures(expected, found, defaults())}


def test_the_same_events_differ_in_nothing():
    assert all(one.value == 0 for one in figures([EVENT], [EVENT]).values())


def test_a_missing_event_and_a_new_one_are_named_with_their_place():
    other = replace(EVENT, x=7.0)
    found = figures([EVENT], [other])
    assert (
        found["events.missing"].text
        == "1 of 1 change events expected but not there: 'appeared' at 2.00, 2.00"
    )
    assert found["events.new"].text == "1 of 1 change events not expected: 'appeared' at 7.00, 2.00"
    assert not found["events.new"].passed


def test_another_kind_at_the_same_place_is_another_event():
    assert figures([EVENT], [replace(EVENT, kind="vanished")])["events.missing"].value == 1


def test_what_two_nodes_saw_is_neither_missed_nor_new():
    weak = replace(EVENT, nodes=2)
    assert figures([weak], [])["events.missing"].passed
    assert figures([], [weak])["events.new"].passed


def test_an_event_elsewhere_is_told_by_its_distance():
    found = figures([EVENT], [replace(EVENT, x=2.3, y=2.4)])["events.place"]
    assert (round(found.value, 6), found.text) == (0.5, "'appeared' at 2.00, 2.00 lies 0.50 m off its place")
    assert not found.passed


def test_a_later_event_is_told_by_its_delay():
    found = figures([EVENT], [replace(EVENT, since_ns=500 * SECOND)])["events.time"]
    assert (found.value, found.passed) == (400.0, False)
    assert "from 1970-01-01T00:08:20Z, expected from 1970-01-01T00:01:40Z" in found.text


def test_an_event_that_was_undone_and_should_hold_is_out_of_any_tolerance():
    found = figures([EVENT], [replace(EVENT, until_ns=101 * SECOND)])["events.time"]
    assert not found.passed
