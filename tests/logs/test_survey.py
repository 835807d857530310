"""Surveys and inspections of small recordings written here, read as any other."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tests.logs.recorded import ROS2, START_NS, Message, pose_stamped, scan, transforms, write_mcap
from timemap_cli.config import load
from timemap_cli.errors import UsageError
from timemap_cli.logs.inspect import inspect
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.sampling import LEAST_WINDOW_NS, take_sample, windows
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.survey import survey

BEARINGS = np.radians(np.arange(-60.0, 61.0))
STILL = (0, 0, 0, 1)


def wall_log(
    path: Path,
    n_scans=60,
    holes=None,
    start_ns=START_NS,
    world="map",
    topic="/scan",
    every=3,
    pose_topic=None,
):
    """Of ``wall_messages``."""
    return write_mcap(path, wall_messages(n_scans, holes, start_ns, world, topic, every, pose_topic))


def wall_messages(
    n_scans=60, holes=None, start_ns=START_NS, world="map", topic="/scan", every=3, pose_topic=None, x_m=0.0
):
    """A robot that looks along x at a wall 2 m away and drives along it; every third scan has holes."""
    mount = transforms(ROS2, (start_ns, "base_link", "laser", (0, 0, 0.2, *STILL)))
    messages = [Message("/tf_static", start_ns, mount)]
    for i in range(n_scans):
        now = start_ns + i * 100_000_000
        ranges = 2 / np.cos(BEARINGS)
        if holes is not None and i % every == 0:
            ranges[holes] = np.inf
        place = (x_m, 0.02 * i, 0, *STILL)
        if pose_topic:
            messages.append(Message(pose_topic, now, pose_stamped(ROS2, now, place, world)))
        else:
            messages.append(Message("/tf", now, transforms(ROS2, (now, world, "base_link", place))))
        shape = {"angle_min": float(BEARINGS[0]), "angle_increment": float(np.radians(1.0))}
        messages.append(Message(topic, now + 1_000_000, scan(ROS2, now, ranges, **shape)))
    return messages


def surveyed(*paths, **wanted):
    recordings = open_recordings(paths)
    try:
        return survey(recordings, load(None, {"input": wanted}))
    finally:
        for recording in recordings:
            recording.close()


def test_a_plain_recording_needs_no_option(tmp_path):
    found = surveyed(wall_log(tmp_path / "a.mcap"))
    assert found.selection == Selection(("/scan",), "map", "tf")
    assert list(found.beams) == [(0, "/scan")]
    assert found.beams[0, "/scan"].clear_range == 30.0
    assert (found.no_return, found.contradicted, found.problems) == ("clear", None, ())


def test_a_scanner_that_sees_less_far_than_a_node_is_told(tmp_path):
    log = wall_log(tmp_path / "a.mcap")
    recordings = open_recordings([log])
    found = survey(recordings, load(None, {"map": {"radius": 35.0}}))
    assert found.problems == (
        "/scan reaches 30 m and nodes look 35 m: little or nothing is seen clear; "
        "set map.radius to 29 (see timemap config)",
    )
    recordings[0].close()


def test_missing_returns_through_walls_are_ignored(tmp_path):
    found = surveyed(wall_log(tmp_path / "a.mcap", holes=slice(40, 80)))
    assert found.no_return == "ignore"
    assert found.contradicted > 0.9
    assert not found.beams[0, "/scan"].missing_is_clear


def test_the_user_decides_what_a_missing_return_is(tmp_path):
    log = wall_log(tmp_path / "a.mcap", holes=slice(40, 80))
    assert surveyed(log, no_return="clear").no_return == "clear"
    beside = wall_log(tmp_path / "b.mcap", holes=slice(60, 121), every=1)
    assert surveyed(beside).no_return == "clear"
    ignored = surveyed(beside, no_return="ignore")
    assert (ignored.no_return, ignored.missing_returns) == ("ignore", {})


def test_a_pose_topic_gives_poses_where_transforms_do_not(tmp_path):
    found = surveyed(wall_log(tmp_path / "a.mcap", pose_topic="/amcl_pose"))
    assert found.selection == Selection(("/scan",), "map", "/amcl_pose")


def test_recordings_are_surveyed_together(tmp_path):
    logs = [
        wall_log(tmp_path / "a.mcap", holes=slice(40, 80)),
        wall_log(tmp_path / "b.mcap", holes=slice(40, 80), start_ns=START_NS + 86_400_000_000_000),
    ]
    found = surveyed(*logs)
    assert list(found.beams) == [(0, "/scan"), (1, "/scan")]
    assert found.contradicted > 0.9


def test_a_recording_without_poses_in_the_map_is_told(tmp_path):
    later = START_NS + 86_400_000_000_000
    logs = [wall_log(tmp_path / "a.mcap"), wall_log(tmp_path / "b.mcap", start_ns=later, world="odom")]
    found = surveyed(*logs)
    assert found.selection.map_frame == "map"
    assert found.problems == (f"{logs[1]} has no poses in 'map' for /scan",)


def test_a_recording_without_the_scan_topic_is_told(tmp_path):
    later = START_NS + 86_400_000_000_000
    logs = [
        wall_log(tmp_path / "a.mcap"),
        wall_log(tmp_path / "b.mcap", start_ns=later, topic="/other_scan"),
    ]
    found = surveyed(*logs, scan_topics=["/scan"])
    assert found.problems == (f"{logs[1]} has no scans of /scan",)


def test_a_recording_without_scans_is_an_error(tmp_path):
    log = write_mcap(tmp_path / "a.mcap", [Message("/p", 1, pose_stamped(ROS2, 1, (0, 0, 0, *STILL)))])
    with pytest.raises(UsageError, match="no laser scans in"):
        surveyed(log)


def slow_log(path, every_s, duration=600, topic=None):
    """A robot whose odometry comes at 5 Hz and whose place in the map, or on a topic, comes seldom."""
    mount = transforms(ROS2, (START_NS, "base_link", "laser", (0, 0, 0.2, *STILL)))
    messages = [Message("/tf_static", START_NS, mount)]
    for i in range(5 * duration):
        now = START_NS + i * 200_000_000
        odometry = (now, "odom", "base_link", (0.01 * i, 0, 0, *STILL))
        messages.append(Message("/tf", now, transforms(ROS2, odometry)))
        messages.append(Message("/scan", now + 1, scan(ROS2, now, [2, 2, 2, 2, 2])))
        if i % round(5 * every_s) == 0:
            place = (0.01 * i, 0, 0, *STILL) if topic else (0, 0, 0, *STILL)
            stamp_ns = now - 100_000_000  # never that of a scan
            content = (
                pose_stamped(ROS2, stamp_ns, place)
                if topic
                else transforms(ROS2, (stamp_ns, "map", "odom", place))
            )
            messages.append(Message(topic or "/tf", now + 2, content))
    return write_mcap(path, messages)


@pytest.mark.parametrize("every_s", [6.5, 10])
def test_poses_may_come_as_seldom_as_they_are_looked_up(tmp_path, every_s):
    found = surveyed(slow_log(tmp_path / "a.mcap", every_s))
    assert (found.selection, found.problems) == (Selection(("/scan",), "map", "tf"), ())
    found = surveyed(slow_log(tmp_path / "b.mcap", every_s, topic="/amcl_pose"))
    assert (found.selection, found.problems) == (Selection(("/scan",), "map", "/amcl_pose"), ())


def parts_of(path, n_scans=600):
    """The same drive in two recordings: one has the scans, one the transforms, which begins 30 s later."""
    whole = wall_messages(n_scans)
    scans = [one for one in whole if one.topic == "/scan"]
    rest = [one for one in whole if one.topic != "/scan" and one.log_ns >= START_NS + 30_000_000_000]
    return [
        write_mcap(path / "scans.mcap", scans),
        write_mcap(path / "tf.mcap", [*(one for one in whole if one.topic == "/tf_static"), *rest]),
    ]


def test_scans_and_transforms_may_be_in_two_recordings(tmp_path):
    logs = parts_of(tmp_path)
    found = surveyed(*logs)
    assert found.selection == Selection(("/scan",), "map", "tf")
    assert found.drives == ((0, 1),)
    assert found.problems == (f"{logs[1]} has no scans of /scan",)


def test_inspection_takes_the_transforms_of_the_whole_drive(tmp_path):
    found = inspect(parts_of(tmp_path), load(None))
    assert found.selection == Selection(("/scan",), "map", "tf")
    assert found.logs[1].scans[0].with_pose == 300
    assert [pose.topic for pose in found.logs[1].poses] == []


def test_runs_of_one_simulated_time_are_drives_of_their_own(tmp_path):
    logs = [
        write_mcap(tmp_path / "a.mcap", wall_messages(300)),
        write_mcap(tmp_path / "b.mcap", wall_messages(300, start_ns=START_NS + 50_000_000, x_m=4.0)),
    ]
    found = surveyed(*logs)
    assert found.drives == ((0,), (1,))
    assert found.problems == (
        f"{logs[0]} and {logs[1]} hold other poses for the same times, as of two robots or two simulations: "
        "they are read one after the other",
    )


def test_recordings_of_one_robot_by_two_recorders_are_one_drive(tmp_path):
    whole = wall_messages(300)
    logs = [
        write_mcap(tmp_path / f"{name}.mcap", [whole[0], *whole[1 + at :: 3]])
        for at, name in enumerate("abc")
    ]
    found = surveyed(*logs)
    assert (found.drives, found.problems) == (((0, 1, 2),), ())


def test_two_surveys_are_equal(tmp_path):
    log = wall_log(tmp_path / "a.mcap", holes=slice(40, 80))
    assert surveyed(log) == surveyed(log)


def test_a_long_recording_is_sampled_in_windows_spread_over_it(tmp_path):
    (recording,) = open_recordings([wall_log(tmp_path / "a.mcap", n_scans=600)])
    with recording:
        found = list(windows(recording, 600))
    assert found[0][0] == recording.start_ns
    assert found[-1][1] == recording.end_ns + 1
    assert {stop - start for start, stop in found} == {LEAST_WINDOW_NS}
    assert all(one[1] < other[0] for one, other in pairwise(found))


def test_a_sample_is_small_and_holds_all_static_transforms(tmp_path):
    (recording,) = open_recordings([wall_log(tmp_path / "a.mcap", n_scans=1500)])
    with recording:
        sample = take_sample([recording], ["/scan"])
    count = sum(len(batch.stamps_ns) for batch in sample.scans[0, "/scan"])
    assert 200 <= count <= 450
    assert [(batch.parent, batch.child) for batch in sample.static.all] == [("base_link", "laser")]


def test_scans_that_no_window_meets_are_found(tmp_path):
    """Scans in one second of an hour."""
    hour = 3_600_000_000_000
    log = wall_log(tmp_path / "a.mcap", n_scans=10, start_ns=START_NS + hour // 2 + 77_000_000_000)
    ends = [
        Message("/tf", at, transforms(ROS2, (at, "map", "base_link", (0, 0, 0, *STILL))))
        for at in (START_NS, START_NS + hour)
    ]
    write_mcap(tmp_path / "b.mcap", ends)
    recordings = open_recordings([log])
    recordings[0].start_ns, recordings[0].end_ns = START_NS, START_NS + hour
    with recordings[0]:
        sample = take_sample(recordings, ["/scan"])
    assert sum(len(batch.stamps_ns) for batch in sample.scans[0, "/scan"]) == 10


def test_inspection_counts_scans_poses_and_beams(tmp_path):
    found = inspect([wall_log(tmp_path / "a.mcap", holes=slice(40, 80))], load(None))
    (log,) = found.logs
    (topic,) = log.scans
    assert (topic.topic, topic.frame_id, topic.count, topic.with_pose) == ("/scan", "laser", 60, 60)
    assert topic.rate_hz == pytest.approx(10)
    assert topic.fov_deg == pytest.approx(120, abs=0.01)
    assert (topic.beams.hit, topic.beams.no_return) == (60 * 121 - 20 * 40, 20 * 40)
    assert found.chains == (("map", "base_link", "laser"),)
    assert [pose.topic for pose in log.poses] == ["/tf", "/tf_static"]
    assert log.problems == ()


def test_inspection_tells_why_a_replay_would_stop(tmp_path):
    found = inspect([wall_log(tmp_path / "a.mcap", world="world")], load(None))
    assert found.selection is None
    assert "not connected to 'map' or 'odom'" in found.trouble.message
    assert found.logs[0].scans[0].with_pose == 0
    assert found.logs[0].scans[0].beams.hit == 60 * 121


def test_inspection_tells_of_scans_before_the_first_pose(tmp_path):
    messages = []
    for i in range(100):
        now = START_NS + i * 100_000_000
        if i >= 10:
            edge = (now, "map", "laser", (0, 0, 0, *STILL))
            messages.append(Message("/tf", now, transforms(ROS2, edge)))
        messages.append(Message("/scan", now + 1, scan(ROS2, now, [1, 2, 3, 4, 5])))
    found = inspect([write_mcap(tmp_path / "a.mcap", messages)], load(None))
    assert found.logs[0].scans[0].with_pose == 90
    assert found.logs[0].problems == (
        "/scan: 10 of 100 scans have no pose (10 before the first pose, 0 after the last, 0 between)",
    )


def test_inspection_finds_the_same_poses_however_long_it_waits(tmp_path, monkeypatch):
    log = wall_log(tmp_path / "a.mcap", n_scans=300)
    patient = inspect([log], load(None))
    monkeypatch.setattr("timemap_cli.logs.inspect.PATIENCE_NS", 2_000_000_000)
    assert inspect([log], load(None)).logs[0].scans == patient.logs[0].scans
    assert patient.logs[0].scans[0].with_pose == 300
