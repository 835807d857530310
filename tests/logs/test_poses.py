import numpy as np

from tests.logs.making import Topic, ns, poses, tf, yaw
from timemap_cli.logs.poses import PoseSource, transform_topics

TFM = "tf2_msgs/msg/TFMessage"


def source(*batches, topic="tf", frame="map"):
    made = PoseSource(frame, topic)
    for batch in batches:
        made.add(batch)
    return made


def places(made, seconds, laser="laser"):
    found, known = made.lookup(laser, ns(seconds))
    return [
        tuple(np.round(row[:, 3], 9).tolist()) if ok else None for row, ok in zip(found, known, strict=True)
    ]


def test_poses_from_transforms():
    made = source(
        tf("map", "base", [0, 2], [[0, 0, 0], [2, 0, 0]]), tf("base", "laser", [0], [[0, 1, 0]], static=True)
    )
    assert places(made, [1, 3]) == [(1, 1, 0), None]


def test_a_leading_slash_of_the_map_frame_is_stripped():
    made = source(tf("map", "laser", [0, 2], [[0, 0, 0], [2, 0, 0]]), frame="/map")
    assert places(made, [1]) == [(1, 0, 0)]


def test_odometry_says_which_frame_its_poses_are_of():
    made = source(
        poses("/odom", "odom", [0, 2], [[0, 0, 0], [2, 0, 0]], yaw(90), child="chassis"),
        tf("chassis", "laser", [0], [[1, 0, 0]], static=True),
        topic="/odom",
        frame="odom",
    )
    assert places(made, [1, 2.5]) == [(1, 1, 0), None]


def test_poses_that_do_not_say_are_of_the_base_above_the_laser():
    made = source(
        poses("/pose", "map", [0, 2], [[0, 0, 0], [2, 0, 0]]),
        tf("odom", "base_link", [0, 2], [[50, 50, 50]]),
        tf("base_link", "mast", [0, 2], [[0, 0, 1]]),
        tf("mast", "laser", [0], [[0.5, 0, 0]], static=True),
        topic="/pose",
    )
    assert places(made, [1]) == [(1.5, 0, 1)]


def test_without_a_base_frame_poses_are_of_the_top_of_the_static_tree():
    made = source(
        poses("/pose", "map", [0, 2], [[0, 0, 0], [2, 0, 0]]),
        tf("platform", "laser", [0], [[0.5, 0, 0]], static=True),
        tf("odom", "platform", [0, 2], [[50, 50, 50]]),
        topic="/pose",
    )
    assert places(made, [1]) == [(1.5, 0, 0)]


def test_without_any_transforms_poses_are_of_the_laser():
    made = source(poses("/pose", "map", [0, 2], [[0, 0, 0], [2, 0, 0]]), topic="/pose")
    assert places(made, [1]) == [(1, 0, 0)]


def test_poses_in_another_frame_are_taken_to_the_map_frame():
    made = source(
        poses("/odom", "odom", [0, 2], [[0, 0, 0], [2, 0, 0]], child="laser"),
        tf("map", "odom", [0, 2], [[10, 0, 0]], yaw(90)),
        topic="/odom",
    )
    assert places(made, [1]) == [(10, 1, 0)]


def test_other_topics_poses_are_passed_over():
    made = source(poses("/goal", "map", [0, 2], [[9, 9, 9]]), topic="/pose")
    assert places(made, [1]) == [None]


def test_a_sweep_gets_the_poses_of_its_first_and_last_beam():
    made = source(tf("map", "laser", [0, 2], [[0, 0, 0], [2, 0, 0]]))
    first, last, known = made.sweep("laser", ns([0.5, 1.5]), ns([0.1, -0.1]))
    np.testing.assert_allclose(first[:, 0, 3], (0.5, 1.5))
    np.testing.assert_allclose(last[:, 0, 3], (0.6, 1.4))
    assert known.all()


def test_a_sweep_that_outlasts_the_poses_keeps_the_pose_it_began_with():
    made = source(tf("map", "laser", [0, 2, 20], [[0, 0, 0], [2, 0, 0], [5, 0, 0]]))
    first, last, known = made.sweep("laser", ns([2, 1.95, 20, 2.05]), ns([0.1, 0.1, 0.1, -0.1]))
    assert known.all()
    np.testing.assert_allclose(last[:3, 0, 3], (2, 1.95, 5))
    np.testing.assert_allclose(first[3, 0, 3], 1.95)


def test_a_sweep_that_begins_before_the_poses_has_none():
    made = source(tf("map", "laser", [1, 2], [[0, 0, 0], [2, 0, 0]]))
    _, _, known = made.sweep("laser", ns([0.95, 1.05, 2.05]), ns([0.1, -0.1, 0.1]))
    assert not known.any()


def test_topics_of_transforms_are_found_by_type():
    topics = [Topic("/tf", "tf/msg/tfMessage"), Topic("/tf_static", TFM), Topic("/scan", "x")]
    assert transform_topics(topics) == (("/tf",), ("/tf_static",))
    assert transform_topics([*topics, Topic("/other/tf", TFM)]) == (("/tf",), ("/tf_static",))
    spaced = [Topic("/robot/tf_static", TFM), Topic("/robot/tf", TFM)]
    assert transform_topics(spaced) == (("/robot/tf",), ("/robot/tf_static",))
