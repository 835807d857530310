"""What is told of a result."""

import json

import pytest

from tests.cli.program import timemap
from tests.test_replay import standing_log
from timemap_cli.config import load
from timemap_cli.replay import replay

DAY_NS = 86_400_000_000_000


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    first, second = (standing_log(folder / f"{day}.mcap", start_ns=day * DAY_NS) for day in (1, 2))
    one = replay([first], folder / "one.timemap.mcap", load(None)).result
    two = replay([second], folder / "two.timemap.mcap", load(None), resume=one).result
    return one, two


def test_a_result_tells_its_time_its_sources_and_what_it_holds(results):
    ran = timemap("info", results[1])
    assert (ran.code, ran.err) == (0, "")
    lines = dict(line.strip().split("  ", 1) for line in ran.out.splitlines()[1:])
    assert lines["span"].strip() == "1970-01-03T00:00:00Z to 1970-01-03T00:00:09.9Z"
    assert lines["made of"].strip() == "2.mcap, resumed from one.timemap.mcap"
    assert lines["scans"].strip() == "100 read, 100 used"
    assert lines["map"].strip() == "1 node in 'map', looking 10 m far into 360 angle bins"
    # 121 beams of 1 degree, each on the border of two bins of 1 degree.
    assert lines["level short"].strip().endswith("of 1 node, 34 % of the angle bins known")
    assert lines["changes"].strip() == "0 events, 0 of them open"
    assert lines["resuming"].strip() == "timemap replay LOG... --resume RESULT"


def test_json_holds_the_same_for_each_result(results):
    found = json.loads(timemap("info", *results, "--json").out, parse_constant=pytest.fail)
    assert (found["schema"], found["logs"]) == ("timemap.info/1", [])
    one, two = found["results"]
    assert [one["path"], two["path"]] == list(map(str, results))
    assert (one["resumed_from"], two["resumed_from"]["name"]) == (None, "one.timemap.mcap")
    assert [source["name"] for source in two["inputs"]] == ["2.mcap"]
    assert two["can_be_resumed"] is True
    assert two["scans"] == {"read": 100, "used": 100, "dropped": {}}
    assert [level["name"] for level in two["levels"]] == ["short", "mid", "long"]
    assert two["levels"][0]["nodes"] == two["nodes"] == 1


def test_a_result_beside_a_recording_is_refused(results):
    ran = timemap("info", results[0], results[0].with_name("1.mcap"))
    assert ran.code == 2
    assert "one.timemap.mcap" in ran.err
