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


def test_of_two_events_at_one_place_each_is_held_against_the_one_of_its_time():
    later = replace(EVENT, x=2.02, since_ns=5000 * SECOND)
    found = figures([EVENT, later], [replace(EVENT, x=2.02), replace(later, x=2.0)])
    assert all(one.passed for one in found.values())
    assert found["events.time"].value == 0


def test_what_one_node_saw_does_not_take_the_partner_of_what_three_saw():
    found = figures([EVENT], [replace(EVENT, nodes=1), replace(EVENT, x=2.1)])
    assert found["events.new"].passed
    assert round(found["events.place"].value, 6) == 0.1


def test_what_three_nodes_saw_is_not_new_where_two_expected_ones_saw_it():
    weak = replace(EVENT, nodes=2)
    assert figures([weak], [weak, replace(EVENT, x=2.1)])["events.new"].passed
    assert figures([weak, replace(EVENT, x=2.1)], [weak])["events.missing"].passed


def test_of_two_equally_near_events_the_one_of_the_same_time_is_the_partner():
    expected, early = replace(EVENT, x=0.3), replace(EVENT, x=0.4)
    later = replace(EVENT, x=0.2, since_ns=EVENT.since_ns + SECOND)  # nearer by a last bit
    assert figures([expected], [early, later])["events.time"].value == 0
    assert figures([expected], [later, early])["events.time"].value == 0


def test_of_two_events_equally_far_off_the_first_is_named():
    first, second = replace(EVENT, x=0.2, y=1.0), replace(EVENT, x=0.3, y=9.0)
    found = [replace(first, x=0.3), replace(second, x=0.4)]  # the second is farther off by a last bit
    assert " at 0.20, 1.00 " in figures([first, second], found)["events.place"].text


def test_an_event_that_is_off_by_its_tolerance_to_the_centimetre_passes():
    expected, found = replace(EVENT, x=1.0), replace(EVENT, x=1.3)  # 0.30000000000000004 m in binary
    assert figures([expected], [found])["events.place"].passed
