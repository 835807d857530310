"""`timemap changes`: which events are told, in which order and form."""

import csv
import io
import json

import numpy as np
import pytest

from tests.cli.program import timemap
from tests.results.events import event
from tests.results.rooms import CONFIG, NODES, REPORT, SECOND, T0, all_levels, new_writer
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Episode
from timemap_cli.reports.changes_json import changes_document

HOUR = 3600 * SECOND
EVENTS = [
    event(0),  # a square of 1 m at (1..2, 2..3), seen for a second
    event(
        1,
        kind=Kind.VANISHED,
        points=event().points + np.array([10.0, 0.0]),
        adopted={"short": T0, "mid": T0 + SECOND, "long": None},
        episodes=(Episode(T0, T0 + 5 * SECOND), Episode(T0 + 8 * SECOND, T0 + 9 * SECOND)),
        last_seen_ns=T0 + 9 * SECOND,
        support=0.9,
    ),
    event(
        2,
        kind=Kind.MOVED,
        points=event().points * 0.1,
        moved_from=(4.0, 1.0),
        first_seen_ns=T0 + 6 * SECOND,
        episodes=(Episode(T0 + 6 * SECOND, None),),
        last_seen_ns=T0 + 7 * SECOND,
        looked_ns=T0 + 7 * SECOND,
    ),
]


@pytest.fixture
def result(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "room.timemap.mcap"
    with new_writer(path) as writer:
        for now_ns in (T0, T0 + 20 * SECOND):
            writer.write_nodes(NODES, now_ns)
            writer.write_estimates(all_levels(0, now_ns, seed=0), now_ns)
        writer.finish({}, CONFIG, REPORT, changes_document(EVENTS, T0 + 2 * HOUR))
    return path.name


def ids(*args):
    ran = timemap("changes", *args, "--json")
    assert (ran.code, ran.err) == (0, ""), ran.err
    return [one["id"] for one in json.loads(ran.out)["events"]]


def test_all_events_are_told_in_order_of_time(result):
    assert ids(result) == [0, 1, 2]


@pytest.mark.parametrize(
    ("wanted", "told"),
    [
        (["--kind", "moved"], [2]),
        (["--kind", "moved", "--kind", "vanished"], [1, 2]),
        (["--level", "mid"], [1]),
        (["--level", "short"], [0, 1, 2]),
        (["--level", "long"], []),
        (["--holding"], [0, 2]),
        (["--since", "+9s"], [0, 2]),  # an episode ends just before its end
        (["--since", "+8.5s"], [0, 1, 2]),
        (["--since", "11s"], [0, 2]),  # 11 s before the end, at 20 s
        (["--since", "12s"], [0, 1, 2]),
        (["--until", "+6s"], [0, 1]),
        (["--since", "+5.5s", "--until", "+7.5s"], [0, 2]),  # event 1 was undone just then
        (["--region", 0, 0, 0.5, 0.5], [2]),
        (["--region", 1.5, 2.5, 11.5, 2.6], [0, 1]),
        (["--min-size", 0.5], [0, 1]),
        (["--min-size", 1.4142], [0, 1]),
        (["--min-size", 1.4143], []),
        (["--min-age", "5s"], [1]),
        (["--sort", "size"], [0, 1, 2]),
        (["--sort", "support"], [1, 0, 2]),
        (["--sort", "place"], [2, 0, 1]),
    ],
)
def test_only_what_is_wanted_is_told(result, wanted, told):
    assert ids(result, *wanted) == told


def test_the_summary_counts_what_is_told(result):
    told = json.loads(timemap("changes", result, "--kind", "vanished", "--json").out)
    assert told["schema"] == "timemap.changes/1"
    assert told["summary"] == {
        "appeared": 0, "vanished": 1, "moved": 0, "events": 1, "open": 0, "recurring": 1, "toggles": 3,
    }  # fmt: skip


def test_the_json_has_its_fixed_fields_with_times_as_strings(result):
    first, second, third = json.loads(timemap("changes", result, "--json").out)["events"]
    assert first["bounds"] == [1, 2, 2, 3]
    assert (first["x"], first["y"], first["support"], first["nodes"]) == (1.5, 2.5, 0.75, [0])
    assert first["first_seen_ns"] == str(T0)
    assert first["adopted"] == {"short": str(T0), "mid": None, "long": None}
    assert (first["closed_ns"], first["not_seen_since"]) == (None, True)
    assert (second["closed_ns"], second["recurring"]) == (str(T0 + 9 * SECOND), True)
    assert third["moved_from"] == [4, 1]


def test_the_table_says_what_where_since_when_and_who_adopted_it(result):
    ran = timemap("changes", result)
    head, _, titles, *rows = ran.out.splitlines()
    assert head == "3 change events."
    assert titles.split("  ")[0] == "id"
    assert [row.split()[:4] for row in rows] == [
        ["0", "appeared", "1.50,", "2.50"],
        ["1", "vanished", "11.50,", "2.50"],
        ["2", "moved", "0.15,", "0.25"],
    ]
    assert "came 2 times" in rows[1]
    assert "short, mid" in rows[1]
    assert "from 4.00, 1.00" in rows[2]
    assert "not looked at since" in rows[2]
    assert "3 of 4" in rows[0]


def test_what_is_left_out_is_counted(result):
    assert timemap("changes", result, "--kind", "moved").out.startswith("1 change event (2 left out).\n")
    assert timemap("changes", result, "--min-size", 9).out == "No change events (3 left out).\n"


def test_the_lines_for_a_spreadsheet_have_the_same_numbers(result):
    first, second, _ = csv.DictReader(io.StringIO(timemap("changes", result, "--csv").out))
    assert (first["kind"], first["x"], first["x_min"], first["y_max"]) == ("appeared", "1.5", "1.0", "3.0")
    assert (first["closed"], first["adopted_mid"]) == ("", "")
    assert second["closed"] == "2023-11-14T22:13:29.123456789Z"
    assert second["adopted_mid"] == "2023-11-14T22:13:21.123456789Z"


def test_polygons_are_closed_and_in_metres(result):
    told = json.loads(timemap("changes", result, "--geojson").out)
    assert told["type"] == "FeatureCollection"
    feature = told["features"][0]
    (ring,) = feature["geometry"]["coordinates"]
    assert ring[0] == ring[-1]
    assert {tuple(corner) for corner in ring} == {(x, y) for x in (0.975, 2.025) for y in (1.975, 3.025)}
    assert (feature["id"], feature["properties"]["kind"]) == (0, "appeared")
    assert "outline" not in feature["properties"]


def test_without_a_result_the_newest_of_the_folder_is_taken_and_named(result):
    ran = timemap("changes")
    assert ran.err == f"using {result}, the newest result in this folder\n"
    assert ran.out.startswith("3 change events")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--level", "slow"], "has no level 'slow', only short, mid, long"),
        (["--since", "soon"], "'soon' is not a time"),
        (["--min-age", "5obs"], "--min-age is a time"),
        (["--min-age", "old"], "--min-age 'old' is not a number with one of the units s, min, h"),
        (["--kind", "gone"], "'gone' is not one of"),
        (["--region", 1, 2, 3], "requires 4 arguments"),
        (["--region", 3, 1, 0, 2], "a MIN is above its MAX"),
        (["--region", 0, 2, 3, 1], "a MIN is above its MAX"),
    ],
)
def test_what_cannot_be_meant_is_one_error(result, args, said):
    ran = timemap("changes", result, *args)
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err.splitlines()[0]


def test_a_region_the_wrong_way_round_is_proposed_the_right_way_round(result):
    ran = timemap("changes", result, "--region", 3, 1.5, 0, 2)
    assert ran.err.splitlines()[1:] == ["  try: --region 0 1.5 3 2"]


@pytest.mark.parametrize("option", ["--since", "--until"])
def test_a_bare_number_is_no_time_of_these_years(result, option):
    ran = timemap("changes", result, option, "5")
    assert ran.code == 2
    assert "'5' alone is nanoseconds since 1970" in ran.err
    assert "+10s" in ran.err
