"""Recordings of every format give the same content; what is no recording, or damaged, is said in one sentence."""

from __future__ import annotations

import struct
import tracemalloc
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import zstandard
from mcap.reader import make_reader

from tests.cli.result_files import all_levels, write
from tests.logs import recorded
from tests.logs.recorded import ROS1, ROS2, START_NS, TOPICS, CompressionType, IndexType, StoragePlugin
from timemap_cli.errors import ExitCode, TimemapError, UsageError
from timemap_cli.logs.recordings import Recording, open_recordings

WITHOUT_INDEX = {"index_types": IndexType.NONE, "use_statistics": False, "repeat_channels": False}


def read(path: Path, topics=TOPICS, **window) -> dict:
    with Recording(path) as recording:
        return recorded.rows([batch for batches in recording.batches(topics, **window) for batch in batches])


def problems_after_reading(path: Path) -> str:
    with Recording(path) as recording:
        for _ in recording.batches(TOPICS):
            pass
        return " / ".join(recording.problems)


def remarks(path: Path) -> str:
    with Recording(path) as recording:
        return " / ".join(recording.remarks)


def mcap(**options):
    return lambda folder, n=20: recorded.write_mcap(folder / "run.mcap", recorded.drive(ROS2, n), **options)


def bag(compression):
    return lambda folder, n=20: recorded.write_bag(
        folder / "run.bag", recorded.drive(ROS1, n), compression, chunk_bytes=2000
    )


def rosbag2(plugin, mode):
    return lambda folder, n=20: recorded.write_rosbag2(folder / "run", recorded.drive(ROS2, n), plugin, mode)


FORMATS = {
    "bag": (bag("none"), "ROS 1 bag"),
    "bag_bz2": (bag("bz2"), "ROS 1 bag"),
    "bag_lz4": (bag("lz4"), "ROS 1 bag"),
    "mcap": (mcap(), "ROS 2 mcap"),
    "mcap_lz4": (mcap(compression=CompressionType.LZ4), "ROS 2 mcap"),
    "mcap_without_index": (mcap(**WITHOUT_INDEX), "ROS 2 mcap"),
    "mcap_without_message_index": (mcap(index_types=IndexType.CHUNK), "ROS 2 mcap"),
    "mcap_without_chunks": (mcap(use_chunking=False), "ROS 2 mcap"),
    "mcap_without_profile": (mcap(profile=""), "MCAP"),
    "folder_mcap": (rosbag2(StoragePlugin.MCAP, "none"), "ROS 2 mcap"),
    "folder_mcap_storage": (rosbag2(StoragePlugin.MCAP, "storage"), "ROS 2 mcap"),
    "folder_mcap_message": (rosbag2(StoragePlugin.MCAP, "message"), "ROS 2 mcap"),
    "folder_mcap_file": (rosbag2(StoragePlugin.MCAP, "file"), "ROS 2 mcap"),
    "folder_sqlite": (rosbag2(StoragePlugin.SQLITE3, "none"), "ROS 2 sqlite3"),
    "folder_sqlite_message": (rosbag2(StoragePlugin.SQLITE3, "message"), "ROS 2 sqlite3"),
    "folder_sqlite_file": (rosbag2(StoragePlugin.SQLITE3, "file"), "ROS 2 sqlite3"),
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_what_was_written(tmp_path, name):
    write, label = FORMATS[name]
    path = write(tmp_path)
    assert read(path) == recorded.drive_rows(ROS2)
    with Recording(path) as recording:
        assert recording.format == label
        assert recording.start_ns == START_NS
        assert recording.end_ns == START_NS + 1_900_000_005
        assert {topic.name: topic.count for topic in recording.topics} == {
            name: 1 if name == "/tf_static" else 20 for name in TOPICS
        }
        assert recording.problems == ()


def test_mcap_of_ros1_profile(tmp_path):
    path = recorded.write_mcap(tmp_path / "run.mcap", recorded.drive(ROS1), profile="ros1")
    assert read(path) == recorded.drive_rows(ROS1)
    with Recording(path) as recording:
        assert recording.format == "MCAP (ros1)"
        assert ("/tf", "tf2_msgs/msg/TFMessage") in [(one.name, one.msgtype) for one in recording.topics]


@pytest.mark.parametrize("name", ["bag", "mcap"])
def test_suffix_does_not_matter(tmp_path, name):
    path = FORMATS[name][0](tmp_path).rename(tmp_path / "recording.db3")
    assert read(path) == recorded.drive_rows(ROS2)


@pytest.mark.parametrize(
    "name", ["folder_mcap", "folder_sqlite", "folder_mcap_file", "folder_sqlite_message"]
)
def test_folder_without_metadata(tmp_path, name):
    path = FORMATS[name][0](tmp_path)
    (path / "metadata.yaml").unlink()
    assert read(path) == recorded.drive_rows(ROS2)


@pytest.mark.parametrize("name", ["folder_mcap", "folder_sqlite", "folder_mcap_file"])
def test_lone_storage_file(tmp_path, name):
    (file,) = [one for one in FORMATS[name][0](tmp_path).iterdir() if one.name != "metadata.yaml"]
    assert read(file) == recorded.drive_rows(ROS2)


def split_folder(tmp_path: Path) -> Path:
    messages = recorded.drive(ROS2)
    folder = tmp_path / "run"
    folder.mkdir()
    recorded.write_mcap(folder / "run_10.mcap", messages[50:])
    recorded.write_mcap(folder / "run_9.mcap", messages[:50])
    return folder


def test_parts_of_a_recording_are_read_in_order_of_time(tmp_path):
    folder = split_folder(tmp_path)
    assert read(folder) == recorded.drive_rows(ROS2)
    with Recording(folder) as recording:
        assert (recording.start_ns, recording.end_ns) == (START_NS, START_NS + 1_900_000_005)


def test_parts_of_a_recording_that_overlap_are_read_together(tmp_path, monkeypatch):
    monkeypatch.setattr("timemap_cli.logs.chunked.STRETCH_BYTES", 2000)
    messages = recorded.drive(ROS2, 200)
    folder = tmp_path / "run"
    folder.mkdir()
    recorded.write_mcap(folder / "run_0.mcap", messages[:300:2] + messages[300:700])
    recorded.write_mcap(folder / "run_1.mcap", messages[1:300:2])
    recorded.write_mcap(folder / "run_2.mcap", messages[700:])
    assert read(folder) == recorded.drive_rows(ROS2, 200)
    with Recording(folder) as recording:
        times = [
            np.concatenate([one.log_ns for one in batches]) for batches in recording.batches(("/scan", "/tf"))
        ]
    assert len(times) > 5
    assert all(earlier.max() <= later.min() for earlier, later in pairwise(times))


def test_a_part_that_metadata_names_and_is_missing_is_told(tmp_path):
    folder = split_folder(tmp_path)
    names = ["run_9.mcap", "run_10.mcap", "run_11.mcap"]
    (folder / "metadata.yaml").write_text(f"rosbag2_bagfile_information: {{relative_file_paths: {names}}}")
    assert read(folder) == recorded.drive_rows(ROS2)
    assert problems_after_reading(folder) == "run_11.mcap is missing, although metadata.yaml names it"


def test_unreadable_metadata_is_told_and_the_files_are_read(tmp_path):
    folder = split_folder(tmp_path)
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: [")
    assert read(folder) == recorded.drive_rows(ROS2)
    assert "metadata.yaml cannot be read" in remarks(folder)
    assert problems_after_reading(folder) == ""


def test_folder_of_several_recordings_is_refused_and_they_are_named(tmp_path):
    FORMATS["mcap"][0](tmp_path)
    recorded.write_mcap(tmp_path / "other.mcap", recorded.drive(ROS2))
    (tmp_path / "a_bag").mkdir()
    (tmp_path / "a_bag" / "metadata.yaml").touch()
    (tmp_path / "notes").mkdir()
    with pytest.raises(UsageError, match="holds several recordings") as caught:
        Recording(tmp_path)
    assert caught.value.hint == "\n".join(str(tmp_path / one) for one in ("other.mcap", "run.mcap", "a_bag"))


def test_messages_outside_the_window_are_left_out(tmp_path):
    start_ns, end_ns = START_NS + 500_000_002, START_NS + 900_000_002  # scans 5 (included) to 9 (excluded)
    for name in ("bag", "mcap", "mcap_without_index", "folder_sqlite"):
        folder = tmp_path / name
        folder.mkdir()
        found = read(FORMATS[name][0](folder), ["/scan"], start_ns=start_ns, end_ns=end_ns)
        assert found == {
            key: value[5:9] for key, value in recorded.drive_rows(ROS2).items() if key[0] == "scan"
        }


def test_recordings_come_in_order_of_their_start(tmp_path):
    messages = recorded.drive(ROS2)
    paths = [
        recorded.write_mcap(tmp_path / f"{name}.mcap", part)
        for name, part in (("b", messages[60:]), ("a", messages[:30]), ("c", messages[30:60]))
    ]
    recordings = open_recordings(paths)
    assert [one.path.stem for one in recordings] == ["a", "c", "b"]
    for one in recordings:
        one.close()


def test_connections_of_one_topic_are_read_together(tmp_path):
    messages = [one for one in recorded.drive(ROS1) if one.topic == "/tf"]
    path = tmp_path / "run.bag"
    with recorded.BagWriter(path) as writer:
        connections = [
            writer.add_connection("/tf", messages[0].msgtype, typestore=ROS1, callerid=name)
            for name in ("/amcl", "/driver")
        ]
        for index, one in enumerate(messages):
            writer.write(connections[index % 2], one.log_ns, recorded.serialised(ROS1, one.content))
    whole = recorded.drive_rows(ROS1)
    assert read(path) == {key: whole[key] for key in whole if key[:2] == ("transform", False)}
    with Recording(path) as recording:
        assert [(topic.name, topic.count) for topic in recording.topics] == [("/tf", 20)]
        batches = [batch for batches in recording.batches(["/tf"]) for batch in batches]
    assert sorted(len(batch.log_ns) for batch in batches) == [7, 20]


def test_topics_that_are_not_there_give_nothing(tmp_path):
    assert read(FORMATS["mcap"][0](tmp_path), ["/scan2"]) == {}


def test_topic_of_a_type_that_is_not_read_is_refused(tmp_path):
    clock = recorded.make(ROS2, "std_msgs/msg/String", data="hello")
    path = recorded.write_mcap(tmp_path / "run.mcap", [recorded.Message("/chatter", START_NS, clock)])
    with pytest.raises(UsageError, match=r"/chatter in .*run\.mcap holds std_msgs/msg/String"):
        read(path, ["/chatter"])


def test_recording_without_messages(tmp_path):
    path = recorded.write_mcap(tmp_path / "run.mcap", [])
    with Recording(path) as recording:
        assert (recording.start_ns, recording.end_ns, recording.topics) == (0, 0, ())


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is not a recording: it is empty"),
        (b"image: map.pgm\nresolution: 0.05\n", "is neither a ROS 1 bag nor a ROS 2 bag nor an MCAP file"),
        (b"#ROSRECORD V1.2\n", "is a ROS bag of version 1.2; only version 2.0 is read"),
        (b"#ROSBAG V1.1\n", "is a ROS bag of version 1.1; only version 2.0 is read"),
    ],
)
def test_files_that_are_no_recording(tmp_path, content, message):
    path = tmp_path / "file.bag"
    path.write_bytes(content)
    with pytest.raises(UsageError) as caught:
        Recording(path)
    assert str(path) in caught.value.message
    assert message in caught.value.message
    assert caught.value.hint


@pytest.mark.parametrize("magic", [b"#ROSBAG V2.0\n", b"\x89MCAP0\r\n", b"SQLite format 3\0"])
def test_files_that_only_begin_like_a_recording(tmp_path, magic):
    path = tmp_path / "file"
    path.write_bytes(magic + bytes(range(100)))
    with pytest.raises(TimemapError, match="cannot be read: ") as caught:
        Recording(path)
    assert "unpack" not in caught.value.message
    assert str(path) in caught.value.message
    assert caught.value.exit_code == ExitCode.FAILED


@pytest.mark.parametrize("length", [9, 13, 20])
def test_a_recording_cut_off_in_its_first_bytes_is_said_to_be(tmp_path, length):
    path = FORMATS["mcap"][0](tmp_path)
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(TimemapError, match="it is cut off or damaged"):
        Recording(path)


def test_a_file_of_a_folder_that_cannot_be_read_is_named(tmp_path):
    folder = FORMATS["folder_mcap"][0](tmp_path)
    (inner,) = folder.glob("*.mcap")
    inner.unlink()
    inner.mkdir()
    with pytest.raises(TimemapError) as caught:
        Recording(folder)
    assert caught.value.message == f"{folder} cannot be read: {inner}: is a directory"


def test_missing_file(tmp_path):
    with pytest.raises(UsageError, match=r"there is no file .*nothing\.bag"):
        open_recordings([tmp_path / "nothing.bag"])


def test_folder_without_recordings(tmp_path):
    with pytest.raises(UsageError, match="holds no recording"):
        Recording(tmp_path)


def test_the_same_recording_twice_is_refused(tmp_path):
    path = FORMATS["mcap"][0](tmp_path)
    with pytest.raises(UsageError, match="is given twice"):
        open_recordings([path, tmp_path / "." / path.name])


def test_result_of_ours_is_refused(tmp_path):
    for options in ({}, WITHOUT_INDEX):
        path = recorded.write_mcap(tmp_path / "out.mcap", recorded.drive(ROS2), metadata="timemap", **options)
        with pytest.raises(UsageError, match="is a result of timemap, not a recording") as caught:
            Recording(path)
        assert str(path) in str(caught.value.hint)


def test_result_of_ours_that_is_cut_off_is_refused(tmp_path):
    """Without its end, and so without the record that says what it is, its topics tell."""
    path = write(tmp_path / "r.timemap.mcap", [(seconds, all_levels(False)) for seconds in range(300)])
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(UsageError, match="is a damaged result of timemap, not a recording"):
        Recording(path)


@pytest.mark.parametrize("name", ["mcap", "mcap_without_chunks", "bag", "bag_lz4"])
def test_what_comes_before_the_cut_is_read_and_the_cut_is_told(tmp_path, name):
    path = FORMATS[name][0](tmp_path, 200)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    found = read(path)
    whole = recorded.drive_rows(ROS2, 200)
    scans = ("scan", "/scan", "laser")
    assert 50 < len(found[scans]) < 150
    assert all(found[key] == whole[key][: len(found[key])] for key in found)
    assert "it is cut off at byte" in problems_after_reading(path)


def test_bag_that_was_never_closed_is_read_whole(tmp_path):
    path = FORMATS["bag"][0](tmp_path)
    content = bytearray(path.read_bytes())
    at = content.index(b"index_pos=") + len(b"index_pos=")
    content[at : at + 8] = bytes(8)
    path.write_bytes(content)
    assert read(path) == recorded.drive_rows(ROS2)
    assert "index is missing" in remarks(path)
    assert problems_after_reading(path) == ""


def test_a_bag_cut_off_in_its_only_chunk_gives_the_whole_messages_before(tmp_path):
    path = recorded.write_bag(tmp_path / "run.bag", recorded.drive(ROS1, 200), "none", chunk_bytes=10**9)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    found, whole = read(path), recorded.drive_rows(ROS2, 200)
    scans = ("scan", "/scan", "laser")
    assert 80 < len(found[scans]) < 110
    assert all(found[key] == whole[key][: len(found[key])] for key in found)
    assert "it is cut off at byte" in problems_after_reading(path)
    assert remarks(path) == ""


def cut_in_its_chunk(path: Path) -> Path:
    """The bag of one chunk without the last third of that, and what stands behind it."""
    content = path.read_bytes()
    begin, end = content.index(b"compression="), content.index(b"ver=\1\0\0\0")
    path.write_bytes(content[: begin + (end - begin) * 2 // 3])
    return path


def test_a_bag_cut_off_in_its_only_compressed_chunk_gives_the_blocks_before(tmp_path):
    path = recorded.write_bag(tmp_path / "run.bag", recorded.drive(ROS1, 500), "lz4", chunk_bytes=10**9)
    found, whole = read(cut_in_its_chunk(path)), recorded.drive_rows(ROS2, 500)
    scans = ("scan", "/scan", "laser")
    assert 100 < len(found[scans]) < 450
    assert all(found[key] == whole[key][: len(found[key])] for key in found)
    assert "it is cut off at byte" in problems_after_reading(path)


def test_a_bag_cut_off_before_its_first_block_says_that_nothing_is_left(tmp_path):
    path = recorded.write_bag(tmp_path / "run.bag", recorded.drive(ROS1, 200), "bz2", chunk_bytes=10**9)
    assert "no message comes whole before that" in problems_after_reading(cut_in_its_chunk(path))


@pytest.mark.parametrize("missing", [0, 30])
def test_the_chunk_that_a_crash_left_open_is_read_as_far_as_it_goes(tmp_path, missing):
    """Until a chunk is closed, its head says it is empty."""
    path = FORMATS["bag"][0](tmp_path)
    content = bytearray(path.read_bytes())
    at = content.index(b"index_pos=") + len(b"index_pos=")
    content[at : at + 8] = bytes(8)
    head = content.rindex(b"compression=none")
    size_at = head + len(b"compression=none") + 4 + len(b"size=")
    (size,) = struct.unpack_from("<I", content, size_at)
    content[size_at : size_at + 8] = bytes(8)  # and the length of the chunk behind it
    path.write_bytes(content[: size_at + 8 + size - missing])
    found, whole = read(path), recorded.drive_rows(ROS2)
    odometry = ("pose", "/odom", "odom", "base_link")
    assert found == whole | {odometry: whole[odometry][: 19 if missing else 20]}
    assert (
        problems_after_reading(path)
        == "it was never closed, as after a crash; what was written whole is read"
    )


@pytest.mark.parametrize("name", ["mcap", "mcap_lz4", "bag_bz2", "bag_lz4"])
def test_damaged_chunk_is_left_out_and_told(tmp_path, name):
    path = FORMATS[name][0](tmp_path)
    content = bytearray(path.read_bytes())
    magic = {"mcap": b"\x28\xb5\x2f\xfd", "bag_bz2": b"BZh"}.get(name, b"\x04\x22\x4d\x18")
    second = content.index(magic, content.index(magic) + 1)
    content[second + 4 : second + 44] = b"\xff" * 40
    path.write_bytes(content)
    found, whole = read(path), recorded.drive_rows(ROS2)
    scans = ("scan", "/scan", "laser")
    assert 0 < len(found[scans]) < 20
    assert set(found[scans]) < set(whole[scans])
    assert "is damaged and left out" in problems_after_reading(path)


def chunks(path: Path):
    with path.open("rb") as file:
        return make_reader(file).get_summary().chunk_indexes


def test_a_chunk_whose_head_is_gone_is_told(tmp_path):
    path = FORMATS["mcap"][0](tmp_path)
    content, second = bytearray(path.read_bytes()), chunks(path)[1]
    content[second.chunk_start_offset : second.chunk_start_offset + 60] = bytes(60)
    path.write_bytes(content)
    found, whole = read(path), recorded.drive_rows(ROS2)
    scans = ("scan", "/scan", "laser")
    missing = 20 - len(found[scans])
    assert set(found[scans]) < set(whole[scans])
    told = problems_after_reading(path)
    assert f"the chunk at byte {second.chunk_start_offset} is damaged and left out: there is no chunk" in told
    assert f"{missing} of 20 messages of /scan are missing" in told


def test_a_bag_whose_index_announces_other_numbers_than_its_chunks_is_scanned(tmp_path):
    path = FORMATS["bag"][0](tmp_path)
    content = bytearray(path.read_bytes())
    # A bag ends with how many messages its last chunk holds of each topic.
    assert content[-8:] == struct.pack("<II", 5, 1)
    content[-4:] = struct.pack("<I", 4)
    path.write_bytes(content)
    assert read(path) == recorded.drive_rows(ROS2)
    assert problems_after_reading(path) == ""
    assert "index is missing or damaged" in remarks(path)


def test_a_damaged_chunk_of_a_bag_without_index_does_not_hide_those_behind_it(tmp_path):
    path = FORMATS["bag_bz2"][0](tmp_path)
    content = bytearray(path.read_bytes())
    at = content.index(b"index_pos=") + len(b"index_pos=")
    content[at : at + 8] = bytes(8)
    second = content.index(b"BZh", content.index(b"BZh") + 1)
    content[second + 20 : second + 40] = bytes(20)
    path.write_bytes(content)
    found, whole = read(path), recorded.drive_rows(ROS2)
    scans = ("scan", "/scan", "laser")
    assert found[scans][-1] == whole[scans][-1]
    assert 10 < len(found[scans]) < 20
    assert "is damaged and left out" in problems_after_reading(path)


def test_messages_in_front_of_the_damage_in_a_chunk_of_a_bag_are_read(tmp_path):
    path = recorded.write_bag(tmp_path / "run.bag", recorded.drive(ROS1), "none", chunk_bytes=10**9)
    content = bytearray(path.read_bytes())
    middle = content.index(b"time=", len(content) // 3)
    content[middle - 4 : middle] = b"\xff" * 4  # the length of a field in a message's header
    path.write_bytes(content)
    found, whole = read(path), recorded.drive_rows(ROS2)
    scans = ("scan", "/scan", "laser")
    assert 3 < len(found[scans]) < 15
    assert all(found[key] == whole[key][: len(found[key])] for key in found)
    assert "is damaged; what comes before in it is read" in problems_after_reading(path)


def test_an_mcap_with_a_summary_is_not_read_whole_to_open_it(tmp_path, monkeypatch):
    monkeypatch.setattr("timemap_cli.logs.mcap_file.scan", None)
    assert read(FORMATS["mcap"][0](tmp_path)) == recorded.drive_rows(ROS2)


def test_an_index_of_a_bag_that_claims_to_be_longer_than_the_file_takes_no_memory(tmp_path):
    path = FORMATS["bag"][0](tmp_path)
    content = bytearray(path.read_bytes())
    field = b"\n\0\0\0count="  # of the first index record
    struct.pack_into("<I", content, content.index(field) + len(field), (1 << 32) - 1)
    path.write_bytes(content)
    tracemalloc.start()
    found = read(path)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found == recorded.drive_rows(ROS2)
    assert most < 1 << 28


@pytest.mark.parametrize("with_checksum", [True, False])
@pytest.mark.parametrize("length", [1 << 40, (1 << 63) + 5, 1 << 31])
def test_a_chunk_length_that_cannot_be_is_not_believed(tmp_path, with_checksum, length):
    path = FORMATS["mcap"][0](tmp_path)
    content, second = bytearray(path.read_bytes()), chunks(path)[1]
    described = struct.pack("<QQ", second.chunk_start_offset, second.chunk_length)
    struct.pack_into("<Q", content, content.index(described) + 8, length)
    if not with_checksum:
        content[-12:-8] = bytes(4)
    path.write_bytes(content)
    assert read(path) == recorded.drive_rows(ROS2)
    assert problems_after_reading(path) == ""


def test_an_uncompressed_length_that_cannot_be_is_not_believed(tmp_path):
    path = FORMATS["mcap"][0](tmp_path)
    content, second = bytearray(path.read_bytes()), chunks(path)[1]
    struct.pack_into("<Q", content, second.chunk_start_offset + 9 + 16, 1 << 50)
    path.write_bytes(content)
    assert len(read(path)["scan", "/scan", "laser"]) < 20
    assert (
        "it says it holds 1125899906842624 bytes, more than 268435456 are not read"
        in problems_after_reading(path)
    )


def test_mcap_without_counts_of_its_channels(tmp_path, monkeypatch):
    finish = recorded.McapWriter.finish

    def finish_without_counts(self):
        self._Writer__statistics.channel_message_counts.clear()
        finish(self)

    monkeypatch.setattr(recorded.McapWriter, "finish", finish_without_counts)
    path = FORMATS["mcap"][0](tmp_path)
    assert read(path) == recorded.drive_rows(ROS2)
    with Recording(path) as recording:
        assert {topic.name: topic.count for topic in recording.topics}["/scan"] == 20


def test_journal_beside_a_database_is_told(tmp_path):
    folder = FORMATS["folder_sqlite"][0](tmp_path)
    (folder / "run.db3-wal").write_bytes(b"something")
    assert "run.db3-wal are not read" in problems_after_reading(folder)


def test_compressed_file_that_is_no_recording(tmp_path):
    path = tmp_path / "notes.txt.zstd"
    path.write_bytes(zstandard.compress(b"some text"))
    with pytest.raises(UsageError, match="is not a recording"):
        Recording(path)
