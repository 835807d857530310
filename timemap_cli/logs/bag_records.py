"""The records of a ROS 1 bag (format 2.0): headers, connections, chunks and their index."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import IO

import numpy as np

from timemap_cli.logs.bounds import MOST_CHUNK_BYTES, TooLargeError, decompressed
from timemap_cli.logs.raw import Bytes, Connection, Int64s, ros2_name, windows

MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = 2, 3, 4, 5, 6, 7  # values of a record's op
SECOND_NS = 1_000_000_000
SMALL_BYTES = 1 << 20
LARGEST_FILE = 1 << 62  # no position is beyond
INDEX_ENTRY = np.dtype([("sec", "<u4"), ("nsec", "<u4"), ("offset", "<u4")])

_uint32 = struct.Struct("<I")


class DamagedBagError(Exception):
    """Bytes that are not what the format asks for at this place."""


Fields = dict[str, bytes]
Entries = dict[int, tuple[Int64s, Int64s, Int64s]]  # connection -> log time, start, size of its messages


@dataclass(frozen=True, slots=True)
class Record:
    """A record's header fields, and where its data begins and ends in the file or buffer."""

    fields: Fields
    start: int
    stop: int

    @property
    def op(self) -> int:
        """What kind of record it is; 0 where it does not say."""
        return (self.fields.get("op") or b"\0")[0]

    def number(self, name: str) -> int:
        """An unsigned number in the header; DamagedBagError where it is missing."""
        value = int.from_bytes(self.bytes(name)[:9], "little")
        if value >= 1 << 64:
            raise DamagedBagError(f"a record's {name!r} is no number")
        return value

    def time_ns(self, name: str) -> int:
        """A time in the header [ns]."""
        value = self.number(name)
        return (value & 0xFFFFFFFF) * SECOND_NS + (value >> 32)

    def bytes(self, name: str) -> bytes:
        """A header field; DamagedBagError where it is missing."""
        if name not in self.fields:
            raise DamagedBagError(f"a record has no {name!r}")
        return self.fields[name]


def header_fields(header: bytes) -> Fields:
    """Name and value of each field of a record header."""
    fields: Fields = {}
    position = 0
    while position + 4 <= len(header):
        (length,) = _uint32.unpack_from(header, position)
        position += 4
        name, equals, value = header[position : position + length].partition(b"=")
        if not equals or position + length > len(header):
            raise DamagedBagError("a record header cannot be read")
        fields[name.decode("utf-8", "replace")] = value
        position += length
    return fields


def file_record(file: IO[bytes], position: int) -> Record:
    """The record at this place of the file, its data left where it is; DamagedBagError where there is none."""
    if position >= LARGEST_FILE:
        raise DamagedBagError("it is cut off")
    file.seek(position)
    (header_length,) = _uint32.unpack(_read(file, 4))
    fields = header_fields(_read(file, header_length))
    (length,) = _uint32.unpack(_read(file, 4))
    start = position + 8 + header_length
    return Record(fields, start, start + length)


def _read(file: IO[bytes], length: int) -> bytes:
    if length > MOST_CHUNK_BYTES:
        raise DamagedBagError(f"it is {length} bytes long, more than {MOST_CHUNK_BYTES} are not read")
    if length > SMALL_BYTES:  # so much memory is taken before it turns out that the file ends
        position = file.tell()
        if position + length > file.seek(0, 2):
            raise DamagedBagError("it is cut off")
        file.seek(position)
    data = file.read(length)
    if len(data) < length:
        raise DamagedBagError("it is cut off")
    return data


def record_data(file: IO[bytes], record: Record) -> bytes:
    """The data of a record of the file."""
    file.seek(record.start)
    return _read(file, record.stop - record.start)


def buffer_records(content: bytes) -> Iterator[Record]:
    """The records in a chunk."""
    position = 0
    while position < len(content):
        try:
            (header_length,) = _uint32.unpack_from(content, position)
            start = position + 8 + header_length
            (length,) = _uint32.unpack_from(content, start - 4)
        except struct.error as error:
            raise DamagedBagError("a record in it is cut off") from error
        if start + length > len(content):
            raise DamagedBagError("a record in it is cut off")
        yield Record(header_fields(content[position + 4 : start - 4]), start, start + length)
        position = start + length


def connection(record: Record, data: bytes) -> Connection:
    """The connection that a connection record describes, its count still 0."""
    described = header_fields(data)
    return Connection(
        id=record.number("conn"),
        topic=record.bytes("topic").decode("utf-8", "replace"),
        msgtype=ros2_name(described.get("type", b"").decode("utf-8", "replace")),
        encoding="ros1",
        definition=described.get("message_definition", b"").decode("utf-8", "replace"),
        definition_format="msg",
        count=0,
    )


def chunk_content(record: Record, data: bytes) -> bytes:
    """Uncompressed records of a chunk; DamagedBagError where they cannot be had."""
    content = _unpacked(record, data)
    if len(content) != (size := record.number("size")):
        amount = f"more than {size}" if len(content) > size else f"{len(content)} bytes instead of {size}"
        raise DamagedBagError(f"it holds {amount}")
    return content


def cut_content(record: Record, data: bytes) -> bytes:
    """The whole records at the beginning of a chunk that the end of the file cuts off; none may be whole."""
    return whole_records(_unpacked(record, data))


def _unpacked(record: Record, data: bytes) -> bytes:
    """What a chunk holds, which may be less than it announces, or one byte more."""
    compression = record.bytes("compression").decode("utf-8", "replace")
    if compression not in ("none", "bz2", "lz4"):
        raise DamagedBagError(f"its compression {compression[:20]!r} is unknown")
    try:
        return data if compression == "none" else decompressed(compression, data, record.number("size"))
    except TooLargeError as error:
        raise DamagedBagError(str(error)) from error
    except (OSError, EOFError, ValueError, RuntimeError, MemoryError) as error:
        raise DamagedBagError(f"it cannot be decompressed ({error})") from error


def whole_records(content: bytes) -> bytes:
    """The records at the beginning of a chunk's content that are there to their last byte."""
    stop = 0
    try:
        for record in buffer_records(content):
            stop = record.stop
    except DamagedBagError:
        return content[:stop]
    return content


def walk(content: bytes) -> Entries:
    """Messages among the records of a chunk, found by going through them one by one."""
    found: dict[int, tuple[list[int], list[int], list[int]]] = {}
    for record in buffer_records(content):
        if record.op == MESSAGE:
            times, starts, sizes = found.setdefault(record.number("conn"), ([], [], []))
            times.append(record.time_ns("time"))
            starts.append(record.start)
            sizes.append(record.stop - record.start)
    return {
        key: (np.array(times, np.int64), np.array(starts, np.int64), np.array(sizes, np.int64))
        for key, (times, starts, sizes) in found.items()
    }


def from_index(data: Bytes, index: list[tuple[int, bytes]]) -> Entries | None:
    """Messages of a chunk as (connection, entries) of its index list them; None where that does not fit."""
    entries: Entries = {}
    for key, raw in index:
        listed = np.frombuffer(raw, INDEX_ENTRY)
        if not len(listed):
            continue
        messages = _listed_messages(data, listed["offset"].astype(np.int64), key)
        if messages is None or key in entries:
            return None
        log_ns = listed["sec"].astype(np.int64) * SECOND_NS + listed["nsec"]
        entries[key] = (log_ns, *messages)
    return entries


def _listed_messages(data: Bytes, offsets: Int64s, key: int) -> tuple[Int64s, Int64s] | None:
    """Start and size of the messages of connection ``key`` whose records begin at ``offsets``; None if they do not.

    The headers must all be laid out like the first one: writers do so, but the format does not ask for it.
    """
    if offsets.min() < 0 or offsets.max() + 4 > len(data) or len(np.unique(offsets)) < len(offsets):
        return None
    (header_length,) = _uint32.unpack(data[offsets[0] : offsets[0] + 4].tobytes())
    head = header_length + 8
    if offsets.max() + head > len(data):
        return None
    heads = windows(data, offsets, head)
    first = heads[0, 4:-4].tobytes()
    fields = header_fields(first)
    if (
        fields.get("op") != bytes([MESSAGE])
        or fields.get("conn") != _uint32.pack(key)
        or "time" not in fields
    ):
        return None
    is_time = np.zeros(head - 4, bool)
    time_at = first.index(b"time=") + 4 + len("time=")
    is_time[time_at : time_at + 8] = True
    if not ((heads[:, :-4] == heads[0, :-4]) | is_time).all():
        return None
    sizes = np.ascontiguousarray(heads[:, -4:]).view("<u4")[:, 0].astype(np.int64)
    starts = offsets + head
    return (starts, sizes) if (sizes <= len(data) - starts).all() else None
