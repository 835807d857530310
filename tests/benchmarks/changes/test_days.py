"""Differences from day to day, judged."""

import pytest

from benchmarks.changes.days import judged, refusal
from benchmarks.changes.places import Event
from benchmarks.changes.recordings import timemap_json
from benchmarks.changes.table import days_table
from tests.benchmarks.changes.making import S, change, square, truth

DOOR = change("vanished", square(0, 0), (190, 290), (390, None))


def told(kind: str, day: int, x: float = 0.0) -> Event:
    start = day * 100 * S
    return Event(f"day {day}", kind, (x, 0, x + 1, 1), start, start + 50 * S, {}, (0,))


def test_every_coming_and_going_is_to_be_told_by_itself():
    events = [told("vanished", 2), told("appeared", 3), told("vanished", 4)]
    days = judged(events, "short", truth(DOOR), [0.5, 0.7])
    assert (len(days.found.match), days.at_once, days.found.f1) == (3, 3, 1.0)
    assert days.compared == pytest.approx(0.6)


def test_what_is_told_a_day_late_is_told_but_not_at_once():
    days = judged([told("vanished", 5)], "mid", truth(DOOR), [1.0])
    assert (len(days.found.match), days.at_once) == (1, 0)


def test_what_is_told_after_it_was_undone_is_false():
    days = judged([told("vanished", 3)], "mid", truth(DOOR), [1.0])
    assert (len(days.found.match), len(days.found.false)) == (0, 1)


def test_the_table_has_a_line_for_each_level():
    days = judged([told("vanished", 2), told("appeared", 5, x=9.0)], "mid", truth(DOOR), [0.25])
    line = next(line for line in days_table([days], {"mid": 0.125}).splitlines() if line.startswith("  mid "))
    assert line.split() == [
        "mid",
        "1/3",
        "1",
        "0.33",
        "0.50",
        "0.40",
        "1",
        "0",
        "1",
        "1.21",
        "25.0%",
        "12.5%",
    ]


def test_a_call_of_timemap_that_fails_says_why(tmp_path):
    with pytest.raises(RuntimeError, match=r"timemap diff ended with 2: error: .*none\.timemap\.mcap"):
        timemap_json("diff", str(tmp_path / "none.timemap.mcap"), "--level", "short", "mid")


def test_a_refusal_is_told_without_folders():
    error = RuntimeError(
        "timemap diff ended with 2: error: /a/b/one.mcap and /c/two.mcap share no nodes\n  try: x"
    )
    assert refusal(error) == "one.mcap and two.mcap share no nodes"
