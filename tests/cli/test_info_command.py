import json
from pathlib import Path

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import written

SAMPLES = Path(__file__).parents[2] / "sample_logs"
LOGS = [SAMPLES / name for name in ("patrol_monday.mcap", "patrol_tuesday.bag", "patrol_thursday")]


def test_info_tells_what_a_replay_would_use():
    ran = timemap("info", LOGS[0])
    assert (ran.code, ran.err) == (0, "")
    assert str(LOGS[0]) in ran.out
    assert "/scan" in ran.out


def test_info_as_json_has_one_entry_for_each_log():
    ran = timemap("info", *LOGS, "--json")
    assert (ran.code, ran.err) == (0, "")
    found = json.loads(ran.out, parse_constant=pytest.fail)
    assert found["schema"] == "timemap.info/1"
    assert sorted(log["path"] for log in found["logs"]) == sorted(map(str, LOGS))
    assert {"format", "start_ns", "end_ns", "scans", "poses", "selected", "problems"} <= set(found["logs"][0])


def test_info_follows_the_settings_file(tmp_path):
    settings = tmp_path / "settings.yaml"
    settings.write_text("input: {scan_topics: [/scan], map_frame: odom}\n")
    (log,) = json.loads(timemap("info", LOGS[0], "--config", settings, "--json").out)["logs"]
    assert log["selected"]["map_frame"] == "odom"


def test_info_on_a_missing_file_or_a_result_beside_a_recording_is_a_usage_error(tmp_path):
    ran = timemap("info", tmp_path / "absent.bag")
    assert (ran.code, ran.out) == (2, "")
    assert "absent.bag" in ran.err
    ran = timemap("info", written(tmp_path / "r.timemap.mcap"), LOGS[0])
    assert (ran.code, ran.out) == (2, "")
    assert "result" in ran.err
