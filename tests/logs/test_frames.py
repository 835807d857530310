from timemap_cli.logs.frames import Frames

ROBOT = Frames([("map", "odom"), ("odom", "base_link"), ("base_link", "laser"), ("world", "camera")])


def test_a_chain_connects_in_both_directions():
    assert ROBOT.connects("map", "laser")
    assert ROBOT.connects("laser", "map")


def test_frames_of_two_trees_are_not_connected():
    assert not ROBOT.connects("world", "laser")


def test_a_frame_that_is_nowhere_is_not_even_connected_to_itself():
    assert not ROBOT.connects("nowhere", "nowhere")


def test_path_names_the_frames_between():
    assert ROBOT.path("map", "laser") == ("map", "odom", "base_link", "laser")
    assert ROBOT.path("laser", "odom") == ("laser", "base_link", "odom")
    assert ROBOT.path("map", "map") == ("map",)
    assert ROBOT.path("map", "camera") == ()


def test_a_loop_of_frames_does_not_hang():
    loop = Frames([("a", "b"), ("b", "c"), ("c", "a")])
    assert loop.connected_to("a") == {"a", "b", "c"}
    assert loop.roots_of("a") == []


def test_roots_are_not_parts_of_the_robot():
    assert ROBOT.roots_of("laser") == ["map"]
    assert Frames([("base_link", "laser")]).roots_of("laser") == []


def test_no_edges_are_no_frames():
    assert not Frames([])
    assert ROBOT
