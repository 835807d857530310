"""What an MCAP file holds and where, as its summary tells."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from io import BytesIO
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, ChunkIndex, Header, Schema
from mcap.summary import Summary

from timemap_cli.logs.chunked import ChunkSpan
from timemap_cli.logs.mcap_chunks import LATEST_NS

FOOTER = struct.Struct("<BQQQI")  # opcode, length, start of the summary, of its offsets, CRC
MAGIC = b"\x89MCAP0\r\n"
MOST_SUMMARY_BYTES = 64 << 20  # a chunk of 1 MB takes a few hundred
BLOCK_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class McapSpan(ChunkSpan):
    """A chunk, or a run of messages outside of chunks (``is_run``), which is read like one."""

    length: int  # of the whole record, or of the run [bytes]
    index_length: int  # of the message index records behind it [bytes]
    channels: frozenset[int] | None  # whose messages are in it, None if unknown
    is_run: bool
    is_cut: bool = False  # a chunk that the end of the file cuts off


@dataclass(frozen=True, slots=True)
class Contents:
    """What a file holds, from its summary or from a scan."""

    schemas: dict[int, Schema]
    channels: dict[int, Channel]
    counts: dict[int, int]  # messages by channel
    spans: list[McapSpan]
    start_ns: int
    end_ns: int
    metadata_names: frozenset[str]
    problems: tuple[str, ...] = ()  # what is damaged
    remarks: tuple[str, ...] = ()  # what is odd and costs nothing


def read_profile(file: IO[bytes]) -> str | None:
    """The profile of the header record; None where that is damaged."""
    file.seek(len(MAGIC))
    head = file.read(BLOCK_BYTES)
    if not head:
        raise ValueError("it is cut off behind its first bytes")
    stream = ReadDataStream(BytesIO(head[9:]))
    try:
        return str(Header.read(stream).profile) if head[0] == Opcode.HEADER else None
    except (McapError, ValueError, struct.error):
        return None


def from_summary(file: IO[bytes]) -> Contents | None:
    """What the summary at the end of the file tells; None where it does not tell all we need."""
    size = file.seek(0, 2)
    if not is_undamaged(file, size):
        return None
    file.seek(0)
    try:
        summary = SeekingReader(file, record_size_limit=MOST_SUMMARY_BYTES).get_summary()
    except (McapError, ValueError, struct.error, OSError):
        return None
    if summary is None or summary.statistics is None or not _is_complete(summary):
        return None
    statistics = summary.statistics
    spans = [_span(index) for index in summary.chunk_indexes]
    if (
        not _lie_apart(spans, size)
        or max(statistics.message_start_time, statistics.message_end_time, *(s.end_ns for s in spans))
        > LATEST_NS
    ):
        return None
    return Contents(
        schemas=summary.schemas,
        channels=summary.channels,
        counts=statistics.channel_message_counts,
        spans=spans,
        start_ns=statistics.message_start_time,
        end_ns=statistics.message_end_time,
        metadata_names=frozenset(index.name for index in summary.metadata_indexes),
    )


def _lie_apart(spans: list[McapSpan], size: int) -> bool:
    """Whether no two chunks share bytes, and all are within the file."""
    stop = len(MAGIC)
    for span in sorted(spans, key=lambda one: one.offset):
        if span.offset < stop:
            return False
        stop = span.offset + span.length + span.index_length
    return stop <= size


def is_undamaged(file: IO[bytes], size: int) -> bool:
    """Whether there is a summary, and its checksum, where it has one, is right."""
    end = size - len(MAGIC) - FOOTER.size
    if end < len(MAGIC):
        return False
    file.seek(end)
    footer = file.read(FOOTER.size)
    opcode, _, begin, _, crc = FOOTER.unpack(footer)
    if opcode != Opcode.FOOTER or not len(MAGIC) <= begin <= end or end - begin > MOST_SUMMARY_BYTES:
        return False
    file.seek(begin)
    summary = file.read(end - begin)
    return not crc or zlib.crc32(footer[:-4], zlib.crc32(summary)) == crc


def _is_complete(summary: Summary) -> bool:
    """Whether every message is in an indexed chunk, and every channel described."""
    statistics = summary.statistics
    indexed = sum(
        (index.message_index_length - 15 * len(index.message_index_offsets)) // 16
        for index in summary.chunk_indexes
    )
    return (
        statistics is not None
        and indexed in (0, statistics.message_count)
        and sum(statistics.channel_message_counts.values()) == statistics.message_count
        and len(summary.chunk_indexes) == statistics.chunk_count
        and (statistics.chunk_count > 0 or statistics.message_count == 0)
        and len(summary.channels) >= statistics.channel_count
        and all(key in summary.channels for key in statistics.channel_message_counts)
        and all(channel.schema_id in {0, *summary.schemas} for channel in summary.channels.values())
    )


def _span(index: ChunkIndex) -> McapSpan:
    return McapSpan(
        offset=index.chunk_start_offset,
        start_ns=index.message_start_time,
        end_ns=index.message_end_time,
        length=index.chunk_length,
        index_length=index.message_index_length,
        channels=frozenset(index.message_index_offsets) or None,
        is_run=False,
    )
