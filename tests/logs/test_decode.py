"""Blocks of messages decode to what rosbags' own deserialiser gives for each of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.logs import recorded
from tests.logs.recorded import ROS1, ROS2, START_NS, expected_rows, rows, serialised
from timemap_cli.logs import decode as decode_module
from timemap_cli.logs.batches import BadBatch, ScanBatch
from timemap_cli.logs.decode import decode
from timemap_cli.logs.message_types import DecoderCache
from timemap_cli.logs.raw import Connection, from_messages

DECODERS = DecoderCache()
ENCODINGS = {"cdr": ROS2, "ros1": ROS1}


def connection(store, msgtype: str, topic: str = "/topic", definition: str | None = None) -> Connection:
    encoding = "ros1" if store is ROS1 else "cdr"
    if definition is None:
        definition, _ = store.generate_msgdef(msgtype, ros_version=1 if store is ROS1 else 2)
    return Connection(1, topic, msgtype, encoding, definition, "msg", 0)


def decode_raws(one: Connection, raws, log_ns=None):
    times = range(len(raws)) if log_ns is None else log_ns
    return decode([from_messages(one, list(times), raws)], DECODERS)


def decode_contents(store, contents, topic="/topic", **options):
    raws = [serialised(store, content, **options) for content in contents]
    return decode_raws(connection(store, contents[0].__msgtype__, topic), raws)


def expected(contents, topic="/topic"):
    return expected_rows([(topic, index, content) for index, content in enumerate(contents)])


frames = st.sampled_from(["map", "/map", "odom", "a", "", "über", "base_link", "robot_1/laser_frame"])
numbers = st.floats(allow_nan=True, allow_infinity=True, width=64)
stamps = st.integers(0, 2**31 * 10**9 - 1)
floats32 = st.floats(width=32, allow_nan=True, allow_infinity=True)


@st.composite
def scans(draw, store):
    count = draw(st.sampled_from([1, 2, 3, 8]))
    strengths = draw(st.sampled_from([0, 0, count]))
    return recorded.scan(
        store,
        draw(stamps),
        draw(st.lists(floats32, min_size=count, max_size=count)),
        draw(frames),
        angle_min=draw(st.sampled_from([-1.5, 0.0])),
        time_increment=draw(floats32),
        range_max=draw(floats32),
        intensities=np.arange(strengths, dtype=np.float32),
    )


@st.composite
def transforms(draw, store):
    edge = st.tuples(stamps, frames, frames, st.lists(numbers, min_size=7, max_size=7))
    return recorded.transforms(store, *draw(st.lists(edge, max_size=3)))


@st.composite
def poses(draw, store):
    seven, covariance = draw(st.lists(numbers, min_size=7, max_size=7)), np.arange(36) * 0.5
    return recorded.pose_with_covariance(store, draw(stamps), seven, covariance, draw(frames))


@st.composite
def bare_poses(draw, store):
    return recorded.pose_stamped(
        store, draw(stamps), draw(st.lists(numbers, min_size=7, max_size=7)), draw(frames)
    )


@st.composite
def odometries(draw, store):
    seven = draw(st.lists(numbers, min_size=7, max_size=7))
    return recorded.odometry(store, draw(stamps), seven, np.arange(36), draw(frames), draw(frames))


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("kind", [scans, transforms, poses, bare_poses, odometries])
@settings(max_examples=40)
@given(data=st.data())
def test_blocks_decode_to_what_was_serialised(encoding, kind, data):
    store = ENCODINGS[encoding]
    contents = data.draw(st.lists(kind(store), min_size=1, max_size=8))
    found = decode_contents(store, contents)
    assert rows(found) == expected(contents)
    assert all((np.diff(batch.log_ns) >= 0).all() for batch in found)


def no_single_decoding(*_):
    raise AssertionError("a message was decoded on its own")


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_usual_messages_are_decoded_in_blocks(encoding, monkeypatch):
    monkeypatch.setattr(decode_module, "decode_singly", no_single_decoding)
    store = ENCODINGS[encoding]
    by_topic = {}
    for one in recorded.drive(store):
        by_topic.setdefault(one.topic, []).append(one.content)
    for topic, contents in by_topic.items():
        assert rows(decode_contents(store, contents, topic)) == expected(contents, topic)


def test_big_endian_messages_decode_like_little_endian_ones():
    for name in recorded.TOPICS:
        contents = [one.content for one in recorded.drive(ROS2) if one.topic == name]
        assert rows(decode_contents(ROS2, contents, little_endian=False)) == expected(contents)


def test_bytes_of_a_scan_by_hand():
    """CDR: alignment counts from behind the encapsulation header, strings end with NUL."""
    raw = bytes.fromhex(
        "00010000"  # plain CDR, little endian
        "05000000 07000000"  # stamp: 5 s, 7 ns
        "03000000 616200 00"  # "ab" with its NUL, one byte of padding
        "0000803f 00000040 0000003f 0000803e 00000000 cdcccc3d 00002041"  # 1, 2, 0.5, 0.25, 0, 0.1, 10
        "02000000 0000803f 0000807f"  # two ranges: 1, inf
        "00000000"  # no intensities
    )
    (batch,) = decode_raws(connection(ROS2, "sensor_msgs/msg/LaserScan"), [raw], [11])
    assert isinstance(batch, ScanBatch)
    assert (batch.topic, batch.frame_id, batch.log_ns.tolist()) == ("/topic", "ab", [11])
    assert batch.stamps_ns.tolist() == [5_000_000_007]
    assert (batch.layout.angle_min, batch.layout.angle_increment, batch.layout.count) == (1.0, 0.5, 2)
    assert batch.layout.range_min == np.float32(0.1)
    assert batch.range_max.tolist() == [10.0]
    assert batch.time_increment.tolist() == [0.25]
    assert batch.ranges.tolist() == [[1.0, np.inf]]


def test_bytes_of_a_transform_by_hand():
    """ROS 1: nothing is aligned, strings have no NUL, headers begin with a sequence number."""
    raw = bytes.fromhex("01000000 63000000 05000000 07000000 02000000 2f6d 01000000 62")
    raw += np.array([1, 2, 3, 0, 0, 0, 1], "<f8").tobytes()
    (batch,) = decode_raws(connection(ROS1, "tf/msg/tfMessage", "/tf"), [raw], [11])
    assert (batch.parent, batch.child, batch.static) == ("m", "b", False)
    assert batch.stamps_ns.tolist() == [5_000_000_007]
    assert batch.translation.tolist() == [[1, 2, 3]]
    assert batch.rotation.tolist() == [[0, 0, 0, 1]]


@pytest.mark.parametrize(
    ("topic", "static"),
    [("/tf", False), ("/tf_static", True), ("tf_static", True), ("/robot/tf_static", True)],
)
def test_topic_tells_which_transforms_are_static(topic, static):
    content = recorded.transforms(ROS2, (0, "a", "b", (0, 0, 0, 0, 0, 0, 1)))
    (batch,) = decode_contents(ROS2, [content], topic)
    assert batch.static is static


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("cut", [0, 1, 3, 9, 30, 60, -4, -1])
def test_messages_cut_short_are_counted_and_the_others_read(encoding, cut):
    store = ENCODINGS[encoding]
    contents = [recorded.scan(store, index, [1, 2, index]) for index in range(4)]
    raws = [serialised(store, content) for content in contents]
    raws[1] = raws[1][:cut]
    found = decode_raws(connection(store, "sensor_msgs/msg/LaserScan"), raws)
    assert BadBatch("/topic", "undecodable", 1) in found
    messages = [("/topic", index, contents[index]) for index in (0, 2, 3)]
    assert rows([one for one in found if not isinstance(one, BadBatch)]) == expected_rows(messages)


@pytest.mark.parametrize("surplus", [1, 3, 4, 7, 8, 100])
def test_bytes_behind_a_cdr_message_do_not_matter(surplus):
    contents = [recorded.scan(ROS2, index, [1, 2, index]) for index in range(4)]
    raws = [serialised(ROS2, content) + b"\x7f" * surplus for content in contents]
    found = decode_raws(connection(ROS2, "sensor_msgs/msg/LaserScan"), raws)
    assert rows(found) == expected(contents)


@given(st.binary(max_size=200))
def test_any_bytes_are_decoded_or_counted(raw):
    for store in (ROS1, ROS2):
        for name in ("sensor_msgs/msg/LaserScan", "tf2_msgs/msg/TFMessage", "nav_msgs/msg/Odometry"):
            decode_raws(connection(store, name), [raw, raw])


def test_many_different_lengths_and_strings():
    contents = [
        recorded.scan(ROS2, index, range(1, 2 + index % 7), f"laser{index % 150:03d}") for index in range(300)
    ]
    assert rows(decode_contents(ROS2, contents)) == expected(contents)


def test_time_from_beam_to_beam_does_not_divide_scans():
    contents = [recorded.scan(ROS2, index, [1, 2], time_increment=index * 1e-3) for index in range(5)]
    (batch,) = decode_contents(ROS2, contents)
    assert batch.time_increment.tolist() == np.array([0, 1e-3, 2e-3, 3e-3, 4e-3], np.float32).tolist()


def test_beams_that_lie_differently_divide_scans():
    contents = [recorded.scan(ROS2, index, [1, 2], angle_min=[-1.0, -2.0][index % 2]) for index in range(5)]
    found = decode_contents(ROS2, contents)
    assert [batch.layout.angle_min for batch in found] == [-1.0, -2.0]
    assert [batch.stamps_ns.tolist() for batch in found] == [[0, 2, 4], [1, 3]]


@pytest.mark.parametrize("little_endian", [True, False])
@pytest.mark.parametrize(
    ("ranges", "values"), [([], {}), ([1.0], {"angle_min": np.nan}), ([1.0], {"angle_increment": np.inf})]
)
def test_scans_without_usable_beams_are_malformed(ranges, values, little_endian):
    content = recorded.scan(ROS2, 1, ranges, **values)
    found = decode_contents(ROS2, [content, content], little_endian=little_endian)
    assert found == [BadBatch("/topic", "malformed", 2)]


@pytest.mark.parametrize("little_endian", [True, False])
@pytest.mark.parametrize(
    ("beams", "angle_max", "fits"),
    [
        (5, 1.0, True),  # -1 to 1 by steps of 0.5
        (4, 1.0, True),  # a driver that leaves out the beam at the end
        (7, 1.0, True),
        (8, 1.0, False),
        (2, 1.0, False),
        (100, 1.0, False),
        (100, 0.0, False),
        (100, -1.0, True),  # never set
        (100, -2.0, True),  # on the other side
        (100, np.nan, True),
        (100, np.inf, True),
    ],
)
def test_as_many_beams_as_the_angles_ask_for(beams, angle_max, fits, little_endian):
    content = recorded.scan(
        ROS2, 1, [1.0] * beams, angle_increment=0.1 if beams == 100 else 0.5, angle_max=angle_max
    )
    found = decode_contents(ROS2, [content, content], little_endian=little_endian)
    assert (found == [BadBatch("/topic", "mismatched", 2)]) != fits
    assert sum(len(one.log_ns) for one in found if not isinstance(one, BadBatch)) == 2 * fits


@pytest.mark.parametrize("little_endian", [True, False])
def test_a_second_of_nanoseconds_is_no_stamp(little_endian):
    contents = [recorded.scan(ROS2, 5, [1, 2]) for _ in range(2)]
    contents[1].header.stamp.nanosec = 1_000_000_000
    found = decode_contents(ROS2, contents, little_endian=little_endian)
    stamps = sorted(int(stamp) for batch in found for stamp in batch.stamps_ns)
    assert stamps[1] == 5
    assert stamps[0] < 0


def test_definition_of_the_recording_is_followed():
    """A LaserScan with one more field in front of its ranges."""
    text, _ = ROS2.generate_msgdef("sensor_msgs/msg/LaserScan", ros_version=2)
    text = text.replace("float32[] ranges", "float64 temperature\nfloat32[] ranges")
    content = recorded.scan(ROS2, 5, [1, 2, 3])
    plain = serialised(ROS2, content)
    head = plain[: plain.index(np.float32(30).tobytes()) + 4]
    padding = b"\0" * (-(len(head) - 4) % 8)
    raw = head + padding + np.float64(21.5).tobytes() + plain[len(head) :]
    found = decode_raws(connection(ROS2, "sensor_msgs/msg/LaserScan", definition=text), [raw])
    assert rows(found) == expected([content])


def test_header_of_the_oldest_bags():
    text, _ = ROS1.generate_msgdef("sensor_msgs/msg/LaserScan", ros_version=1)
    text = text.replace("std_msgs/Header", "roslib/Header").replace("roslib/Header header", "Header header")
    assert "MSG: roslib/Header" in text
    content = recorded.scan(ROS1, 5, [1, 2, 3])
    raws = [serialised(ROS1, content)]
    assert rows(decode_raws(connection(ROS1, content.__msgtype__, definition=text), raws)) == expected(
        [content]
    )


@pytest.mark.parametrize("definition", ["", "this is no definition {"])
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_without_a_readable_definition_that_of_the_distribution_is_taken(encoding, definition):
    store = ENCODINGS[encoding]
    for content in (recorded.scan(store, 5, [1, 2, 3]), recorded.drive(store)[0].content):
        one = connection(store, content.__msgtype__, definition=definition)
        assert rows(decode_raws(one, [serialised(store, content)])) == expected([content])


def test_definition_in_idl():
    text = """
    module builtin_interfaces { module msg { struct Time { int32 sec; uint32 nanosec; }; }; };
    module std_msgs { module msg { struct Header { builtin_interfaces::msg::Time stamp; string frame_id; }; }; };
    module geometry_msgs { module msg {
      struct Point { double x; double y; double z; };
      struct Quaternion { double x; double y; double z; double w; };
      struct Pose { geometry_msgs::msg::Point position; geometry_msgs::msg::Quaternion orientation; };
      struct PoseStamped { std_msgs::msg::Header header; geometry_msgs::msg::Pose pose; };
    }; };
    """
    content = recorded.pose_stamped(ROS2, START_NS, (1, 2, 3, 0, 0, 0, 1))
    one = replace(connection(ROS2, content.__msgtype__, definition=text), definition_format="idl")
    assert DecoderCache().standard_fields(one) is not None
    assert rows(decode_raws(one, [serialised(ROS2, content)])) == expected([content])


def test_unknown_encoding_is_refused():
    one = replace(connection(ROS2, "sensor_msgs/msg/LaserScan"), encoding="json")
    with pytest.raises(ValueError, match="messages in 'json' encoding cannot be read"):
        decode_raws(one, [b"{}"])
