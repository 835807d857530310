"""What is chosen where there is one choice, and what the user is told where there is none."""

import pytest

from timemap_cli.config import InputSettings
from timemap_cli.errors import UsageError
from timemap_cli.logs.frames import Frames
from timemap_cli.logs.selection import (
    POSE_TYPES,
    SCAN_TYPE,
    PoseTopic,
    Seen,
    Selection,
    scan_candidates,
    select,
)

COVARIANCE, STAMPED, ODOMETRY = POSE_TYPES
MOUNT = ("base_link", "laser")
NAVIGATION = [("map", "odom"), ("odom", "base_link"), MOUNT]


def seen(edges=(), poses=(), scans=None, logs=("log.mcap",)):
    scans = scans or {"/scan": ("laser",)}
    topics = dict.fromkeys(scans, SCAN_TYPE) | {pose.topic: pose.msgtype for pose in poses}
    return Seen(logs, topics, scans, Frames(edges), tuple(poses))


def pose(topic, frame="map", msgtype=COVARIANCE, child=None, count=100):
    return PoseTopic(topic, msgtype, frame, child, count)


def chosen(found, works=lambda topic, choice: True, **wanted):
    wanted = InputSettings(**wanted)
    return select(found, scan_candidates(found.logs, found.topics, wanted.scan_topics), wanted, works)


def refused(*args, **kwargs):
    with pytest.raises(UsageError) as caught:
        chosen(*args, **kwargs)
    return caught.value.message, (caught.value.hint or "").splitlines()


def test_transforms_from_map_to_laser_are_used():
    assert chosen(seen(NAVIGATION)) == Selection(("/scan",), "map", "tf")


def test_scans_in_a_frame_that_nothing_leads_to_do_not_stop_the_others():
    found = seen(NAVIGATION, scans={"/scan": ("nowhere", "laser")})
    assert chosen(found) == Selection(("/scan",), "map", "tf")
    odometry = pose("/odom", frame="map", msgtype=ODOMETRY, child="base_link")
    assert chosen(seen([MOUNT], [odometry], scans={"/scan": ("nowhere", "laser")})).pose == "/odom"


def test_every_topic_that_is_named_needs_a_frame_that_is_connected():
    found = seen(NAVIGATION, scans={"/scan": ("laser",), "/rear": ("nowhere",)})
    message, _ = refused(found, scan_topics=["/scan", "/rear"])
    assert message.startswith("no pose for /rear: frame 'nowhere' is not connected to 'map'")


def test_transforms_win_over_a_pose_topic():
    assert chosen(seen(NAVIGATION, [pose("/amcl_pose")])).pose == "tf"


def test_a_pose_topic_in_the_map_frame_is_used_where_transforms_do_not_reach_it():
    found = seen([("odom", "base_link"), MOUNT], [pose("/amcl_pose")])
    assert chosen(found) == Selection(("/scan",), "map", "/amcl_pose", covariances="/amcl_pose")


def test_a_pose_topic_is_used_where_transforms_reach_but_not_at_the_scans_times():
    found = seen(NAVIGATION, [pose("/amcl_pose")])
    assert chosen(found, works=lambda topic, choice: choice.pose != "tf").pose == "/amcl_pose"


@pytest.mark.parametrize(
    "topic", ["/amcl_pose", "/robot1/mcl_pose", "/pose", "/slam_toolbox/pose", "/localization_pose"]
)
def test_a_localiser_tells_how_uncertain_its_transforms_are(topic):
    found = chosen(seen(NAVIGATION, [pose(topic)]))
    assert (found.pose, found.covariances, found.pose_topics) == ("tf", topic, (topic,))


@pytest.mark.parametrize(
    "other",
    [
        pose("/amcl_pose", frame="odom"),
        pose("/amcl_pose", msgtype=STAMPED),
        pose("/uwb"),
        pose("/initialpose"),
        pose("/locali", frame="odom", msgtype=ODOMETRY, child="base_link"),
    ],
)
def test_other_poses_do_not_tell_how_uncertain_transforms_are(other):
    found = chosen(seen(NAVIGATION, [other]))
    assert (found.pose, found.covariances, found.pose_topics) == ("tf", None, ())


def test_the_drift_of_odometry_is_not_the_uncertainty_of_its_poses():
    for frame, covariances in (("odom", None), ("map", "/odom")):
        odometry = pose("/odom", frame=frame, msgtype=ODOMETRY, child="base_link")
        found = chosen(seen([MOUNT], [odometry]), poses="/odom")
        assert (found.pose, found.covariances, found.pose_topics) == ("/odom", covariances, ("/odom",))


def test_amcl_is_preferred_and_wishes_are_not_poses():
    topics = [pose("/goal_pose", msgtype=STAMPED), pose("/initialpose"), pose("/pose"), pose("/amcl_pose")]
    assert chosen(seen([MOUNT], topics)).pose == "/amcl_pose"
    assert chosen(seen([MOUNT], topics[:3])).pose == "/pose"
    message, _ = refused(seen([MOUNT], topics[:2]))
    assert message.startswith("no pose for /scan")


def test_odometry_is_used_with_a_warning_where_there_is_no_map():
    selection = chosen(seen(NAVIGATION[1:]))
    assert (selection.map_frame, selection.pose) == ("odom", "tf")
    (warning,) = selection.warnings
    assert "odometry drifts" in warning


def test_an_odometry_topic_is_used_where_there_are_no_transforms_to_odom():
    found = seen([MOUNT], [pose("/odom", "odom", ODOMETRY, "base_link")])
    assert (chosen(found).map_frame, chosen(found).pose) == ("odom", "/odom")


def test_odometry_is_not_used_where_the_user_named_another_map():
    message, tries = refused(seen(NAVIGATION[1:]), map_frame="world")
    assert message == (
        "no pose for /scan: frame 'laser' is not connected to 'world' (only to 'base_link', 'odom')"
    )
    assert tries == ["timemap replay log.mcap --map-frame odom"]


def test_another_map_frame_is_offered():
    message, tries = refused(seen([("world", "base_link"), MOUNT]))
    assert message == (
        "no pose for /scan: frame 'laser' is not connected to 'map' or 'odom' (only to 'base_link', 'world')"
    )
    assert tries == ["timemap replay log.mcap --map-frame world"]
    assert chosen(seen([("world", "base_link"), MOUNT]), map_frame="world").map_frame == "world"


def test_a_pose_topic_in_another_frame_is_offered_and_its_frame_is_the_map():
    found = seen([MOUNT], [pose("/vicon", "world", STAMPED)])
    _, tries = refused(found)
    assert tries == ["timemap replay log.mcap --poses /vicon"]
    selection = chosen(found, poses="/vicon")
    assert (selection.map_frame, selection.pose) == ("world", "/vicon")
    assert selection.warnings == ("the poses are in 'world', not in 'map': used as the map frame",)


def test_a_named_pose_topic_is_taken_to_the_map_where_transforms_connect():
    found = seen(NAVIGATION, [pose("/odom", "odom", ODOMETRY, "base_link")])
    assert chosen(found, poses="/odom") == Selection(("/scan",), "map", "/odom")


def test_a_laser_that_hangs_nowhere_takes_the_pose_as_its_own_with_a_warning():
    selection = chosen(seen([], [pose("/pose")]))
    assert selection.pose == "/pose"
    assert selection.warnings == (
        "no transform says where 'laser' sits on the robot: /pose is taken as its own pose",
    )


def test_a_laser_that_hangs_nowhere_is_named():
    message, tries = refused(seen(NAVIGATION[:2]))
    assert message == (
        "no pose for /scan: frame 'laser' is not connected to 'map' or 'odom' "
        "(no transform names it; there are 'base_link', 'map', 'odom')"
    )
    assert tries == ["record /tf_static too; it must say where 'laser' sits on the robot"]


def test_a_frame_that_is_called_much_like_the_missing_one_is_named():
    message, _ = refused(seen([("map", "odom"), ("odom", "base_link"), ("base_link", "base_laser")]))
    assert message.endswith("(no transform names it, but there is 'base_laser')")


def test_without_transforms_and_poses_the_error_says_what_to_record():
    message, tries = refused(seen())
    assert message == "no pose for /scan: there are neither transforms nor poses in log.mcap"
    assert tries == ["record /tf and /tf_static with the scans, or a pose topic such as /amcl_pose"]


def test_frames_that_are_connected_at_other_times_only_are_an_error_of_their_own():
    message, _ = refused(seen(NAVIGATION), works=lambda topic, choice: False)
    assert "'map' and 'laser' are connected, but at no time at which there are scans" in message


def test_poses_tf_does_not_fall_back_to_a_topic():
    message, tries = refused(seen([MOUNT], [pose("/amcl_pose")]), poses="tf")
    assert "not connected" in message
    assert tries == ["timemap replay log.mcap --poses /amcl_pose"]


@pytest.mark.parametrize("name", ["/nothing", "/scan"])
def test_a_pose_topic_that_is_none_is_an_error_that_lists_those_there_are(name):
    message, tries = refused(seen(NAVIGATION, [pose("/amcl_pose")]), poses=name)
    assert name in message
    assert tries == ["--poses /amcl_pose"]


TWO = {"/scan_front": ("front",), "/scan_rear": ("rear",)}


def test_several_scan_topics_and_none_named_list_lines_to_paste():
    edges = [("map", "base_link"), ("base_link", "front"), ("base_link", "rear")]
    message, tries = refused(seen(edges, scans=TWO))
    assert message == "2 scan topics and none named: /scan_front, /scan_rear"
    assert tries == [
        "timemap replay log.mcap --scan-topic /scan_front",
        "timemap replay log.mcap --scan-topic /scan_rear",
    ]
    both = chosen(seen(edges, scans=TWO), scan_topics=("/scan_rear", "/scan_front"))
    assert both.scan_topics == ("/scan_rear", "/scan_front")


def test_of_several_scan_topics_the_only_one_with_poses_is_used_with_a_warning():
    found = seen([("map", "base_link"), ("base_link", "rear")], scans=TWO)
    assert chosen(found) == Selection(
        ("/scan_rear",),
        "map",
        "tf",
        ("using /scan_rear, the only scan topic with poses (not /scan_front)",),
    )


def test_several_scan_topics_without_poses_are_an_error():
    assert refused(seen(scans=TWO))[0] == "2 scan topics and none named: /scan_front, /scan_rear"


def test_a_scan_topic_that_is_not_there_names_the_nearest():
    message, tries = refused(seen(NAVIGATION, scans=TWO), scan_topics=("/scan_fron",))
    assert message == "no topic /scan_fron in log.mcap"
    assert tries == ["--scan-topic /scan_front"]


def test_a_scan_topic_of_another_type_is_refused():
    message, _ = refused(seen(NAVIGATION, [pose("/pose")]), scan_topics=("/pose",))
    assert message == f"/pose holds {COVARIANCE}, not {SCAN_TYPE}"


def test_no_scans_at_all_is_an_error_that_says_what_there_is():
    with pytest.raises(UsageError, match=r"no laser scans in a\.bag: no topic of type .* among /odom, /tf"):
        scan_candidates(["a.bag"], {"/tf": "tf2_msgs/msg/TFMessage", "/odom": ODOMETRY}, ())
    with pytest.raises(UsageError, match=r"no laser scans in 4 recordings: there are no messages"):
        scan_candidates(["a", "b", "c", "d"], {}, ())


def test_point_clouds_are_said_to_need_turning_into_scans():
    with pytest.raises(UsageError) as caught:
        scan_candidates(["a.bag"], {"/velodyne": "sensor_msgs/msg/PointCloud2"}, ())
    assert caught.value.hint == "turn /velodyne into laser scans first (pointcloud_to_laserscan)"


def test_many_logs_are_not_listed_in_lines_to_paste():
    found = seen([("world", "base_link"), MOUNT], logs=("1.bag", "2.bag", "3.bag", "4.bag"))
    assert refused(found)[1] == ["timemap replay 1.bag ... --map-frame world"]
