"""What an MCAP file holds, found by going through all of it: for files without a summary, or with a damaged one."""

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
from mcap.records import Channel, DataEnd, Metadata, Schema, Statistics

from timemap_cli.logs.bounds import MOST_CHUNK_BYTES
from timemap_cli.logs.mcap_chunks import (
    LATEST_NS,
    MESSAGE_HEAD,
    RECORD_HEAD,
    DamagedChunkError,
    chunk_content,
    whole_records,
)
from timemap_cli.logs.mcap_contents import BLOCK_BYTES, MAGIC, Contents, McapSpan, is_undamaged

LONGEST_RUN = 4 << 20  # messages outside of chunks are taken together up to this many bytes
FIRST_PRIVATE = 0x80  # opcodes from here on are anybody's, and to be passed over
IN_RUNS = (Opcode.MESSAGE, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA)
IN_DATA = (*IN_RUNS, Opcode.HEADER, Opcode.CHUNK, Opcode.MESSAGE_INDEX, Opcode.ATTACHMENT)
CUT = 0  # stands for the place from which on nothing can be read
ENDS = (Opcode.DATA_END, Opcode.FOOTER, CUT)


def scan(file: IO[bytes]) -> Contents:
    """What the file holds, found by reading all of it as far as it goes."""
    scanned = _Scan(file)
    scanned.read_data()
    scanned.read_summary()
    return scanned.contents()


@dataclass(frozen=True, slots=True)
class _Head:
    """Where a record lies in the file."""

    opcode: int
    begin: int
    end: int


@dataclass(slots=True)
class _Scan:
    """A walk through a file, and what it has found so far."""

    file: IO[bytes]
    size: int = 0
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    counts: Counter[int] = field(default_factory=Counter)
    metadata_names: set[str] = field(default_factory=set)
    spans: list[McapSpan] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    private: int = 0  # records of no known kind
    data_end: int = 0  # where the data section ends; 0 if it does not

    def read_data(self) -> None:
        """Take in the chunks, and the runs of records between them."""
        self.size = self.file.seek(0, 2)
        run: list[bytes] = []
        before = Opcode.HEADER.value
        for head in self._heads():
            joins_run = head.opcode in IN_RUNS
            if run and (not joins_run or sum(map(len, run)) + head.end - head.begin > LONGEST_RUN):
                self._take_run(head.begin, run)
                run = []
            if head.opcode in ENDS:
                self._check_data(head)
                return
            if joins_run and head.end - head.begin <= MOST_CHUNK_BYTES:
                run.append(self._bytes(head.begin, head.end))
            elif head.opcode == Opcode.CHUNK:
                self._take_chunk(head)
            elif not _belongs(head, before):
                self.problems.append(f"the record at byte {head.begin} is damaged and left out")
            self.private += head.opcode >= FIRST_PRIVATE
            before = head.opcode

    def read_summary(self) -> None:
        """Take in what the summary section tells, if it can be trusted: channels, and numbers of messages."""
        if not self.data_end or not is_undamaged(self.file, self.size):
            return
        announced: dict[int, int] = {}
        content = self._bytes(self.data_end, self.size - len(MAGIC))
        for opcode, body in records(content):
            stream = ReadDataStream(BytesIO(body))
            try:
                if opcode == Opcode.SCHEMA:
                    schema = Schema.read(stream)
                    self.schemas.setdefault(schema.id, schema)
                elif opcode == Opcode.CHANNEL:
                    channel = Channel.read(stream)
                    self.channels.setdefault(channel.id, channel)
                elif opcode == Opcode.STATISTICS:
                    announced = Statistics.read(stream).channel_message_counts
            except (McapError, ValueError, struct.error):
                return
        for key, count in announced.items():
            self.counts[key] = max(self.counts[key], count)

    def contents(self) -> Contents:
        """All that was found."""
        nameless = sum(count for key, count in self.counts.items() if key not in self.channels)
        if nameless:
            self.problems.append(f"{nameless} messages are of no known channel and left out")
        remarks = [f"{self.private} records of a private kind are passed over"] if self.private else []
        if self.data_end and self._bytes(self.size - len(MAGIC), self.size) != MAGIC:
            remarks.append("its end is missing, as after a crash; all of it is read")
        return Contents(
            schemas=self.schemas,
            channels=self.channels,
            counts=dict(self.counts),
            spans=self.spans,
            start_ns=min((span.start_ns for span in self.spans), default=0),
            end_ns=max((span.end_ns for span in self.spans), default=0),
            metadata_names=frozenset(self.metadata_names),
            problems=tuple(self.problems),
            remarks=tuple(remarks),
        )

    def _heads(self) -> Iterator[_Head]:
        """The records one after the other, up to the end of the data or to where the file is cut off."""
        position = len(MAGIC)
        while True:
            head = self._bytes(position, position + RECORD_HEAD.size)
            opcode, length = RECORD_HEAD.unpack(head) if len(head) == RECORD_HEAD.size else (0, 0)
            end = position + RECORD_HEAD.size + length
            if opcode == CUT or end > self.size:
                if position == len(MAGIC):
                    raise ValueError("it is cut off or damaged in its first bytes")
                self.problems.append(
                    f"it is cut off at byte {position} of {self.size}; what comes before is read"
                )
                if opcode == Opcode.CHUNK and end < LATEST_NS:
                    self._take_cut_chunk(position)
                yield _Head(CUT, position, position)
                return
            yield _Head(opcode, position, end)
            if opcode in ENDS:
                return
            position = end

    def _bytes(self, begin: int, end: int) -> bytes:
        self.file.seek(begin)
        return self.file.read(end - begin)

    def _take_run(self, end: int, run: list[bytes]) -> None:
        content = b"".join(run)
        self._take(end - len(content), content, len(content), is_run=True)

    def _take_chunk(self, head: _Head) -> None:
        length = head.end - head.begin
        try:
            if length > MOST_CHUNK_BYTES:
                raise DamagedChunkError(
                    f"it is {length} bytes long, more than {MOST_CHUNK_BYTES} are not read"
                )
            content = chunk_content(self._bytes(head.begin, head.end))
        except (DamagedChunkError, struct.error) as error:
            self.problems.append(f"the chunk at byte {head.begin} is damaged and left out: {error}")
        else:
            self._take(head.begin, content, length)

    def _take_cut_chunk(self, begin: int) -> None:
        length = min(self.size - begin, MOST_CHUNK_BYTES)
        self._take(begin, whole_records(self._bytes(begin, begin + length)), length, is_cut=True)

    def _take(
        self, offset: int, content: bytes, length: int, *, is_run: bool = False, is_cut: bool = False
    ) -> None:
        """Take in the records of one chunk, or of one run of records outside of chunks."""
        times: list[int] = []
        channels: set[int] = set()
        for opcode, body in records(content):
            if opcode == Opcode.MESSAGE and len(body) >= MESSAGE_HEAD.size:
                key, _, log_ns, _ = MESSAGE_HEAD.unpack_from(body)
                self.counts[key] += 1
                if log_ns <= LATEST_NS:
                    channels.add(key)
                    times.append(log_ns)
            elif opcode == Opcode.MESSAGE:
                self.problems.append(f"a message behind byte {offset} is damaged and left out")
            else:
                self._describe(opcode, body, offset)
        if times:
            found = frozenset(channels)
            self.spans.append(McapSpan(offset, min(times), max(times), length, 0, found, is_run, is_cut))

    def _describe(self, opcode: int, body: bytes, offset: int) -> None:
        """Take in a record that describes others."""
        stream = ReadDataStream(BytesIO(body))
        try:
            if opcode == Opcode.SCHEMA:
                schema = Schema.read(stream)
                self.schemas[schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = Channel.read(stream)
                self.channels[channel.id] = channel
            elif opcode == Opcode.METADATA:
                self.metadata_names.add(Metadata.read(stream).name)
        except (McapError, ValueError, struct.error):
            name = Opcode(opcode).name.lower()
            self.problems.append(f"a {name} record behind byte {offset} is damaged and left out")

    def _check_data(self, end: _Head) -> None:
        """Compare the checksum over the data, where there is one."""
        if end.opcode != Opcode.DATA_END:
            return
        self.data_end = end.begin
        body = self._bytes(end.begin + RECORD_HEAD.size, end.end)
        if len(body) < 4:
            return
        crc = DataEnd.read(ReadDataStream(BytesIO(body))).data_section_crc
        # Writers disagree whether the first eight bytes are data.
        if crc and crc not in (self._checksum(0, end.begin), self._checksum(len(MAGIC), end.begin)):
            self.problems.append("the checksum over its data is wrong: some of what is read may be damaged")

    def _checksum(self, begin: int, end: int) -> int:
        crc = 0
        for at in range(begin, end, BLOCK_BYTES):
            crc = zlib.crc32(self._bytes(at, min(end, at + BLOCK_BYTES)), crc)
        return crc


def _belongs(head: _Head, before: int) -> bool:
    """Whether a record may stand in the data section, behind the kind that is before it."""
    if head.opcode == Opcode.MESSAGE_INDEX:
        return before in (Opcode.CHUNK, Opcode.MESSAGE_INDEX)
    if head.opcode == Opcode.HEADER:
        return head.begin == len(MAGIC)
    return head.opcode >= FIRST_PRIVATE or (head.opcode in IN_DATA and head.opcode not in IN_RUNS)


def records(content: bytes) -> Iterator[tuple[int, bytes]]:
    """(opcode, body) of the complete records in ``content``."""
    position = 0
    while position + RECORD_HEAD.size <= len(content):
        opcode, length = RECORD_HEAD.unpack_from(content, position)
        position += RECORD_HEAD.size
        if position + length > len(content):
            return
        yield opcode, content[position : position + length]
        position += length
