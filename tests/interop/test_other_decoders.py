"""Other people's programs read a result: two unrelated decoders, and a conversion to ROS 1 and back."""

import subprocess
import sys
from array import array
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.results.events import write_changing_room
from tests.results.rooms import write_room
from timemap_cli.results.writer import VIEWERS_SPAN_NS

DAY_NS = 24 * 3600 * 10**9


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    path = tmp_path_factory.mktemp("room") / "room.timemap.mcap"
    write_room(path)
    return path


@pytest.fixture(scope="module")
def changing(tmp_path_factory):
    path = tmp_path_factory.mktemp("room") / "changing.timemap.mcap"
    write_changing_room(path)
    return path


@pytest.fixture(scope="module")
def decoded(result):
    return by_mcap_ros2_support(result)


def by_mcap_ros2_support(path):
    """(topic, type, log time, message) of every message."""
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        return [(c.topic, s.name, m.log_time, o) for s, c, m, o in reader.iter_decoded_messages()]


def of_type(decoded, name):
    return [message for _, kind, _, message in decoded if kind == name]


def plain(value):
    """Any client's message as nested lists, dicts and numbers; NaN as None."""
    if isinstance(value, np.ndarray | array):
        return [plain(x) for x in value.tolist()]
    if isinstance(value, bytes | memoryview):
        return list(value)
    if isinstance(value, list | tuple):
        return [plain(x) for x in value]
    if isinstance(value, float):
        return None if value != value else value
    if isinstance(value, str | int):
        return value
    names = getattr(value, "__slots__", None) or vars(value)
    return {
        n.lstrip("_"): plain(getattr(value, n)) for n in names if not n.startswith("__") and not n.isupper()
    }


def by_rosbags(path):
    with AnyReader([path]) as reader:
        return [
            (c.topic, c.msgtype, stamp, plain(reader.deserialize(raw, c.msgtype)))
            for c, stamp, raw in reader.messages()
        ]


def sorted_plain(messages):
    return sorted(messages, key=lambda m: (m[0], m[2], str(m[3])))


def test_two_unrelated_decoders_read_the_same(result, decoded):
    one = [(topic, kind, stamp, plain(message)) for topic, kind, stamp, message in decoded]
    assert len(one) > 40
    assert sorted_plain(one) == sorted_plain(by_rosbags(result))


def test_two_unrelated_decoders_read_the_same_changes(changing):
    one = [(topic, kind, at, plain(message)) for topic, kind, at, message in by_mcap_ros2_support(changing)]
    assert {"timemap_msgs/msg/Change", "visualization_msgs/msg/MarkerArray"} < {kind for _, kind, *_ in one}
    assert sorted_plain(one) == sorted_plain(by_rosbags(changing))


def test_definitions_in_the_file_are_those_of_ros_2_humble(result):
    humble = get_typestore(Stores.ROS2_HUMBLE)
    with AnyReader([result]) as reader:
        for connection in reader.connections:
            store = get_typestore(Stores.EMPTY)
            store.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
            if connection.msgtype in humble.types:
                assert store.hash_rihs01(connection.msgtype) == humble.hash_rihs01(connection.msgtype)


def test_latched_topics_are_transient_local(result):
    with AnyReader([result]) as reader:
        for connection in reader.connections:
            (qos,) = connection.ext.offered_qos_profiles
            latched = connection.topic == "/tf_static" or connection.topic.endswith(("/points", "/map"))
            assert qos.durability == (QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE)


@pytest.mark.parametrize("which", ["result", "changing"])
def test_result_survives_conversion_to_ros_1_and_back(which, tmp_path, request):
    result = request.getfixturevalue(which)
    program = Path(sys.executable).parent / "rosbags-convert"
    to_ros1 = ["--src", result, "--dst", tmp_path / "one.bag", "--dst-typestore", "ros1_noetic"]
    back = ["--src", tmp_path / "one.bag", "--dst", tmp_path / "two", "--dst-storage", "mcap"]
    for arguments in (to_ros1, [*back, "--dst-typestore", "ros2_humble"]):
        subprocess.run([program, *map(str, arguments)], check=True, capture_output=True)
    assert sorted_plain(by_rosbags(tmp_path / "two")) == sorted_plain(by_rosbags(result))


def test_scan_angles_agree_to_the_last_bit(decoded):
    for scan in of_type(decoded, "sensor_msgs/msg/LaserScan"):
        low, high, step = (np.float32(a) for a in (scan.angle_min, scan.angle_max, scan.angle_increment))
        assert low + np.float32(len(scan.ranges) - 1) * step == high
        assert (scan.angle_min, scan.angle_max, scan.angle_increment) == (low, high, step)


def test_scan_ranges_are_what_viewers_show(decoded):
    scans = of_type(decoded, "sensor_msgs/msg/LaserScan")
    assert scans
    for scan in scans:
        ranges = np.array(scan.ranges)
        finite = ranges[np.isfinite(ranges)]
        assert len(finite) > 100
        assert ((finite >= scan.range_min) & (finite <= scan.range_max)).all()
        assert len(scan.intensities) == len(ranges) == 360
        assert not np.isneginf(ranges).any()


def test_every_frame_reaches_the_map_before_it_is_used(decoded):
    parents = {}
    for _, kind, _, message in decoded:
        if kind == "tf2_msgs/msg/TFMessage":
            here = {t.child_frame_id: t.header.frame_id for t in message.transforms}
            assert here.keys() >= parents.keys()
            parents = here
        else:
            frame = message.header.frame_id
            assert frame
            assert not frame.startswith("/")
            assert frame == "map" or parents[frame] == "map"


def test_header_stamps_are_the_log_times(decoded):
    for _, kind, log_ns, message in decoded:
        headers = (
            [t.header for t in message.transforms] if kind == "tf2_msgs/msg/TFMessage" else [message.header]
        )
        assert {h.stamp.sec * 10**9 + h.stamp.nanosec for h in headers} == {log_ns}


def test_log_times_span_no_more_than_viewers_take(decoded):
    times = [log_ns for _, _, log_ns, _ in decoded]
    assert max(times) - min(times) < VIEWERS_SPAN_NS <= 93.8 * DAY_NS


def test_points_and_grid_show_the_same_room(decoded):
    cloud = of_type(decoded, "sensor_msgs/msg/PointCloud2")[-1]
    grid = of_type(decoded, "nav_msgs/msg/OccupancyGrid")[-1]
    points = np.frombuffer(bytes(cloud.data), "<f4").reshape(-1, 4)
    assert len(points) == cloud.width > 500
    assert np.abs(points[:, 0]).max() < 6.01
    assert np.abs(points[:, 1]).max() < 4.01
    assert not points[:, 2].any()
    cells = np.array(grid.data).reshape(grid.info.height, grid.info.width)
    assert set(np.unique(cells)) == {-1, 0, 100}
    steps = (
        points[:, :2] - (grid.info.origin.position.x, grid.info.origin.position.y)
    ) / grid.info.resolution
    inside = (
        np.abs(steps - np.round(steps)).min(axis=1) > 1e-3
    )  # float32 may round a point into the next cell
    column, row = np.floor(steps[inside]).astype(int).T
    assert (cells[row, column] == 100).all()
