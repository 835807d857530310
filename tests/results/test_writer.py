import json
import os
from dataclasses import replace

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.records import ChunkIndex
from mcap.stream_reader import StreamReader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from tests.results.events import write_changing_room
from tests.results.rooms import (
    CHANGES,
    CONFIG,
    LEVELS,
    NODES,
    REPORT,
    SECOND,
    T0,
    all_levels,
    estimate,
    new_writer,
    write_room,
)
from timemap_cli import __version__
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.results.reader import ResultReader


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    path = tmp_path_factory.mktemp("room") / "room.timemap.mcap"
    write_room(path)
    return path


def messages(path):
    with path.open("rb") as stream:
        return [
            (c.topic, m)
            for _, c, m in make_reader(stream, validate_crcs=True).iter_messages(log_time_order=False)
        ]


def summary(path):
    with path.open("rb") as stream:
        return make_reader(stream).get_summary()


def test_same_calls_give_the_same_bytes(result, tmp_path):
    write_room(tmp_path / "again.mcap")
    assert (tmp_path / "again.mcap").read_bytes() == result.read_bytes()


def test_header_names_the_profile_and_a_fixed_library(result):
    with result.open("rb") as stream:
        header = make_reader(stream).get_header()
    assert (header.profile, header.library) == ("ros2", f"timemap {__version__}")


def test_messages_stand_in_the_order_of_their_log_times(result):
    times = [m.log_time for _, m in messages(result)]
    assert times == sorted(times)
    assert all(m.publish_time == m.log_time for _, m in messages(result))


def test_log_time_of_an_estimate_is_its_stamp(result):
    for topic, message in messages(result):
        if topic.endswith(("/scan", "/status")):
            sec, nanosec = np.frombuffer(message.data, "<u4", 2, 4).tolist()
            assert sec * SECOND + nanosec == message.log_time


def test_file_is_chunked_compressed_and_indexed(result):
    found = summary(result)
    assert {c.compression for c in found.chunk_indexes} == {"zstd"}
    assert all(c.message_index_offsets for c in found.chunk_indexes)
    assert found.statistics.message_count == len(messages(result))
    names = ["timemap/config.yaml", "timemap/report.json", "timemap/changes.json"]
    assert [a.name for a in found.attachment_indexes] == names
    assert [m.name for m in found.metadata_indexes] == ["timemap"]


def test_no_group_of_the_index_is_empty(result):
    with result.open("rb") as stream:
        groups = [r for r in StreamReader(stream).records if type(r).__name__ == "SummaryOffset"]
        assert groups
        assert all(g.group_length > 0 for g in groups)


def test_channels_are_ros_2_topics_of_every_level_and_none_is_empty(result):
    found = summary(result)
    topics = {c.topic: found.schemas[c.schema_id].name for c in found.channels.values()}
    assert topics.pop("/tf_static") == "tf2_msgs/msg/TFMessage"
    types = {
        "scan": "sensor_msgs/msg/LaserScan",
        "status": "timemap_msgs/msg/Status",
        "points": "sensor_msgs/msg/PointCloud2",
        "map": "nav_msgs/msg/OccupancyGrid",
    }
    assert topics == {f"/timemap/{lv}/{name}": kind for lv in LEVELS for name, kind in types.items()}
    assert {c.message_encoding for c in found.channels.values()} == {"cdr"}
    assert {s.encoding for s in found.schemas.values()} == {"ros2msg"}
    assert found.statistics.channel_message_counts.keys() == found.channels.keys()


def test_latched_topics_say_so(result):
    for channel in summary(result).channels.values():
        qos = channel.metadata["offered_qos_profiles"]
        latched = channel.topic == "/tf_static" or channel.topic.endswith(("/points", "/map"))
        assert f"durability: {1 if latched else 2}\n" in qos  # 1: transient local, 2: volatile
        assert "reliability: 1\n" in qos


def test_attachments_hold_settings_and_report_at_the_time_of_the_last_message(result):
    with result.open("rb") as stream:
        config, report, changes = make_reader(stream).iter_attachments()
    assert config.data.decode() == CONFIG
    assert [json.loads(one.data) for one in (report, changes)] == [REPORT, CHANGES]
    times = {time for one in (config, report, changes) for time in (one.create_time, one.log_time)}
    assert times == {T0 + 40 * SECOND}


def test_frames_are_written_before_the_first_estimate_of_a_new_node(result):
    placed = set()
    for topic, message in messages(result):
        if topic == "/tf_static":
            here = {
                f"timemap/node_{n:04d}" for n in range(3) if f"timemap/node_{n:04d}".encode() in message.data
            }
            assert here >= placed, "a later message must hold all that came before"
            placed = here
        elif topic.endswith(("/scan", "/status")):
            assert any(frame.encode() in message.data for frame in placed)
    assert len(placed) == 3


def test_frames_are_repeated_only_when_nodes_were_added(result):
    assert [t for t, _ in messages(result)].count("/tf_static") == 3


def test_estimates_older_than_the_last_message_keep_their_stamp_and_the_order(tmp_path):
    path = tmp_path / "late.mcap"
    with new_writer(path) as writer:
        writer.write_nodes(NODES, T0)
        writer.write_estimates([estimate(0, "mid", T0 + 10)], T0 + 10)
        writer.write_estimates([estimate(1, "mid", T0 + 4)], T0 + 10)
        writer.finish({}, "", {}, {})
    assert [m.log_time - T0 for t, m in messages(path) if t.endswith("scan")] == [10, 10]
    with ResultReader(path) as reader:
        assert [e.stamp_ns - T0 for e in reader.estimates("mid").values()] == [10, 4]


def test_maps_of_a_level_that_knows_nothing_are_empty(tmp_path):
    path = tmp_path / "empty.mcap"
    with new_writer(path) as writer:
        writer.write_nodes(NODES, T0)
        writer.write_maps({"long": {}}, NODES, T0)
        writer.finish({}, "", {}, {})
    assert [t for t, _ in messages(path)] == ["/tf_static", "/timemap/long/points", "/timemap/long/map"]


def test_radius_that_float32_cannot_hold_still_contains_its_ranges(tmp_path):
    radius = 4.7  # the nearest float32 lies below it
    one = estimate(0, "mid", T0)
    one.ranges[:] = np.nextafter(np.float32(radius), np.float32(9))
    path = tmp_path / "radius.mcap"
    with new_writer(path, radius=radius) as writer:
        writer.write_nodes(NODES, T0)
        writer.write_estimates([one], T0)
        writer.finish({}, "", {}, {})
    with ResultReader(path) as reader:
        assert reader.radius == radius


def test_estimate_of_the_future_or_of_an_unknown_node_is_refused(tmp_path):
    with new_writer(tmp_path / "a.mcap") as writer:
        writer.write_nodes(NODES[:1], T0)
        with pytest.raises(ValueError, match="newer than the newest scan"):
            writer.write_estimates([estimate(0, "mid", T0 + 1)], T0)
        with pytest.raises(ValueError, match="node that was not written"):
            writer.write_estimates([estimate(1, "mid", T0)], T0)
        with pytest.raises(ValueError, match="day"):
            writer.write_estimates([replace(estimate(0, "mid", T0), level="day")], T0)


def test_span_is_between_the_first_and_the_last_message(tmp_path):
    with new_writer(tmp_path / "a.mcap") as writer:
        assert writer.span_ns == 0
        writer.write_nodes(NODES, T0)
        writer.write_estimates(all_levels(0, T0, 0), T0)
        writer.write_estimates(all_levels(0, T0 + 7 * SECOND, 0), T0 + 7 * SECOND)
        assert writer.span_ns == 7 * SECOND


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_nothing_is_left_after_an_exception(tmp_path, error):
    def fail_midway():
        with new_writer(tmp_path / "a.mcap") as writer:
            writer.write_nodes(NODES, T0)
            writer.write_estimates(all_levels(0, T0, 0), T0)
            raise error

    with pytest.raises(error):
        fail_midway()
    assert list(tmp_path.iterdir()) == []


def test_leaving_without_finish_leaves_nothing(tmp_path):
    with new_writer(tmp_path / "a.mcap") as writer:
        writer.write_nodes(NODES, T0)
    assert list(tmp_path.iterdir()) == []


def test_a_result_without_any_message_is_an_error(tmp_path):
    with pytest.raises(TimemapError, match="nothing to write"), new_writer(tmp_path / "a.mcap") as writer:
        writer.finish({}, "", {}, {})
    assert list(tmp_path.iterdir()) == []


def test_existing_result_is_refused_without_force(result):
    before = result.read_bytes()
    with pytest.raises(UsageError, match="exists already"):
        new_writer(result)
    assert result.read_bytes() == before


def test_a_result_is_replaced_with_force_and_nothing_else_is(result, tmp_path):
    new_writer(result, force=True).__exit__(None, None, None)
    recording, notes, pipe, cut = (tmp_path / name for name in ("a.bag", "notes.txt", "pipe", "cut.mcap"))
    recording.write_bytes(b"#ROSBAG V2.0\n")
    notes.write_text("mine")
    os.mkfifo(pipe)
    cut.write_bytes(result.read_bytes()[:-100])
    other = tmp_path / "other.mcap"
    with other.open("wb") as out:
        writer = Writer(out)
        writer.start()
        writer.finish()
    for path in (recording, notes, pipe, cut, other):
        before = None if path == pipe else path.read_bytes()
        with pytest.raises(UsageError, match="is not a result of timemap: it is not replaced"):
            new_writer(path, force=True)
        assert path.is_fifo() if path == pipe else path.read_bytes() == before


def test_markers_show_all_that_holds_at_their_time(tmp_path):
    path = tmp_path / "changing.mcap"
    write_changing_room(path)
    with AnyReader([path]) as reader:
        (channel,) = [c for c in reader.connections if c.topic == "/timemap/changes/markers"]
        shown = [
            {m.id for m in reader.deserialize(raw, channel.msgtype).markers if m.ns}
            for _, _, raw in reader.messages([channel])
        ]
    assert shown == [{0}, {1}, {1}]


def test_every_transition_is_a_message_and_every_round_one_of_markers(tmp_path):
    path = tmp_path / "changing.mcap"
    write_changing_room(path)
    times = {"/timemap/changes": [], "/timemap/changes/markers": []}
    for topic, message in messages(path):
        times.get(topic, []).append((message.log_time - T0) // SECOND)
    assert times == {"/timemap/changes": [0, 10, 10, 20], "/timemap/changes/markers": [0, 10, 20]}


def test_markers_are_latched_and_changes_are_not(tmp_path):
    path = tmp_path / "changing.mcap"
    write_changing_room(path)
    qos = {c.topic: c.metadata["offered_qos_profiles"] for c in summary(path).channels.values()}
    assert "durability: 1\n" in qos["/timemap/changes/markers"]
    assert "durability: 2\n" in qos["/timemap/changes"]


def test_report_with_a_nan_is_refused(tmp_path):
    with new_writer(tmp_path / "a.mcap") as writer:
        writer.write_nodes(NODES, T0)
        writer.write_estimates(all_levels(0, T0, 0), T0)
        with pytest.raises(ValueError, match="JSON"):
            writer.finish({}, "", {"share": float("nan")}, {})
    assert list(tmp_path.iterdir()) == []


def test_chunks_hold_what_their_index_says(result):
    chunks: list[ChunkIndex] = summary(result).chunk_indexes
    times = [m.log_time for _, m in messages(result)]
    assert min(c.message_start_time for c in chunks) == times[0]
    assert max(c.message_end_time for c in chunks) == times[-1]
