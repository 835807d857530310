"""MCAP files that are damaged or odd."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import lz4.frame  # type: ignore[import-untyped]
import zstandard
from mcap.reader import make_reader
from mcap.writer import Writer

from tests.logs.recorded import (
    ROS1,
    ROS2,
    START_NS,
    CompressionType,
    IndexType,
    Message,
    make,
    serialised,
)
from tests.zoo.making import Animal, changed, cut, drive, mcap, overwritten, uint32, uint64

NONE, LZ4 = {"compression": CompressionType.NONE}, {"compression": CompressionType.LZ4}
UNCHUNKED: dict[str, Any] = {"use_chunking": False}
NO_SUMMARY: dict[str, Any] = {
    "index_types": IndexType.NONE,
    "use_statistics": False,
    "repeat_channels": False,
    "repeat_schemas": False,
    "use_summary_offsets": False,
}


def _chunks(path: Path) -> list[Any]:
    with path.open("rb") as file:
        return make_reader(file).get_summary().chunk_indexes


def _summary_at(path: Path) -> int:
    return int(struct.unpack_from("<Q", path.read_bytes(), -28)[0])


def _in_chunk(path: Path, offset: int, new: bytes, number: int = 2) -> Path:
    """With other bytes at a place of a chunk's record."""
    return overwritten(path, _chunks(path)[number].chunk_start_offset + offset, new)


def _first_range(path: Path) -> int:
    """Where the ranges of the thirtieth scan stand in an MCAP that is not compressed."""
    content = path.read_bytes()
    at = 0
    for _ in range(30):
        at = content.index(b"laser\0", at) + 1
    return at + 100


def _bomb(folder: Path, name: str) -> Path:
    """A chunk that unpacks to 200 MB, beside the good ones, in a file without summary."""
    path = mcap(folder, **NO_SUMMARY)
    zeros = bytes(200_000_000)
    packed = zstandard.compress(zeros) if name == "zstd" else lz4.frame.compress(zeros)
    body = struct.pack("<QQQI", START_NS, START_NS, 5000, 0)
    body += uint32(len(name)) + name.encode() + uint64(len(packed)) + packed
    chunk = b"\x06" + uint64(len(body)) + body

    def change(content: bytearray) -> bytes:
        at = content.rindex(b"\x0f\x04\0\0\0\0\0\0\0")
        return bytes(content[:at] + chunk + content[at:])

    return changed(path, change)


def _beside(
    folder: Path, encoding: str, schema: tuple[str, str, bytes] | None, topic: str = "/beside"
) -> Path:
    """The drive and a channel of another kind."""
    path = folder / "run.mcap"
    writer = Writer(str(path), chunk_size=4096)
    writer.start(profile="", library="tests")
    channels: dict[str, int] = {}
    for one in drive(ROS2):
        if one.topic not in channels:
            text, _ = ROS2.generate_msgdef(one.msgtype, ros_version=2)
            described = writer.register_schema(one.msgtype, "ros2msg", text.encode())
            channels[one.topic] = writer.register_channel(one.topic, "cdr", described)
        writer.add_message(channels[one.topic], one.log_ns, serialised(ROS2, one.content), one.log_ns)
    number = writer.register_schema(*schema) if schema else 0
    other = writer.register_channel(topic, encoding, number)
    for i in range(20):
        writer.add_message(other, START_NS + i, b'{"ranges": [1, 2]}', START_NS + i)
    writer.finish()
    return path


def _json_alone(folder: Path) -> Path:
    path = folder / "run.mcap"
    writer = Writer(str(path))
    writer.start(profile="", library="tests")
    schema = writer.register_schema("sensor_msgs/msg/LaserScan", "jsonschema", b"{}")
    channel = writer.register_channel("/scan", "json", schema)
    writer.add_message(channel, START_NS, b'{"ranges": [1, 2]}', START_NS)
    writer.finish()
    return path


def _unknown_compression(folder: Path) -> Path:
    path = mcap(folder)
    for one in _chunks(path)[2:4]:
        overwritten(path, one.chunk_start_offset + 41, b"brot")
    return path


def _without_channel(folder: Path) -> Path:
    """The record that describes the channel of the scans is one of a private kind."""
    path = mcap(folder, **UNCHUNKED, **NO_SUMMARY)
    content = path.read_bytes()
    at = content.rindex(b"\x04", 0, content.index(b"/scan") - 8)
    assert content[at] == 4
    return overwritten(path, at, b"\x90")


def _private_record(folder: Path) -> Path:
    path = mcap(folder, **UNCHUNKED, **NO_SUMMARY)
    record = b"\x90" + uint64(5) + b"hello"
    return changed(path, lambda c: bytes(c[: c.rindex(b"\x0f\x04")] + record + c[c.rindex(b"\x0f\x04") :]))


def _late_log_times(folder: Path) -> Path:
    """The log times of three messages have their highest bit set."""
    path = mcap(folder, **UNCHUNKED, **NO_SUMMARY)
    content = bytearray(path.read_bytes())
    at = len(content) // 2
    for _ in range(3):
        at = content.index(struct.pack("<Q", START_NS)[-3:], at + 1)
        content[at + 2] |= 0x80
    path.write_bytes(content)
    return path


def _opcode(folder: Path) -> Path:
    """One message in the middle calls itself a chunk index."""
    path = mcap(folder, **UNCHUNKED)
    content = path.read_bytes()
    frame = content.index(b"laser\0", len(content) // 2)
    head = content.rindex(b"\x05", 0, frame - 40)
    while struct.unpack_from("<Q", content, head + 1)[0] > 1000:
        head = content.rindex(b"\x05", 0, head)
    return overwritten(path, head, b"\x08")


def _message_index(folder: Path) -> Path:
    """The message index behind a chunk points to other places."""
    path = mcap(folder)
    chunk = _chunks(path)[2]
    return overwritten(path, chunk.chunk_start_offset + chunk.chunk_length + 30, b"\xff\xff")


def _other_type(folder: Path) -> Path:
    text = make(ROS2, "std_msgs/msg/String", data="hello")
    return mcap(folder, [*drive(ROS2), Message("/chatter", START_NS + 10, text)])


def _attachment(folder: Path) -> Path:
    path = folder / "other.mcap"
    writer = Writer(str(path))
    writer.start()
    writer.add_attachment(0, 0, "picture", "image/png", bytes(100))
    writer.finish()
    record = path.read_bytes()[8 + 9 + 8 + 0 :]
    at = record.index(b"\x09")
    length = struct.unpack_from("<Q", record, at + 1)[0]
    damaged = record[at : at + 9 + length - 4] + b"\1\2\3\4"
    path.unlink()
    path = mcap(folder, **NO_SUMMARY)
    return changed(path, lambda c: bytes(c[: c.rindex(b"\x0f\x04")] + damaged + c[c.rindex(b"\x0f\x04") :]))


def _profile(folder: Path) -> Path:
    return mcap(folder, drive(ROS2), profile="somebody's own")


def _shifted(folder: Path) -> Path:
    path = mcap(folder)
    at = _chunks(path)[3].chunk_start_offset + 100
    return changed(path, lambda c: bytes(c[:at] + c[at + 1 :]))


JSON = ("somebody/Status", "jsonschema", b"{}")
PROTOBUF = ("foxglove.LaserScan", "protobuf", b"\x0a\x05hello")
WHOLE, SOME = 60, range(1, 60)
MCAPS = (
    Animal("mcap_cut_in_a_chunk", lambda f: cut(mcap(f), 0.6), "reads what comes before the cut, also in the chunk, and says where it is", 3, "cut off at byte", SOME),
    Animal("mcap_cut_in_an_lz4_chunk", lambda f: cut(mcap(f, **LZ4), 0.6), "reads what comes before the cut", 3, "cut off at byte", SOME),
    Animal("mcap_without_chunks_cut_off", lambda f: cut(mcap(f, **UNCHUNKED), 0.6), "reads the messages before the cut", 3, "cut off at byte", SOME),
    Animal("mcap_cut_before_the_end_of_its_data", lambda f: changed(p := mcap(f), lambda c: c[: _summary_at(p) - 13]), "reads all there is, and cannot know that it is all", 3, "cut off at byte", WHOLE),
    Animal("mcap_cut_in_its_summary", lambda f: changed(p := mcap(f), lambda c: c[: _summary_at(p) + 50]), "reads all data and says that the end is missing", 0, "its end is missing", WHOLE),
    Animal("mcap_without_its_last_bytes", lambda f: changed(mcap(f), lambda c: c[:-8]), "reads all data and says that the end is missing", 0, "its end is missing", WHOLE),
    Animal("mcap_cut_in_its_first_bytes", lambda f: changed(mcap(f), lambda c: c[:20]), "says in one sentence that nothing is left", 1, "cut off or damaged"),
    Animal("mcap_of_its_first_eight_bytes", lambda f: changed(mcap(f), lambda c: c[:8]), "says in one sentence that nothing is left", 1, "cut off"),
    Animal("mcap_with_a_wrong_chunk_checksum", lambda f: _in_chunk(mcap(f, **NONE), 700, b"\1\2\3"), "leaves that chunk out and says so", 3, "its checksum is wrong", SOME),
    Animal("mcap_with_a_damaged_zstd_chunk", lambda f: _in_chunk(mcap(f), 100, bytes(30)), "leaves that chunk out and says so", 3, "is damaged and left out", SOME),
    Animal("mcap_with_a_damaged_lz4_chunk", lambda f: _in_chunk(mcap(f, **LZ4), 100, bytes(30)), "leaves that chunk out and says so", 3, "is damaged and left out", SOME),
    Animal("mcap_with_a_wrong_data_checksum", lambda f: overwritten(p := mcap(f, **UNCHUNKED, enable_data_crcs=True), _first_range(p), b"\1"), "says that some of what it reads may be damaged", 3, "the checksum over its data is wrong", WHOLE),
    Animal("mcap_with_a_flipped_range_and_no_checksum", lambda f: overwritten(p := mcap(f, **UNCHUNKED), _first_range(p), b"\1"), "cannot know it", 0, "", WHOLE),
    Animal("mcap_with_chunks_of_unknown_compression", _unknown_compression, "names the compression and reads the other chunks", 3, "its compression 'brot' is unknown", SOME),
    Animal("mcap_with_a_chunk_that_claims_2_to_the_60", lambda f: _in_chunk(mcap(f), 9 + 16, uint64(1 << 60)), "takes no memory for a claim and reads the other chunks", 3, "more than 268435456 are not read", SOME),
    Animal("mcap_with_a_zstd_bomb", lambda f: _bomb(f, "zstd"), "unpacks no more than the chunk says it holds", 3, "it holds more than 5000", WHOLE),
    Animal("mcap_with_an_lz4_bomb", lambda f: _bomb(f, "lz4"), "unpacks no more than the chunk says it holds", 3, "it holds more than 5000", WHOLE),
    Animal("mcap_without_index_and_summary", lambda f: mcap(f, **NO_SUMMARY), "reads it from the beginning", 0, "", WHOLE),
    Animal("mcap_of_no_profile", lambda f: mcap(f, drive(ROS2), profile=""), "reads it all the same", 0, "", WHOLE),
    Animal("mcap_of_an_unknown_profile", _profile, "reads it all the same", 0, "", WHOLE),
    Animal("mcap_of_ros1_profile", lambda f: mcap(f, drive(ROS1), profile="ros1"), "reads it like any other", 0, "", WHOLE),
    Animal("mcap_with_a_json_channel_beside", lambda f: _beside(f, "json", JSON), "passes over what it does not need", 0, "", WHOLE),
    Animal("mcap_with_a_protobuf_channel_beside", lambda f: _beside(f, "protobuf", PROTOBUF), "passes over what it does not need", 0, "", WHOLE),
    Animal("mcap_with_a_channel_without_schema_beside", lambda f: _beside(f, "", None), "passes over what it does not need", 0, "", WHOLE),
    Animal("mcap_with_scans_in_json_beside", lambda f: _beside(f, "json", ("sensor_msgs/msg/LaserScan", "jsonschema", b"{}")), "uses the scans that it can read", 0, "", WHOLE),
    Animal("mcap_with_scans_in_json_on_the_same_topic", lambda f: _beside(f, "json", ("sensor_msgs/msg/LaserScan", "jsonschema", b"{}"), "/scan"), "uses the scans that it can read", 0, "", WHOLE),
    Animal("mcap_with_scans_in_json_alone", _json_alone, "says that scans in JSON are not read", 2, "json"),
    Animal("mcap_with_an_unknown_type_beside", _other_type, "passes over what it does not need", 0, "", WHOLE),
    Animal("mcap_whose_scans_are_of_no_channel", _without_channel, "says how many messages cannot be told apart", 2, "60 messages are of no known channel"),
    Animal("mcap_with_a_record_of_a_private_kind", _private_record, "passes over it and says so", 0, "1 records? of a private kind", WHOLE),
    Animal("mcap_with_a_record_of_the_wrong_kind", _opcode, "leaves it out and says so", 3, "is damaged and left out", range(59, 61)),
    Animal("mcap_with_log_times_beyond_all_clocks", _late_log_times, "leaves those messages out and says so", 3, "are missing", range(57, 61)),
    Animal("mcap_whose_message_index_points_elsewhere", _message_index, "goes by the messages themselves", 0, "", WHOLE),
    Animal("mcap_with_a_byte_missing_in_the_middle", _shifted, "reads what comes before and says so", 3, "is damaged and left out", SOME),
    Animal("mcap_with_a_damaged_attachment", _attachment, "does not care", 0, "", WHOLE),
    Animal("mcap_with_a_damaged_summary", lambda f: overwritten(p := mcap(f), _summary_at(p) + 20, b"\xff\xff"), "does not believe the summary and reads all of it", 0, "", WHOLE),
)  # fmt: skip
