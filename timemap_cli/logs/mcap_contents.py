"""What an MCAP file holds and where: from its summary, or from a scan of the whole file where there is none."""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, ChunkIndex, Header, Metadata, Schema
from mcap.summary import Summary

from timemap_cli.logs.chunked import ChunkSpan
from timemap_cli.logs.mcap_chunks import MESSAGE_HEAD, RECORD_HEAD, DamagedChunkError, chunk_content

FOOTER = struct.Struct("<BQQQI")  # opcode, length, start of the summary, of its offsets, CRC
MAGIC = b"\x89MCAP0\r\n"
LONGEST_RUN = 4 << 20  # messages outside of chunks are taken together up to this many bytes


@dataclass(frozen=True, slots=True)
class McapSpan(ChunkSpan):
    """A chunk, or a run of messages outside of chunks (``is_run``), which is read like one."""

    length: int  # of the whole record, or of the run [bytes]
    index_length: int  # of the message index records behind it [bytes]
    channels: frozenset[int] | None  # whose messages are in it, None if unknown
    is_run: bool


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
    problem: str | None


def read_profile(file: IO[bytes]) -> str:
    """The profile of the header record."""
    stream = ReadDataStream(file)
    if file.read(len(MAGIC)) != MAGIC or stream.read1() != Opcode.HEADER:
        raise ValueError("it does not begin like an MCAP file")
    stream.read8()
    return str(Header.read(stream).profile)


def from_summary(file: IO[bytes]) -> Contents | None:
    """What the summary at the end of the file tells; None where it does not tell all we need."""
    size = file.seek(0, 2)
    if not _is_undamaged(file, size):
        return None
    file.seek(0)
    try:
        summary = SeekingReader(file, record_size_limit=size).get_summary()
    except (McapError, ValueError, struct.error, OSError):
        return None
    if summary is None or summary.statistics is None or not _is_complete(summary):
        return None
    statistics = summary.statistics
    spans = [_span(index) for index in summary.chunk_indexes]
    if any(span.offset + span.length + span.index_length > size for span in spans):
        return None
    return Contents(
        schemas=summary.schemas,
        channels=summary.channels,
        counts=statistics.channel_message_counts,
        spans=spans,
        start_ns=statistics.message_start_time,
        end_ns=statistics.message_end_time,
        metadata_names=frozenset(index.name for index in summary.metadata_indexes),
        problem=None,
    )


def _is_undamaged(file: IO[bytes], size: int) -> bool:
    """Whether there is a summary, and its checksum, where it has one, is right."""
    end = size - len(MAGIC) - FOOTER.size
    if end < len(MAGIC):
        return False
    file.seek(end)
    footer = file.read(FOOTER.size)
    opcode, _, begin, _, crc = FOOTER.unpack(footer)
    if opcode != Opcode.FOOTER or not len(MAGIC) <= begin <= end:
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


@dataclass(slots=True)
class _Tally:
    """What a scan has found so far."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    counts: Counter[int] = field(default_factory=Counter)
    metadata_names: set[str] = field(default_factory=set)
    spans: list[McapSpan] = field(default_factory=list)
    problem: str | None = None

    def add_span(self, offset: int, content: bytes, length: int, is_run: bool) -> None:
        """Take in the records of one chunk, or of one run of records outside of chunks."""
        times: list[int] = []
        channels: set[int] = set()
        for opcode, body in _records(content):
            if opcode == Opcode.SCHEMA:
                schema = Schema.read(ReadDataStream(BytesIO(body)))
                self.schemas[schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = Channel.read(ReadDataStream(BytesIO(body)))
                self.channels[channel.id] = channel
            elif opcode == Opcode.METADATA:
                self.metadata_names.add(Metadata.read(ReadDataStream(BytesIO(body))).name)
            elif opcode == Opcode.MESSAGE and len(body) >= MESSAGE_HEAD.size:
                key, _, log_ns, _ = MESSAGE_HEAD.unpack_from(body)
                channels.add(key)
                self.counts[key] += 1
                times.append(log_ns)
        if times:
            found = frozenset(channels)
            self.spans.append(McapSpan(offset, min(times), max(times), length, 0, found, is_run))


def scan(file: IO[bytes]) -> Contents:
    """What the file holds, found by reading all of it as far as it goes."""
    tally = _Tally()
    for offset, content, length, is_run in _scanned_spans(file, tally):
        tally.add_span(offset, content, length, is_run)
    return Contents(
        schemas=tally.schemas,
        channels=tally.channels,
        counts=dict(tally.counts),
        spans=tally.spans,
        start_ns=min((span.start_ns for span in tally.spans), default=0),
        end_ns=max((span.end_ns for span in tally.spans), default=0),
        metadata_names=frozenset(tally.metadata_names),
        problem=tally.problem,
    )


def _scanned_spans(file: IO[bytes], tally: _Tally) -> Iterator[tuple[int, bytes, int, bool]]:
    """(offset, records, length in the file, whether it is a run) of chunks, and of runs of records between them."""
    size = file.seek(0, 2)
    position = len(MAGIC)
    run: list[bytes] = []
    while True:
        file.seek(position)
        head = file.read(RECORD_HEAD.size)
        opcode, length = RECORD_HEAD.unpack(head) if len(head) == RECORD_HEAD.size else (0, 0)
        end = position + RECORD_HEAD.size + length
        is_over = opcode in (0, Opcode.DATA_END, Opcode.FOOTER) or end > size
        joins_run = not is_over and opcode in (Opcode.MESSAGE, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA)
        if run and (not joins_run or sum(map(len, run)) + end - position > LONGEST_RUN):
            content = b"".join(run)
            yield position - len(content), content, len(content), True
            run = []
        if is_over:
            if opcode not in (Opcode.DATA_END, Opcode.FOOTER):
                tally.problem = f"it is cut off at byte {position} of {size}; what comes before is read"
            return
        if joins_run:
            run.append(head + file.read(length))
        elif opcode == Opcode.CHUNK:
            try:
                yield position, chunk_content(head + file.read(length)), end - position, False
            except DamagedChunkError as error:
                tally.problem = f"the chunk at byte {position} is damaged and left out: {error}"
        position = end


def _records(content: bytes) -> Iterator[tuple[int, bytes]]:
    """(opcode, body) of the complete records in ``content``."""
    position = 0
    while position + RECORD_HEAD.size <= len(content):
        opcode, length = RECORD_HEAD.unpack_from(content, position)
        position += RECORD_HEAD.size
        if position + length > len(content):
            return
        yield opcode, content[position : position + length]
        position += length
