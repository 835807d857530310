"""ROS 1 bags that are damaged or odd."""

from __future__ import annotations

import bz2
import struct
from pathlib import Path

from tests.logs.recorded import ROS1, START_NS, Message, make
from tests.zoo.making import Animal, bag, changed, cut, drive, overwritten, uint32, uint64

INDEX_HEAD = b"ver=\1\0\0\0"  # in the header of the index records behind a chunk


def _index_at(content: bytes | bytearray) -> int:
    at = content.index(b"index_pos=") + 10
    return int.from_bytes(content[at : at + 8], "little")


def _without_index(path: Path) -> Path:
    return changed(path, lambda content: content[: _index_at(content)])


def _before_chunk(path: Path, number: int) -> Path:
    """The bag up to where one of its chunks begins."""
    content = path.read_bytes()
    begins, at = [], 13
    while at < _index_at(content):
        (header,) = struct.unpack_from("<I", content, at)
        (data,) = struct.unpack_from("<I", content, at + 4 + header)
        if b"compression=" in content[at : at + 4 + header]:
            begins.append(at)
        at += 8 + header + data
    return changed(path, lambda _: content[: begins[number]])


def _never_closed(path: Path) -> Path:
    content = path.read_bytes()
    return overwritten(path, content.index(b"index_pos=") + 10, uint64(0))


def _counts(path: Path, name: bytes, change: int) -> Path:
    """With another number of chunks or connections in the bag's head."""
    content = path.read_bytes()
    at = content.index(name + b"=") + len(name) + 1
    return overwritten(path, at, uint32(int.from_bytes(content[at : at + 4], "little") + change))


def _second_chunk_twice(path: Path) -> Path:
    """The index has the place of the second chunk for the third, too."""
    content = path.read_bytes()
    places = []
    at = _index_at(content)
    while (at := content.find(b"chunk_pos=", at)) >= 0:
        places.append(at + 10)
        at += 1
    return overwritten(path, places[2], content[places[1] : places[1] + 8])


def _bomb(folder: Path) -> Path:
    """The second of the chunks unpacks to 100 MB, and says it holds as much as before."""
    path = bag(folder, "bz2")
    content = path.read_bytes()
    at = content.index(b"BZh", content.index(b"BZh") + 1)
    old = int.from_bytes(content[at - 4 : at], "little")
    new = bz2.compress(bytes(100_000_000))
    return changed(path, lambda _: content[: at - 4] + uint32(len(new)) + new + content[at + old :])


def _in_bz2(folder: Path) -> Path:
    path = bag(folder, "bz2")
    content = path.read_bytes()
    at = content.index(b"BZh", content.index(b"BZh") + 1)
    return overwritten(path, at + 40, b"\0\0\0\0")


def _unknown_compression(folder: Path) -> Path:
    path = bag(folder, "lz4")
    content = path.read_bytes()
    second = content.index(b"compression=lz4", content.index(b"compression=lz4") + 1)
    return overwritten(path, second + 12, b"xyz")


def _large_size(folder: Path) -> Path:
    path = bag(folder, "lz4")
    content = path.read_bytes()
    second = content.index(b"compression=lz4", content.index(b"compression=lz4") + 1)
    return overwritten(path, content.index(b"size=", second) + 5, uint32((1 << 32) - 1))


def _long_header(folder: Path) -> Path:
    path = bag(folder)
    content = path.read_bytes()
    return overwritten(path, content.index(b"compression=") - 8, uint32((1 << 32) - 1))


def _without_definitions(path: Path) -> Path:
    """The definition of laser scans is one that nobody can read."""
    return changed(path, lambda content: content.replace(b"float32 angle_min", b"!!!!!!! angle_min"))


def _other_type(folder: Path) -> Path:
    text = make(ROS1, "std_msgs/msg/String", data="hello")
    return bag(folder, messages=[*drive(ROS1), Message("/chatter", START_NS + 10, text)])


def _old(folder: Path) -> Path:
    path = folder / "run.bag"
    path.write_bytes(b"#ROSRECORD V1.2\n" + bytes(1000))
    return path


def _encrypted(folder: Path) -> Path:
    return changed(bag(folder), lambda content: content.replace(b"index_pos=", b"encryptor=", 1))


WHOLE, SOME = 60, range(1, 60)
BAGS = (
    Animal("bag_cut_in_a_chunk", lambda f: cut(bag(f), 0.6), "reads what comes before the cut and says where it is", 3, "cut off at byte", SOME),
    Animal("bag_cut_in_a_bz2_chunk", lambda f: cut(bag(f, "bz2"), 0.6), "reads the chunks before the cut", 3, "cut off at byte", SOME),
    Animal("bag_cut_in_an_lz4_chunk", lambda f: cut(bag(f, "lz4"), 0.6), "reads the chunks before the cut", 3, "cut off at byte", SOME),
    Animal("bag_cut_between_two_chunks", lambda f: _before_chunk(bag(f, "lz4"), -2), "says that the last chunks are missing", 3, "cut off at byte", SOME),
    Animal("bag_cut_before_its_index", lambda f: _without_index(bag(f)), "reads all of it and says that the index is missing", 0, "index is missing", WHOLE),
    Animal("bag_cut_in_its_index", lambda f: changed(bag(f), lambda c: c[:-40]), "reads all of it and says that the index is damaged", 0, "index is missing or damaged", WHOLE),
    Animal("bag_that_was_never_closed", lambda f: _never_closed(bag(f)), "reads all of it and says that the index is missing", 0, "index is missing", WHOLE),
    Animal("bag_cut_in_its_head", lambda f: changed(bag(f), lambda c: c[:50]), "says in one sentence that nothing is left", 1, "cut off"),
    Animal("bag_of_its_first_line", lambda f: changed(bag(f), lambda c: c[:13]), "says in one sentence that nothing is left", 1, "cut off"),
    Animal("bag_without_chunks", lambda f: changed(bag(f), lambda c: c[:4117]), "says that no message is left", 2, "no message comes whole before that"),
    Animal("bag_with_a_damaged_bz2_chunk", _in_bz2, "leaves that chunk out and says so", 3, "cannot be decompressed", SOME),
    Animal("bag_whose_index_misses_a_chunk", lambda f: _counts(bag(f), b"chunk_count", -1), "does not believe the index and reads all chunks", 0, "index is missing or damaged", WHOLE),
    Animal("bag_whose_index_has_a_chunk_too_many", lambda f: _counts(bag(f), b"chunk_count", 1), "does not believe the index", 0, "index is missing or damaged", WHOLE),
    Animal("bag_whose_index_misses_a_topic", lambda f: _counts(bag(f), b"conn_count", -1), "does not believe the index", 0, "index is missing or damaged", WHOLE),
    Animal("bag_whose_index_has_a_chunk_twice", lambda f: _second_chunk_twice(bag(f)), "reads every chunk once", 0, "index is missing or damaged", WHOLE),
    Animal("bag_with_a_chunk_of_unknown_compression", _unknown_compression, "names the compression and reads the other chunks", 3, "its compression 'xyz' is unknown", SOME),
    Animal("bag_with_a_chunk_that_claims_4_GB", _large_size, "takes no memory for a claim and reads the other chunks", 3, "more than 268435456 are not read", SOME),
    Animal("bag_with_a_bz2_bomb", _bomb, "unpacks no more than the chunk says it holds", 3, "it holds more than", SOME),
    Animal("bag_with_a_header_that_claims_4_GB", _long_header, "takes no memory for a claim and says that nothing is left", 2, "cut off"),
    Animal("bag_with_an_unreadable_definition", lambda f: _without_definitions(bag(f)), "takes everybody's definition", 0, "", WHOLE),
    Animal("bag_with_an_unknown_type_beside", _other_type, "passes over what it does not need", 0, "", WHOLE),
    Animal("bag_of_version_1.2", _old, "names the version and how to convert it", 2, "version 1.2; only version 2.0"),
    Animal("bag_that_is_encrypted", _encrypted, "says that it is encrypted", 1, "encrypted"),
)  # fmt: skip
