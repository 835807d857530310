"""Chunks of an MCAP file: their records, and where the messages lie in them."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import zstandard
from mcap.opcode import Opcode
from numpy.typing import NDArray

from timemap_cli.logs.bounds import TooLargeError, decompressed
from timemap_cli.logs.raw import Bytes, Int64s, windows

RECORD_HEAD = struct.Struct("<BQ")  # opcode, length of what follows
MESSAGE_HEAD = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
CHUNK_HEAD = struct.Struct("<QQQI")  # first and last log time, uncompressed size, CRC
LATEST_NS = (1 << 63) - 1  # log times are unsigned in the file; beyond this they are damage
INDEX_ENTRY = np.dtype([("log_ns", "<u8"), ("offset", "<u8")])

Entries = dict[int, tuple[Int64s, Int64s, Int64s]]  # channel -> log time, start, size of its messages


class DamagedChunkError(Exception):
    """A chunk's content is not what the file says it is."""


def chunk_content(record: bytes) -> bytes:
    """Uncompressed records of a chunk record, its head included; DamagedChunkError where they cannot be had."""
    opcode, length = RECORD_HEAD.unpack_from(record)
    if opcode != Opcode.CHUNK:
        raise DamagedChunkError("there is no chunk")
    if len(record) != 9 + length:
        raise DamagedChunkError("it is cut off" if len(record) < 9 + length else "its length is wrong")
    try:
        size, crc, content = _unpacked(record)
    except struct.error as error:
        raise DamagedChunkError("its head is damaged") from error
    if len(content) != size:
        amount = f"more than {size}" if len(content) > size else f"{len(content)} bytes instead of {size}"
        raise DamagedChunkError(f"it holds {amount}")
    if crc and zlib.crc32(content) != crc:
        raise DamagedChunkError("its checksum is wrong")
    return content


def whole_records(record: bytes) -> bytes:
    """The records at the beginning of a chunk record that the end of the file cuts off; none may be whole."""
    try:
        _, _, content = _unpacked(record)
    except (DamagedChunkError, struct.error):
        return b""
    position = 0
    while position + RECORD_HEAD.size <= len(content):
        _, length = RECORD_HEAD.unpack_from(content, position)
        if position + RECORD_HEAD.size + length > len(content):
            break
        position += RECORD_HEAD.size + length
    return content[:position]


def _unpacked(record: bytes) -> tuple[int, int, bytes]:
    """Size and CRC that a chunk record announces, and what it holds, which may be less, or one byte more."""
    _, _, size, crc = CHUNK_HEAD.unpack_from(record, 9)
    (name_length,) = struct.unpack_from("<I", record, 37)
    compression = record[41 : 41 + name_length].decode("ascii", "replace")
    (stored,) = struct.unpack_from("<Q", record, 41 + name_length)
    content = record[49 + name_length : 49 + name_length + stored]
    if compression and compression not in ("zstd", "lz4"):
        raise DamagedChunkError(f"its compression {compression[:20]!r} is unknown")
    try:
        return size, crc, decompressed(compression, content, size) if compression else content
    except TooLargeError as error:
        raise DamagedChunkError(str(error)) from error
    except (zstandard.ZstdError, RuntimeError, ValueError, EOFError, MemoryError) as error:
        raise DamagedChunkError(f"it cannot be decompressed ({error})") from error


def walk(content: bytes) -> Entries:
    """Messages among the records of a chunk, found by going through them one by one.

    A log time that no clock shows is damage: its message is passed over, and will be missing.
    """
    found: dict[int, tuple[list[int], list[int], list[int]]] = {}
    position = 0
    while position + 9 <= len(content):
        opcode, length = RECORD_HEAD.unpack_from(content, position)
        position += 9
        if position + length > len(content):
            raise DamagedChunkError("a record in it is cut off")
        if opcode == Opcode.MESSAGE and length >= MESSAGE_HEAD.size:
            channel, _, log_ns, _ = MESSAGE_HEAD.unpack_from(content, position)
            if log_ns <= LATEST_NS:
                times, starts, sizes = found.setdefault(channel, ([], [], []))
                times.append(log_ns)
                starts.append(position + MESSAGE_HEAD.size)
                sizes.append(length - MESSAGE_HEAD.size)
        position += length
    return {
        channel: (np.array(times, np.int64), np.array(starts, np.int64), np.array(sizes, np.int64))
        for channel, (times, starts, sizes) in found.items()
    }


def from_index(data: Bytes, index: bytes) -> Entries | None:
    """Messages of a chunk as the message index behind it lists them; None where that does not fit."""
    entries: Entries = {}
    position = 0
    while position + 15 <= len(index):
        opcode, length = RECORD_HEAD.unpack_from(index, position)
        channel, n_bytes = struct.unpack_from("<HI", index, position + 9)
        if opcode != Opcode.MESSAGE_INDEX or n_bytes + 6 > length or position + 15 + n_bytes > len(index):
            return None
        listed = np.frombuffer(index, INDEX_ENTRY, n_bytes // INDEX_ENTRY.itemsize, position + 15)
        messages = _listed_messages(data, listed, channel)
        if messages is None:
            return None
        if len(listed):
            entries[channel] = (listed["log_ns"].astype(np.int64), *messages)
        position += 9 + length
    return entries if position == len(index) else None


def _listed_messages(data: Bytes, listed: NDArray[np.void], channel: int) -> tuple[Int64s, Int64s] | None:
    """Start and size of the messages of ``channel`` at these index entries; None if they are not there.

    No checksum covers the index, but one covers the messages: theirs are the times that count.
    """
    head = 9 + MESSAGE_HEAD.size
    offsets = listed["offset"].astype(np.int64)
    if len(offsets) and (offsets.min() < 0 or offsets.max() + head > len(data)):
        return None
    heads = windows(data, offsets, 23)
    sizes = np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0] - MESSAGE_HEAD.size
    channels = np.ascontiguousarray(heads[:, 9:11]).view("<u2")[:, 0]
    times = np.ascontiguousarray(heads[:, 15:23]).view("<u8")[:, 0]
    starts = offsets + head
    fits = (heads[:, 0] == Opcode.MESSAGE) & (channels == channel) & (times == listed["log_ns"])
    fits &= (sizes >= 0) & (sizes <= len(data) - starts) & (times <= LATEST_NS)
    return (starts, sizes.astype(np.int64)) if fits.all() else None
