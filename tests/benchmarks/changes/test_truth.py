"""The truth of the building, and its form as JSON."""

import json

import pytest

from benchmarks.changes.truth import Walked, bounds_of, building_truth, gap
from benchmarks.changes.truth_json import from_json, to_json
from benchmarks.changes.worlds.patrols import FIRST_NS, patrols
from tests.benchmarks.changes.making import S, change, square, truth

DAY_NS = 86_400 * S


def day(number: int) -> int:
    """Stamp at which a day begins."""
    return FIRST_NS + (number - 1) * DAY_NS


@pytest.fixture(scope="module")
def building():
    return building_truth(patrols())


def test_every_change_has_its_kind(building):
    kinds = {c.what: c.kind for c in building.changes}
    assert kinds == {
        "door": "vanished", "pallet": "appeared", "cabinet": "appeared", "armchair": "vanished",
        "table": "moved", "bookcase": "moved", "bin": "moved", "crates": "moved", "trolley": "moved",
    }  # fmt: skip


def test_the_pallet_holds_from_day_6_until_day_8(building):
    (pallet,) = [c for c in building.changes if c.what == "pallet"]
    assert [(e.since_ns, e.until_ns) for e in pallet.episodes] == [(day(6), day(8))]
    assert bounds_of(pallet.outline) == pytest.approx((10.0, 5.8, 11.2, 6.6))


def test_the_door_recurs_on_even_days(building):
    (door,) = [c for c in building.changes if c.recurring]
    assert [e.since_ns for e in door.episodes] == [day(d) for d in (2, 4, 6, 8, 10, 12)]
    assert [e.until_ns for e in door.episodes] == [*(day(d) for d in (3, 5, 7, 9, 11)), None]


def test_moved_furniture_tells_both_places(building):
    (table,) = [c for c in building.changes if c.what == "table"]
    assert bounds_of(table.from_outline) == pytest.approx((1.8, 9.75, 3.6, 10.65))
    assert bounds_of(table.outline) == pytest.approx((6.55, 8.7, 7.45, 10.5))
    assert [(e.since_ns, e.until_ns) for e in table.episodes] == [(day(4), None)]


def test_on_quiet_days_nothing_changed_but_the_door(building):
    assert [r.day for r in building.quiet()] == [2, 3, 5, 7, 9, 10, 11, 12]


def test_a_shorter_truth_leaves_out_what_changes_later():
    assert {c.what for c in building_truth(patrols(3)).changes} == {"door"}
    assert "pallet" in {c.what for c in building_truth(patrols(6)).changes}


def test_the_json_reads_back_as_it_was(building):
    assert from_json(to_json(building)) == building


def test_the_json_says_what_people_look_for(building):
    document = json.loads(to_json(building))
    door = next(c for c in document["changes"] if c["what"] == "door")
    assert document["schema"] == "timemap.building/1"
    assert door["recurring"] is True
    assert door["episodes"][0] == {"since_ns": str(day(2)), "until_ns": str(day(3))}
    assert door["bounds"] == pytest.approx([12.45, 6.67, 13.55, 6.73])
    assert document["recordings"][0]["walked"][0]["stamps_ns"][0].isdigit()


def test_another_schema_is_refused():
    with pytest.raises(ValueError, match=r"'timemap.samples/1', not 'timemap.building/1'"):
        from_json('{"schema": "timemap.samples/1"}')


@pytest.mark.parametrize(
    ("other", "distance"),
    [((0.5, 0.5, 3, 3), 0.0), ((1, 0, 2, 1), 0.0), ((1.3, 0, 2, 1), 0.3), ((4, 5, 6, 6), 5.0)],
)
def test_gap_is_the_distance_between_rectangles(other, distance):
    assert gap((0, 0, 1, 1), other) == pytest.approx(distance)
    assert gap(other, (0, 0, 1, 1)) == pytest.approx(distance)


def test_somebody_is_near_only_while_there():
    walked = Walked("visitor", (10 * S, 20 * S), ((0.0, 0.0), (10.0, 0.0)))
    thing = (5.0, 1.0, 6.0, 2.0)
    assert walked.nearest(thing, 10 * S, 20 * S) == pytest.approx(1.0)
    assert walked.nearest(thing, 10 * S, 12 * S) == pytest.approx(10**0.5, abs=0.01)  # from (2, 0)
    assert walked.nearest(thing, 21 * S, 30 * S) == float("inf")


def test_a_day_after_something_is_undone_is_not_quiet():
    parcel = change("appeared", square(0, 0), (190, 290))
    assert [r.day for r in truth(parcel).quiet()] == [4, 5]


def test_what_changes_during_a_patrol_may_be_seen_on_the_next_only():
    assert [r.day for r in truth(change("vanished", square(0, 0), (320, None))).quiet()] == [2, 5]
