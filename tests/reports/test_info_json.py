import json
from dataclasses import replace
from math import inf, nan

from tests.reports.inspections import INTEL, LOG, SCAN, STUCK
from timemap_cli.reports.info_json import info_json


def document(inspection):
    def refuse(name):
        raise AssertionError(f"{name} in JSON")

    return json.loads(info_json(inspection), parse_constant=refuse)


def test_the_fields_that_programs_read():
    found = document(INTEL)
    assert found["schema"] == "timemap.info/1"
    (log,) = found["logs"]
    assert (log["path"], log["format"]) == ("intel.mcap", "ROS 2 mcap")
    assert (log["start_ns"], log["end_ns"]) == ("976052889905799936", "976055540770000001")
    (scan,) = log["scans"]
    assert (scan["topic"], scan["frame_id"], scan["count"]) == ("/scan", "laser", 910)
    assert (scan["rate_hz"], scan["fov_deg"], scan["range_max_m"]) == (0.2986, 179.0, 80.0)
    assert scan["beams"] == {"hit": 159628, "no_return": 4172, "invalid": 0, "too_close": 0}
    assert scan["with_pose"] == 905
    assert log["poses"][1] == {
        "topic": "/odom",
        "type": "nav_msgs/msg/Odometry",
        "count": 2639,
        "frame_id": "odom",
        "child_frame_id": "base_link",
    }
    assert log["selected"] == {"scan_topics": ["/scan"], "map_frame": "map", "poses": "tf"}
    assert log["problems"] == list(LOG.problems)
    assert found["problems"] == ["odometry drifts", "b.mcap has no scans of /scan"]
    assert found["span_ns"] == ["976052889859000111", "976055540700000000"]
    assert found["no_return"] == "ignore"
    assert log["missing_returns"] == {"/scan": {"tested": 4172, "contradicted": 0.67, "are_clear": False}}


def test_without_a_selection_the_reason_is_among_the_problems():
    (log,) = document(STUCK)["logs"]
    assert log["selected"] is None
    assert document(STUCK)["span_ns"] is None
    assert log["problems"][0] == "2 scan topics and none named: /a, /b"


def test_what_is_not_known_is_null():
    for value in (nan, inf, None):
        scan = replace(SCAN, rate_hz=value, range_max_m=0.0)
        (log,) = document(replace(INTEL, logs=(replace(LOG, scans=(scan,)),)))["logs"]
        assert log["scans"][0]["rate_hz"] is None
        assert log["scans"][0]["range_max_m"] is None
