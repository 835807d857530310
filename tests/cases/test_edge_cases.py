"""Recordings of other people that are hard to read or hold nothing to use: what each is, and what is said of it."""

from __future__ import annotations

import json

from tests.cli.program import timemap
from tests.conftest import shared_data

NO_POSES = "there are neither transforms nor poses in"


def replayed(name, tmp_path):
    ran = timemap("replay", shared_data(f"edge_cases/{name}"), "-o", tmp_path / "result.mcap", "--json")
    assert "Traceback" not in ran.err
    return ran


def refused(name, tmp_path, *said):
    ran = replayed(name, tmp_path)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.count("error: ") == 1
    for words in said:
        assert words in ran.err
    assert not (tmp_path / "result.mcap").exists()


def test_a_simulated_robot_with_odometry_only_is_used_with_a_warning(tmp_path):
    ran = replayed("basic_localization_stage.bag", tmp_path)
    assert ran.code == 0
    assert json.loads(ran.out)["scans"]["used"] == 24
    assert "no poses in 'map': using 'odom'" in ran.err


def test_scans_of_a_scanner_carried_by_hand_have_no_poses(tmp_path):
    refused("csmfail.bag", tmp_path, NO_POSES, "record /tf")


def test_scans_for_scan_matching_have_no_poses(tmp_path):
    refused("laser_scan_matcher_demo.bag", tmp_path, NO_POSES)


def test_a_bag_of_version_1_2_is_named_and_how_to_convert_it(tmp_path):
    refused("laser_scan_splitter_demo.bag", tmp_path, "is a ROS bag of version 1.2", "rosbag fix")


def test_transforms_without_scans(tmp_path):
    refused("mylaserdata.bag", tmp_path, "no laser scans in", "among /tf")


def test_a_laser_that_no_transform_places_on_the_robot(tmp_path):
    refused("mylaserdata2.bag", tmp_path, "frame 'laser' is not connected to 'map' or 'odom'", "/tf_static")


def test_a_laser_that_no_transform_places_on_the_robot_beside_odometry(tmp_path):
    refused("mylaserdata3.bag", tmp_path, "frame 'laser' is not connected to 'map' or 'odom'", "/tf_static")


def test_a_laser_whose_frame_is_called_otherwise_in_the_transforms(tmp_path):
    refused("mylaserdata4.bag", tmp_path, "no transform names it, but there is 'base_laser'")


def test_scans_with_many_blind_beams_have_no_poses(tmp_path):
    refused("pegatron5F.bag", tmp_path, NO_POSES)


def test_a_third_of_the_scans_without_poses_is_lost_data(tmp_path):
    ran = replayed("pr2_mylaserdata.bag", tmp_path)
    assert ran.code == 3
    scans = json.loads(ran.out)["scans"]
    assert (scans["read"], scans["used"], scans["dropped"]) == (32, 21, {"no_pose": 11})
    assert "more than input.max_dropped allows" in ran.err


def test_transforms_of_another_robot_without_scans(tmp_path):
    refused("robotino_mylaserdata.bag", tmp_path, "no laser scans in")


def test_a_bag_that_makes_rosbags_raise_holds_transforms_only(tmp_path):
    refused("tf_example.bag", tmp_path, "no laser scans in", "/tf_static")


def test_localisation_without_scans(tmp_path):
    refused("nav2_turtlebot.mcap", tmp_path, "no laser scans in", "/amcl_pose")


def test_a_lone_database_whose_stamps_are_of_1970_has_no_poses(tmp_path):
    refused("scan_today_bag_0.db3", tmp_path, NO_POSES)


def test_a_lone_database_with_a_topic_beside_has_no_poses(tmp_path):
    refused("test_bag_0.db3", tmp_path, NO_POSES)


def test_a_lone_database_of_transforms_has_no_scans(tmp_path):
    refused("tf_example.db3", tmp_path, "no laser scans in", "/tf_static")


def test_a_map_file_is_no_recording(tmp_path):
    refused("map_yaml_with_nan_origin.yaml", tmp_path, "is not a recording")
