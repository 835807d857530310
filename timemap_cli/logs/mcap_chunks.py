"""Chunks of an MCAP file: their records, and where the messages lie in them."""

from __future__ import annotations

import struct
import zlib

import lz4.frame  # type: ignore[import-untyped]
import numpy as np
import zstandard
from mcap.opcode import Opcode

from timemap_cli.logs.raw import Bytes, Int64s, windows

RECORD_HEAD = struct.Struct("<BQ")  # opcode, length of what follows
MESSAGE_HEAD = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
CHUNK_HEAD = struct.Struct("<QQQI")  # first and last log time, uncompressed size, CRC
MOST_BYTES = 1 << 31  # of a chunk; writers end one after a few MB
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
    _, _, size, crc = CHUNK_HEAD.unpack_from(record, 9)
    (name_length,) = struct.unpack_from("<I", record, 37)
    compression = record[41 : 41 + name_length].decode("ascii", "replace")
    (stored,) = struct.unpack_from("<Q", record, 41 + name_length)
    content = record[49 + name_length : 49 + name_length + stored]
    try:
        if compression == "zstd":
            # As much memory is taken as the frame, or the chunk, claims to hold.
            if zstandard.frame_content_size(content) not in (size, -1, 0) or size > MOST_BYTES:
                raise DamagedChunkError("its length is wrong")
            content = zstandard.ZstdDecompressor().decompress(content, max_output_size=size)
        elif compression == "lz4":
            content = lz4.frame.decompress(content)
        elif compression:
            raise DamagedChunkError(f"its compression {compression!r} is unknown")
    except (zstandard.ZstdError, RuntimeError, ValueError, MemoryError) as error:
        raise DamagedChunkError(f"it cannot be decompressed ({error})") from error
    if len(content) != size:
        raise DamagedChunkError(f"it holds {len(content)} bytes instead of {size}")
    if crc and zlib.crc32(content) != crc:
        raise DamagedChunkError("its checksum is wrong")
    return content


def walk(content: bytes) -> Entries:
    """Messages among the records of a chunk, found by going through them one by one."""
    found: dict[int, tuple[list[int], list[int], list[int]]] = {}
    position = 0
    while position + 9 <= len(content):
        opcode, length = RECORD_HEAD.unpack_from(content, position)
        position += 9
        if position + length > len(content):
            raise DamagedChunkError("a record in it is cut off")
        if opcode == Opcode.MESSAGE and length >= MESSAGE_HEAD.size:
            channel, _, log_ns, _ = MESSAGE_HEAD.unpack_from(content, position)
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
        messages = _listed_messages(data, listed["offset"].astype(np.int64), channel)
        if messages is None:
            return None
        if len(listed):
            entries[channel] = (listed["log_ns"].astype(np.int64), *messages)
        position += 9 + length
    return entries


def _listed_messages(data: Bytes, offsets: Int64s, channel: int) -> tuple[Int64s, Int64s] | None:
    """Start and size of the messages of ``channel`` whose records begin at ``offsets``; None if they do not."""
    head = 9 + MESSAGE_HEAD.size
    if len(offsets) and (offsets.min() < 0 or offsets.max() + head > len(data)):
        return None
    heads = windows(data, offsets, 11)
    sizes = np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0] - MESSAGE_HEAD.size
    channels = np.ascontiguousarray(heads[:, 9:11]).view("<u2")[:, 0]
    starts = offsets + head
    fits = (heads[:, 0] == Opcode.MESSAGE) & (channels == channel)
    fits &= (sizes >= 0) & (sizes <= len(data) - starts)
    return (starts, sizes.astype(np.int64)) if fits.all() else None
