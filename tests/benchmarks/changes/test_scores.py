"""Figures of hand-made events."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.changes.places import claims, places_of_changes
from benchmarks.changes.scores import false_area, find, score
from benchmarks.changes.table import events_table
from benchmarks.changes.truth import Walked
from benchmarks.changes.visits import Pace
from tests.benchmarks.changes.making import S, change, event, square, truth
from timemap_cli.spans import Span

TABLE = change("moved", square(4, 0), (190, None), origin=square(0, 0))
PARCEL = change("appeared", square(8, 8), (390, 490))
DOOR = change("vanished", square(0, 9, 0.5), (190, 290), (390, 490))
TRUTH = truth(TABLE, PARCEL, DOOR)

STAMPS = np.array([n * S for n in (110, 120, 210, 220, 310, 320, 410, 420, 510, 520)])
PACES = {
    "short": Pace(Span(2.0, "obs"), {0: STAMPS}, {0: STAMPS}),
    "mid": Pace(Span(4.0, "obs"), {0: STAMPS}, {0: STAMPS[1::2]}),
}

PERFECT = (
    event("moved", (4, 0, 5, 1), 210, short=220, mid=320, moved_from=(0, 0, 1, 1)),
    event("appeared", (8, 8, 9, 9), 410, 420, short=420, toggles=2),
    event("vanished", (0, 9, 0.5, 9.5), 210, short=220, toggles=4, recurring=True),
)


def test_perfect_events_have_perfect_figures():
    perfect = score(PERFECT, TRUTH, PACES)
    assert (perfect.found.recall, perfect.found.precision, perfect.found.f1) == (1.0, 1.0, 1.0)
    assert (perfect.area, perfect.quiet_false, perfect.flicker) == (0.0, 0, 0.0)
    assert (perfect.moves, perfect.recurring) == ((1, 1), (1, 1))


def test_no_events_get_no_credit():
    nothing = score((), TRUTH, PACES)
    assert (nothing.found.recall, nothing.found.precision, nothing.found.f1) == (0.0, None, 0.0)
    assert [p.change.kind for p in nothing.found.missed] == ["moved", "moved", "appeared", "vanished"]
    assert nothing.flicker is None


def test_a_move_told_as_two_events_is_right_but_not_told_as_moved():
    two = (event("appeared", (4, 0, 5, 1), 210), event("vanished", (0, 0, 1, 1), 210))
    apart = score(two, truth(TABLE), PACES)
    assert apart.found.f1 == 1.0
    assert apart.moves == (0, 1)


def test_precision_recall_and_f1_by_hand():
    """Of four places the move's two are told, beside one claim that is false and one told again."""
    told = (PERFECT[0], event("appeared", (4, 0, 5, 1), 310), event("vanished", (20, 20, 21, 21), 210))
    found = score(told, TRUTH, PACES).found
    assert found.recall == pytest.approx(2 / 4)
    assert found.precision == pytest.approx(2 / 4)
    assert found.f1 == pytest.approx(0.5)
    assert len(found.false) == 2
    assert [c.event for c in found.again] == [told[1]]


def test_false_claims_of_quiet_days_are_counted_by_themselves():
    """Day 3 alone is quiet: the table moved before day 2, the parcel came before day 4 and went before 5."""
    loud, quiet = event("appeared", (20, 20, 21, 21), 210), event("appeared", (30, 30, 31, 32), 310)
    figures = score((loud, quiet), TRUTH, PACES)
    assert (figures.quiet_patrols, figures.quiet_false) == (1, 1)
    assert figures.quiet_area == pytest.approx(1.1 * 2.1, rel=0.05)
    assert figures.area == pytest.approx(1.1 * 1.1 + 1.1 * 2.1, rel=0.05)


def test_area_is_false_only_beyond_the_surroundings_of_the_truth():
    (place,) = places_of_changes(truth(PARCEL))
    inside, beside = (
        claims([event("appeared", box, 410)]) for box in ((7.8, 7.8, 9.2, 9.2), (9.0, 8.0, 10.0, 9.0))
    )
    assert false_area(inside, [place]) == 0.0
    assert false_area(beside, [place]) == pytest.approx((1.05 - 0.3) * 1.1, rel=0.1)
    assert false_area([*beside, *beside], [place]) == false_area(beside, [place])
    assert false_area([], [place]) == 0.0


def test_people_are_neither_right_nor_false():
    visitor = Walked("visitor", (310 * S, 340 * S), ((0.0, 5.0), (6.0, 5.0)))
    told = claims([event("appeared", (2, 5, 2.3, 5.3), 318, 322)])
    seen = find(told, [], truth(walked=(visitor,)))
    assert (len(seen.people), seen.false, seen.precision, seen.f1) == (1, [], None, 1.0)
    assert len(find(told, [], truth()).false) == 1


def test_flicker_is_toggles_beyond_the_true_ones_per_event():
    restless = event("moved", (4, 0, 5, 1), 210, moved_from=(0, 0, 1, 1), toggles=5)  # 4 too many
    assert score((restless, PERFECT[1]), TRUTH, PACES).flicker == pytest.approx(4 / 2)
    still_open = event("appeared", (8, 8, 9, 9), 410, toggles=1)
    assert score((still_open,), TRUTH, PACES).flicker == 0.0


def test_delay_counts_half_lives_from_the_change_to_its_adoption():
    """Scans of the node from 190 s: 210, 220, 310, 320. By 220 s short has 2 of 2, by 320 s mid 4 of 4.

    Short is estimated after each scan, mid after every second.
    """
    taken = {a.level: a for a in score(PERFECT[:1], truth(TABLE), PACES).adoptions}
    assert (taken["short"].at_least, taken["short"].half_lives) == (0.5, 1.0)
    assert (taken["mid"].at_least, taken["mid"].half_lives) == (0.5, 1.0)
    assert not any(a.late for a in taken.values())


@pytest.mark.parametrize(("mid_s", "at_least", "late"), [(420, 1.0, False), (520, 1.5, True)])
def test_a_level_is_late_if_the_estimate_before_could_have_shown_it(mid_s, at_least, late):
    """Mid is estimated at 220, 320, 420, 520 s, each time half a half-life later."""
    one = event("vanished", (0, 0, 1, 1), 210, mid=mid_s)
    (_, mid) = score((one,), truth(TABLE), PACES).adoptions
    assert (mid.at_least, mid.late) == (at_least, late)
    assert mid.half_lives == at_least + 0.5


def test_a_level_that_never_adopts_is_overdue_after_its_time():
    (short, mid) = score((event("vanished", (0, 0, 1, 1), 210),), truth(TABLE), PACES).adoptions
    assert (short.half_lives, short.adopted, short.late) == (4.0, False, True)
    assert (mid.half_lives, mid.adopted, mid.late) == (2.0, False, True)


def test_a_level_has_no_longer_than_the_change_holds():
    """The parcel stood for the two scans of day 4: one half-life of short, half of mid's."""
    (short, mid) = score((event("appeared", (8, 8, 9, 9), 410),), truth(PARCEL), PACES).adoptions
    assert (short.half_lives, mid.half_lives, mid.late) == (1.0, 0.5, False)


def test_what_recurs_or_names_no_node_has_no_delay():
    assert score(PERFECT[2:], truth(DOOR), PACES).adoptions == ()
    assert score((replace(PERFECT[1], nodes=()),), truth(PARCEL), PACES).adoptions == ()


def test_the_table_names_what_was_missed_and_what_is_false():
    lines = events_table(
        score((PERFECT[0], event("appeared", (20, 20, 21, 21), 210)), TRUTH, PACES)
    ).splitlines()
    assert lines[1].split() == ["places", "told", "2", "of", "4"]
    assert [line.split()[:2] for line in lines if "missed" in line] == [
        ["missed", "appeared"], ["missed", "appeared/vanished"],
    ]  # fmt: skip
    assert [line.split()[-2:] for line in lines if line.startswith("    false")] == [
        ["20.00..21.00,", "20.00..21.00"]
    ]
