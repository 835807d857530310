"""Pallet halls, and how claims about rows of places are judged."""

import numpy as np
import pytest

from benchmarks.changes.maps import standing
from benchmarks.changes.scenes.pallets import turns_of
from benchmarks.changes.slots import SlotClaim, Turn, score_slots
from benchmarks.changes.worlds.clearance import clearance
from benchmarks.changes.worlds.pallet_hall import DAYS, PLACES, WORLDS, Stay, drives, route, stays
from sample_logs.world import box

LEFT, MIDDLE, RIGHT = ((x, 0.0, x + 1.2, 0.8) for x in (0.0, 1.5, 3.0))


def turn(place: int, bounds, kind: str | None = "appeared", day: int = 2, until: int | None = None) -> Turn:
    return Turn(place, kind, bounds, day, until)


def claim(bounds, kind: str = "appeared", day: int = 2) -> SlotClaim:
    return SlotClaim(kind, bounds, day)


def test_one_claim_may_tell_neighbours():
    score = score_slots([claim((0.0, 0.0, 2.7, 0.1))], [turn(0, LEFT), turn(1, MIDDLE), turn(2, RIGHT)])
    assert (score.told, score.turns, score.false, score.at_once) == (2, 3, (), 2)
    assert score.recall == pytest.approx(2 / 3)
    assert score.f1 == pytest.approx(2 * 2 / (2 * 2 + 1))


@pytest.mark.parametrize(
    "one",
    [
        claim(LEFT, kind="vanished"),
        claim((0.0, 0.0, 0.5, 0.8)),  # covers less than half
        claim((0.0, 1.2, 1.2, 1.9)),  # 0.4 m beside
        claim((0.0, 0.0, 1.8, 0.8)),  # reaches 0.6 m beyond
        claim(LEFT, day=1),
        claim(LEFT, day=4),
    ],
)
def test_what_tells_no_turn_that_holds_is_false(one):
    score = score_slots([one], [turn(0, LEFT, until=4)])
    assert (score.told, score.false, score.again) == (0, (one,), 0)


def test_telling_the_same_again_is_false_and_telling_late_is_not_at_once():
    first, again = claim(LEFT, day=3), claim(LEFT, day=4)
    score = score_slots([first, again], [turn(0, LEFT)])
    assert (score.told, score.false, score.again, score.at_once) == (1, (again,), 1, 0)


def test_what_was_filled_anew_may_be_told_or_not():
    anew = turn(0, LEFT, kind=None)
    assert score_slots([claim((0.0, 0.7, 1.2, 0.9)), claim(LEFT, kind="vanished")], [anew]).f1 == 1.0
    assert score_slots([claim((0.0, 0.0, 2.7, 0.8))], [anew, turn(1, MIDDLE)]).told == 1


def test_turns_of_a_place():
    """Filled on day 2, filled anew on day 4, emptied on day 5; another was there on day 1 alone."""
    one, other = box(3.0, 2.9, 1.2, 0.8), box(3.1, 2.9, 1.2, 0.8)
    found = turns_of([Stay(0, one, 2, 4), Stay(0, other, 4, 5), Stay(3, one, 1, 2)], 6)
    assert [(t.place, t.kind, t.day, t.until_day) for t in found] == [
        (0, "appeared", 2, 5), (0, None, 4, 5), (0, "vanished", 5, None), (3, "vanished", 2, None),
    ]  # fmt: skip
    assert found[1].bounds == pytest.approx((2.4, 2.5, 3.7, 3.3))


@pytest.mark.parametrize(
    ("world", "least", "most"), [("wh10", 0.02, 0.09), ("wh30", 0.1, 0.2), ("wh50", 0.19, 0.3)]
)
def test_so_many_places_turn_each_night(world, least, most):
    """A place that is redrawn with chance p turns with p (2 x 0.6 x 0.4)."""
    turns = [t for t in turns_of(stays(world, DAYS), DAYS) if t.kind is not None]
    assert least < len(turns) / (len(PLACES) * (DAYS - 1)) < most


def test_half_of_the_places_of_whc_stay():
    turned = {t.place for t in turns_of(stays("whc", DAYS), DAYS)}
    assert len(turned) == len(PLACES) // 2
    assert all(t.kind is None or t.day > 1 for t in turns_of(stays("whc", DAYS), DAYS))


@pytest.mark.parametrize("world", WORLDS)
def test_the_robot_keeps_clear_of_every_pallet(world):
    for day, drive in enumerate(drives(world, 3).values(), 1):
        assert clearance(route(day), standing(drive.world)) > 0.3


def test_a_world_is_the_same_every_time_and_others_differ():
    first, again, other = (drives(world, 2)["day_02"] for world in ("wh50", "wh50", "wh30"))
    assert np.array_equal(standing(first.world), standing(again.world))
    assert not np.array_equal(standing(first.world), standing(other.world))
