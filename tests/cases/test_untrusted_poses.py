"""Recordings in which the localiser is unsure or jumps: what a replay sets aside, and what is told of it."""

import json

import numpy as np
import pytest

from tests.cli.program import timemap
from tests.logs.recorded import ROS2, Message, pose_with_covariance, transforms, write_mcap
from tests.simulated import MOTION, in_order, moving, numbers, scanner, scans, stamp, static, times

LASER = scanner()
UNSURE = 0.8  # [m]


def amcl(unsure, period=0.5):
    """Poses beside the transforms; unsure from a time to another, both included [s]."""
    for at in times(period).tolist():
        std = UNSURE if unsure[0] <= at <= unsure[1] else 0.05
        covariance = np.diag([std**2, 0.01, 0, 0, 0, 0.01]).ravel()
        content = pose_with_covariance(ROS2, stamp(at), numbers(MOTION.at(np.array(at))), covariance)
        yield Message("/amcl_pose", stamp(at + 0.03), content)


def resetting(at_s, shift, period=0.25):
    """Odometry that is reset at a time [s], after which it is `shift` off; corrections come once a period."""

    def map_from_odom(at):
        return np.array([shift, 0.0, 0.0]) if at >= at_s else np.zeros(3)

    for at in times(0.05).tolist():
        odom_from_base = MOTION.at(np.array(at)) - map_from_odom(at)
        edge = stamp(at), "odom", "base_link", numbers(odom_from_base)
        yield Message("/tf", stamp(at + 0.01), transforms(ROS2, edge))
    for at in times(period, 0.1).tolist():
        edge = stamp(at), "map", "odom", numbers(map_from_odom(at))
        yield Message("/tf", stamp(at + 0.02), transforms(ROS2, edge))


def told(tmp_path, *parts, **gate):
    """The documents of `replay --json` and `info --json`, what both print for people, and the exit code."""
    log = write_mcap(tmp_path / "log.mcap", in_order([static((LASER, "laser"))], scans(LASER), *parts))
    settings = tmp_path / "settings.yaml"
    settings.write_text(f"gate: {json.dumps(gate)}\n")
    ran = timemap("replay", log, "-o", tmp_path / "out.mcap", "--force", "--config", settings, "--json")
    info = timemap("info", log, "--config", settings)
    (topic,) = json.loads(timemap("info", log, "--config", settings, "--json").out)["logs"][0]["scans"]
    return json.loads(ran.out)["scans"], ran, topic["pose_quality"], info.out


def test_a_good_recording_loses_nothing(tmp_path):
    replayed, ran, quality, info = told(tmp_path, moving(), amcl((99, 99)))
    assert replayed == {"read": 310, "used": 310, "dropped": {}}
    assert (ran.code, ran.err) == (0, "")
    assert (quality["covariances"], quality["position_std_m"], quality["yaw_std_deg"]) == (
        "/amcl_pose",
        0.1,
        5.7296,
    )
    assert (quality["jumps"], quality["set_aside"]) == (0, {"uncertain_pose": 0, "pose_jump": 0})
    assert "poses uncertain by up to 0.1 m and 5.7 deg (one standard deviation, /amcl_pose)" in info


def test_scans_of_a_localiser_that_is_unsure_are_set_aside_and_told(tmp_path):
    """Unsure from 10.0 to 12.0 s: of the scans at every 0.1 s those after 9.5 and before 12.5 s."""
    replayed, ran, quality, info = told(tmp_path, moving(), amcl((10.0, 12.0)))
    assert replayed == {"read": 310, "used": 281, "dropped": {"uncertain_pose": 29}}
    assert ran.code == 3  # more than 5 % of the scans
    assert "29 scans were set aside because their pose cannot be trusted (uncertain_pose 29)" in ran.err
    assert quality["position_std_m"] == UNSURE
    assert quality["set_aside"] == {"uncertain_pose": 29, "pose_jump": 0}
    assert "29 scans would be set aside: uncertain_pose 29" in info


@pytest.mark.parametrize("gate", [{"max_position_std": 0}, {"max_position_std": 0.81}])
def test_the_limit_is_a_setting(tmp_path, gate):
    replayed, _, quality, _ = told(tmp_path, moving(), amcl((10.0, 12.0)), **gate)
    assert replayed["dropped"] == {}
    assert quality["position_std_m"] == UNSURE


def test_scans_within_a_jump_are_set_aside_and_told(tmp_path):
    """The odometry is reset at 10.05 s; the corrections around that come at 9.85 and 10.1 s. Between them lie the end
    of the sweep that begins at 9.8 s, and those that begin at 9.9 and 10.0 s; the next has the pose after both."""
    replayed, ran, quality, info = told(tmp_path, resetting(10.05, 1.0))
    assert replayed["dropped"] == {"pose_jump": 3}
    assert "3 scans were set aside because their pose cannot be trusted (pose_jump 3)" in ran.err
    assert (quality["jumps"], quality["largest_jump_m"], quality["largest_jump_ns"]) == (
        1,
        1.0,
        str(stamp(9.8)),
    )
    assert "poses jump once, by 1 m at 2023-11-14T22:13:29.8Z" in info
    assert "3 scans would be set aside: pose_jump 3" in info


@pytest.mark.parametrize(("shift", "gate"), [(0.4, {}), (1.0, {"max_jump": 0}), (1.0, {"max_jump": 1.1})])
def test_smaller_jumps_are_believed(tmp_path, shift, gate):
    replayed, ran, quality, _ = told(tmp_path, resetting(10.05, shift), **gate)
    assert replayed["dropped"] == {}
    assert ran.code == 0
    assert quality["jumps"] == 0
