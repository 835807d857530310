import contextlib

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from tests.conftest import shared_data
from tests.results.rooms import CHANGES, CONFIG, LEVELS, NODES, REPORT, SECOND, T0, write_room
from timemap_cli import __version__
from timemap_cli.errors import ExitCode, TimemapError, UsageError
from timemap_cli.results.reader import ResultReader


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    path = tmp_path_factory.mktemp("room") / "room.timemap.mcap"
    return path, write_room(path)


def same(one, other):
    assert (one.node, one.level, one.stamp_ns) == (other.node, other.level, other.stamp_ns)
    for name in ("ranges", "support", "known", "samples", "status", "last_seen_ns"):
        written, read = getattr(one, name), getattr(other, name)
        assert (written.dtype, written.tobytes()) == (read.dtype, read.tobytes())


def test_what_describes_the_result_comes_back(room):
    with ResultReader(room[0]) as reader:
        assert reader.nodes == NODES
        assert reader.levels == LEVELS
        assert (reader.angle_bins, reader.radius, reader.map_frame) == (360, 5.0, "map")
        assert (reader.metadata["seed"], reader.metadata["inputs"]) == ("0", "a.bag")
        assert (reader.config, reader.report, reader.changes) == (CONFIG, REPORT, CHANGES)
        assert (reader.start_ns, reader.end_ns) == (T0, T0 + 40 * SECOND)


@pytest.mark.parametrize("level", LEVELS)
def test_newest_estimates_come_back_to_the_last_bit(room, level):
    path, told = room
    with ResultReader(path) as reader:
        estimates = reader.estimates(level)
    assert list(estimates) == [0, 1, 2]
    for node, one in estimates.items():
        same(told[level, node][-1], one)


@pytest.mark.parametrize("seconds", [0, 9, 10, 25, 30, 39, 40, 1000])
def test_estimates_until_a_time_are_each_nodes_newest_not_later(room, seconds):
    path, told = room
    until_ns = T0 + seconds * SECOND
    with ResultReader(path) as reader:
        estimates = reader.estimates("mid", until_ns)
    for node in range(3):
        before = [e for e in told["mid", node] if e.stamp_ns <= until_ns] if ("mid", node) in told else []
        assert (node in estimates) == bool(before)
        if before:
            same(before[-1], estimates[node])


def test_until_is_inclusive_and_before_the_start_there_is_nothing(room):
    with ResultReader(room[0]) as reader:
        assert list(reader.estimates("mid", T0)) == [0]
        assert reader.estimates("mid", T0 - 1) == {}


def test_nan_and_clear_come_back(room):
    with ResultReader(room[0]) as reader:
        ranges = reader.estimates("long")[0].ranges
    assert np.isnan(ranges).sum() == 3
    assert np.isposinf(ranges).any()


def test_unknown_level_is_a_key_error(room):
    with ResultReader(room[0]) as reader, pytest.raises(KeyError, match="day"):
        reader.estimates("day")


@pytest.mark.parametrize("compression", [CompressionType.NONE, CompressionType.LZ4])
def test_a_result_compressed_anew_by_another_tool_is_read(room, tmp_path, compression):
    path = tmp_path / "again.mcap"
    copy(room[0], path, compression=compression, chunk_size=5000)
    with ResultReader(room[0]) as reader, ResultReader(path) as again:
        for node, one in reader.estimates("short").items():
            same(one, again.estimates("short")[node])


def copy(source, target, **options):
    from mcap.reader import make_reader

    with source.open("rb") as stream, target.open("wb") as out:
        reader, writer = make_reader(stream), Writer(out, **options)
        writer.start("ros2")
        schemas = {
            s.id: writer.register_schema(s.name, s.encoding, s.data)
            for s in reader.get_summary().schemas.values()
        }
        channels = {
            c.id: writer.register_channel(c.topic, c.message_encoding, schemas[c.schema_id], c.metadata)
            for c in reader.get_summary().channels.values()
        }
        for _, channel, m in reader.iter_messages():
            writer.add_message(channels[channel.id], m.log_time, m.data, m.publish_time)
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, record.metadata)
        writer.finish()


def test_missing_file_is_a_usage_error(tmp_path):
    with pytest.raises(UsageError, match=r"there is no file .*none\.mcap"):
        ResultReader(tmp_path / "none.mcap")


@pytest.mark.parametrize(
    "head", [b"#ROSBAG V2.0\n", b"SQLite format 3\x00" + bytes(100)], ids=["ROS 1 bag", "sqlite3"]
)
def test_a_recording_of_another_format_is_recognised(tmp_path, head):
    path = tmp_path / "log.timemap.mcap"
    path.write_bytes(head)
    with pytest.raises(UsageError, match="is a recording, not a result") as caught:
        ResultReader(path)
    assert caught.value.exit_code is ExitCode.USAGE
    assert f"timemap replay {path}" in caught.value.hint


def test_a_recording_in_mcap_is_recognised(tmp_path):
    path = tmp_path / "log.mcap"
    with path.open("wb") as out:
        writer = Writer(out)
        writer.start("ros2")
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
        channel = writer.register_channel("/chatter", "cdr", schema)
        writer.add_message(channel, 1, b"\x00\x01\x00\x00\x01\x00\x00\x00\x00", 1)
        writer.finish()
    with pytest.raises(UsageError, match="is a recording, not a result"):
        ResultReader(path)


@pytest.mark.parametrize("name", ["intel/intel.mcap", "intel/intel.bag", "intel/intel_db3"])
def test_a_real_recording_is_recognised(name):
    with pytest.raises(UsageError, match="is a recording, not a result"):
        ResultReader(shared_data(name))


def test_a_folder_and_a_text_are_not_results(tmp_path):
    (tmp_path / "notes.txt").write_text("hello")
    for path in (tmp_path, tmp_path / "notes.txt"):
        with pytest.raises(UsageError, match="is not a result of timemap"):
            ResultReader(path)


@pytest.mark.parametrize("share", [0.01, 0.3, 0.7, 0.999])
def test_a_result_that_was_cut_off_is_an_error_that_says_so(room, tmp_path, share):
    path, whole = tmp_path / "cut.mcap", room[0].read_bytes()
    path.write_bytes(whole[: int(len(whole) * share)])
    with pytest.raises(TimemapError, match=r"cut\.mcap is damaged") as caught:
        ResultReader(path)
    assert "again" in caught.value.hint


def test_a_changed_byte_in_the_data_is_found(room, tmp_path):
    path, raw = tmp_path / "changed.mcap", bytearray(room[0].read_bytes())
    raw[20_000] ^= 0xFF
    path.write_bytes(raw)
    with pytest.raises(TimemapError, match="is damaged"):
        read_all(path)


def read_all(path):
    with ResultReader(path) as reader:
        return [reader.estimates(level) for level in LEVELS], reader.config, reader.report


def test_a_changed_byte_anywhere_is_either_harmless_or_one_clear_error(room, tmp_path):
    path, whole = tmp_path / "changed.mcap", room[0].read_bytes()
    places = np.random.default_rng(0).integers(0, len(whole), 100).tolist()
    for place in [*places, *range(len(whole) - 60, len(whole)), *range(0, 60, 3)]:
        raw = bytearray(whole)
        raw[place] ^= 0x41
        path.write_bytes(raw)
        with contextlib.suppress(TimemapError):
            read_all(path)


def test_a_result_of_another_format_names_its_version(room, tmp_path):
    path, raw = tmp_path / "newer.mcap", room[0].read_bytes()
    path.write_bytes(raw.replace(b"timemap.result/2", b"timemap.result/9"))
    with pytest.raises(
        TimemapError, match=r"holds timemap\.result/9 of timemap .* reads timemap\.result/2"
    ) as caught:
        ResultReader(path)
    assert caught.value.hint.startswith(f"timemap {__version__} reads it; or make it again")
