"""Which claims tell which places."""

import pytest

from benchmarks.changes.matching import fits, match, of_people
from benchmarks.changes.places import claims, places_of_changes
from benchmarks.changes.truth import Walked
from tests.benchmarks.changes.making import S, change, event, square, truth

PARCEL = change("appeared", square(2, 2), (190, 390))
(PLACE,) = places_of_changes(truth(PARCEL))


def claim(kind="appeared", bounds=(2, 2, 3, 3), first_s=210, **more):
    (one,) = claims([event(kind, bounds, first_s, **more)])
    return one


@pytest.mark.parametrize(
    ("bounds", "right"),
    [
        ((2, 2, 3, 3), True),
        ((2.4, 2.9, 2.6, 3.1), True),  # overlaps
        ((3.29, 2, 3.4, 3), True),
        ((3.31, 2, 3.4, 3), False),  # 0.31 m beside
        ((3.25, 3.25, 3.4, 3.4), False),  # 0.35 m beside, across the corner
        ((1.6, 1.6, 3.4, 3.4), True),
        ((1.4, 2, 3, 3), False),  # reaches 0.6 m beyond
    ],
)
def test_a_claim_is_at_a_place_if_it_is_near_and_not_much_larger(bounds, right):
    assert fits(claim(bounds=bounds), PLACE) == right


def test_another_kind_does_not_fit():
    assert not fits(claim(kind="vanished"), PLACE)


@pytest.mark.parametrize(("first_s", "right"), [(189, False), (190, True), (389, True), (390, False)])
def test_a_claim_is_first_seen_while_the_change_holds(first_s, right):
    assert fits(claim(first_s=first_s), PLACE) == right


def test_no_level_may_adopt_a_change_before_it_happened():
    assert not fits(claim(first_s=210, short=180), PLACE)
    assert fits(claim(first_s=210, short=220, mid=500), PLACE)


def test_one_claim_tells_one_place():
    two = claim(), claim(bounds=(2.5, 2, 3, 3))
    assert match(two, [PLACE]) == {0: 0}


def test_as_many_places_are_told_as_can_be():
    """The first claim fits both places, the second only the first place: both are told."""
    left, right = places_of_changes(truth(PARCEL, change("appeared", square(3.2, 2), (190, None))))
    both, only_left = claim(bounds=(2.9, 2, 3.3, 3)), claim(bounds=(2, 2, 2.2, 3))
    assert match([both, only_left], [left, right]) == {0: 1, 1: 0}


def test_nothing_told_matches_nothing():
    assert match([], [PLACE]) == {}
    assert match([claim()], []) == {}


VISITOR = Walked("visitor", (310 * S, 340 * S), ((0.0, 0.0), (6.0, 0.0)))  # at x = 2 after 10 s


def passing(kind="appeared", bounds=(1.8, 0.3, 2.2, 0.6), first_s=318, last_s=322, **more):
    return event(kind, bounds, first_s, last_s, **more)


def test_somebody_passing_is_of_people():
    assert of_people(passing(), truth(walked=(VISITOR,)))
    assert of_people(passing(short=319), truth(walked=(VISITOR,)))


@pytest.mark.parametrize(
    "one",
    [
        passing(mid=330),  # in a slow level
        passing(kind="vanished"),
        passing(last_s=379),  # 61 s
        passing(bounds=(1.8, 0.6, 2.2, 0.9)),  # 0.6 m from the way
        passing(first_s=335, last_s=336),  # the visitor was there 10 s before
        passing(first_s=118, last_s=122),  # nobody walked on that day
    ],
)
def test_what_lasts_or_is_where_nobody_was_is_not(one):
    assert not of_people(one, truth(walked=(VISITOR,)))
