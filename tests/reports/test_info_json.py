import json
from dataclasses import replace
from math import inf, nan

from tests.reports.inspections import INTEL, LOG, SCAN, STUCK
from timemap_cli.logs.pose_quality import PoseReport
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


def with_report(**values):
    found = {"covariances": "/amcl_pose", "position_std": 0.6, "yaw_std": 0.25, "jumps": 0}
    found |= {"largest_jump": 0.0, "largest_jump_ns": 0, "set_aside": {"uncertain_pose": 0, "pose_jump": 0}}
    return replace(
        INTEL, logs=(replace(LOG, scans=(replace(SCAN, pose_report=PoseReport(**(found | values))),)),)
    )


def test_how_good_the_poses_are():
    aside = {"uncertain_pose": 3, "pose_jump": 1}
    found = with_report(
        jumps=2, largest_jump=1.23456, largest_jump_ns=976_052_900_000_000_001, set_aside=aside
    )
    assert document(found)["logs"][0]["scans"][0]["pose_quality"] == {
        "covariances": "/amcl_pose",
        "position_std_m": 0.6,
        "yaw_std_deg": 14.3239,
        "jumps": 2,
        "largest_jump_m": 1.2346,
        "largest_jump_ns": "976052900000000001",
        "set_aside": aside,
    }
    unknown = with_report(covariances=None, position_std=None, yaw_std=None)
    quality = document(unknown)["logs"][0]["scans"][0]["pose_quality"]
    assert {name for name, value in quality.items() if value is None} == {
        "covariances", "position_std_m", "yaw_std_deg", "largest_jump_m", "largest_jump_ns",
    }  # fmt: skip
    assert document(INTEL)["logs"][0]["scans"][0]["pose_quality"] is None


def test_what_is_not_known_is_null():
    for value in (nan, inf, None):
        scan = replace(SCAN, rate_hz=value, range_max_m=0.0)
        (log,) = document(replace(INTEL, logs=(replace(LOG, scans=(scan,)),)))["logs"]
        assert log["scans"][0]["rate_hz"] is None
        assert log["scans"][0]["range_max_m"] is None
