"""Reading of ROS 1 bags (format 2.0) down to undecoded messages.

Whole chunks are taken apart at once with their index. A bag without an index, as a crash leaves it behind,
is scanned from the beginning; what comes before the damage is read.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import IO

import numpy as np

from timemap_cli.logs import bag_records as records
from timemap_cli.logs.bag_records import DamagedBagError
from timemap_cli.logs.chunked import ChunkSpan, in_log_order, stretches, with_shortfall, within
from timemap_cli.logs.raw import Connection, RawMessages
from timemap_cli.logs.shared_handles import HANDLES

MAGIC = b"#ROSBAG V2.0\n"


@dataclass(frozen=True, slots=True)
class BagSpan(ChunkSpan):
    """A chunk and the number of messages by connection in it."""

    counts: dict[int, int]
    stop: int | None = None  # where the data of a chunk ends that was never closed: its head does not tell


class BagFile:
    """A ROS 1 bag that is open for reading (a ``Storage``)."""

    format = "ROS 1 bag"

    def __init__(self, path: Path) -> None:
        """Open it and read its index; without one, scan it. Raises OSError or DamagedBagError."""
        self._file: IO[bytes] = HANDLES.open(path)
        self._size = self._file.seek(0, 2)
        self._newest: tuple[int, records.Record, bytes] | None = (
            None  # place and content of the chunk read last
        )
        self.problems: list[str] = []
        self.remarks: list[str] = []
        try:
            header = records.file_record(self._file, len(MAGIC))
            if header.fields.get("encryptor"):
                raise DamagedBagError("it is encrypted")
            try:
                found, self._spans = _read_index(self._file, header)
            except (DamagedBagError, struct.error, ValueError):
                found, self._spans = self._scan(header)
        except BaseException:
            self._file.close()
            raise
        counts: Counter[int] = Counter()
        for span in self._spans:
            counts.update(span.counts)
        if nameless := sum(count for key, count in counts.items() if key not in found):
            self.problems.append(f"{nameless} messages are of no known topic and left out")
        self.connections = tuple(replace(found[key], count=counts[key]) for key in sorted(found))
        self.start_ns = min((span.start_ns for span in self._spans), default=0)
        self.end_ns = max((span.end_ns for span in self._spans), default=0)

    def close(self) -> None:
        """Release the file."""
        self._file.close()

    def stretches(
        self, connections: Collection[int], start_ns: int | None, end_ns: int | None
    ) -> Iterator[list[RawMessages]]:
        """Messages of the connections with these ids, see ``Storage``."""
        wanted = {item.id: item for item in self.connections if item.id in connections}
        spans = [
            span
            for span in self._spans
            if (start_ns is None or span.end_ns >= start_ns)
            and (end_ns is None or span.start_ns < end_ns)
            and not span.counts.keys().isdisjoint(wanted)
        ]
        found = stretches(spans, partial(self._load, wanted=wanted, start_ns=start_ns, end_ns=end_ns))
        is_whole = start_ns is None and end_ns is None
        return with_shortfall(found, wanted.values(), self.problems) if is_whole else found

    def _load(
        self, span: BagSpan, wanted: dict[int, Connection], start_ns: int | None, end_ns: int | None
    ) -> list[RawMessages]:
        """Messages of one chunk; none, and an entry in ``problems``, where it is damaged."""
        try:
            chunk, content = self._content(span)
            data = np.frombuffer(content, np.uint8)
            entries = records.from_index(data, self._index(chunk.stop, len(span.counts)))
            if entries is None or {key: len(entries[key][0]) for key in entries} != span.counts:
                entries = records.walk(self._undamaged(span.offset, content))
        except (DamagedBagError, struct.error) as error:
            self.problems.append(f"the chunk at byte {span.offset} is damaged and left out: {error}")
            return []
        parts = [
            in_log_order(RawMessages(wanted[key], log_ns, data, starts, sizes))
            for key, (log_ns, starts, sizes) in entries.items()
            if key in wanted
        ]
        return [chosen for part in parts if len(chosen := within(part, start_ns, end_ns))]

    def _content(self, span: BagSpan) -> tuple[records.Record, bytes]:
        """A chunk and its uncompressed records; the last one is kept, as a sample asks for one many times."""
        if self._newest is None or self._newest[0] != span.offset:
            self._newest = span.offset, *self._read_content(span)
        return self._newest[1:]

    def _read_content(self, span: BagSpan) -> tuple[records.Record, bytes]:
        chunk = records.file_record(self._file, span.offset)
        if span.stop is None:
            return chunk, self._whole(chunk)
        chunk = replace(chunk, stop=span.stop)
        return chunk, records.record_data(self._file, chunk)

    def _whole(self, chunk: records.Record) -> bytes:
        """Uncompressed records of a chunk; of one that the end of the file cuts off, those that are whole."""
        if chunk.stop <= self._size:
            return records.chunk_content(chunk, records.record_data(self._file, chunk))
        return records.cut_content(chunk, records.record_data(self._file, replace(chunk, stop=self._size)))

    def _index(self, position: int, count: int) -> list[tuple[int, bytes]]:
        """The ``count`` index records behind a chunk, as far as there are so many."""
        index = []
        try:
            for _ in range(count):
                record = records.file_record(self._file, position)
                if record.op != records.INDEX:
                    break
                # Like ROS itself: some writers announce another length than that of the entries.
                stop = record.start + record.number("count") * records.INDEX_ENTRY.itemsize
                data = records.record_data(self._file, replace(record, stop=stop))
                index.append((record.number("conn"), data))
                position = stop
        except (DamagedBagError, struct.error):
            return []
        return index

    def _scan(self, header: records.Record) -> tuple[dict[int, Connection], list[BagSpan]]:
        """Connections and chunks found by going through the file as far as it goes."""
        size = self._size
        found: dict[int, Connection] = {}
        spans: list[BagSpan] = []
        position, chunks, announced = header.stop, 0, 0
        try:
            while position < size:
                record = records.file_record(self._file, position)
                if record.op == records.CHUNK:
                    chunks += 1
                    content = self._scanned(record, position)
                    found |= _connections(content)
                    spans += _walked_span(position, content)
                    if record.stop == record.start and (rest := self._unclosed(record, size)):
                        found |= _connections(rest)
                        spans += _walked_span(position, rest, record.stop + len(rest))
                        self.problems.append(
                            "it was never closed, as after a crash; what was written whole is read"
                        )
                        return found, spans
                elif record.op == records.CONNECTION:
                    one = records.connection(record, records.record_data(self._file, record))
                    found.setdefault(one.id, one)
                elif record.op == records.INDEX:
                    announced += record.number("count")
                elif record.op == records.CHUNK_INFO:
                    break
                if record.stop > size:
                    raise DamagedBagError("it is cut off")
                position = record.stop
        except (DamagedBagError, struct.error):
            self.problems.append(_cut_off(position, size, spans))
        else:
            self._tell_of_index(header, position, spans, chunks)
        self._tell_of_missing(announced - sum(sum(span.counts.values()) for span in spans))
        return found, spans

    def _tell_of_missing(self, messages: int) -> None:
        """Say that messages are missing that the index of their chunks lists, if nothing tells why."""
        if messages > 0 and not self.problems:
            self.problems.append(f"{messages} messages that it announces cannot be found")

    def _tell_of_index(
        self, header: records.Record, position: int, spans: list[BagSpan], chunks: int
    ) -> None:
        """Say that there is no index, and what is missing with it."""
        if _lacks_chunks(header, self._size, chunks):
            self.problems.append(_cut_off(position, self._size, spans))
        elif not spans:
            self.problems.append("it is damaged, and no message is left in it")
        self.remarks.append("its index is missing or damaged, as after a crash; all of it is read")

    def _scanned(self, chunk: records.Record, position: int) -> bytes:
        """The whole records of a chunk; none, and an entry in ``problems``, where it is damaged."""
        try:
            content = self._whole(chunk)
        except DamagedBagError as error:
            if chunk.stop > self._size:
                raise
            self.problems.append(f"the chunk at byte {position} is damaged and left out: {error}")
            return b""
        return self._undamaged(position, content)

    def _undamaged(self, position: int, content: bytes) -> bytes:
        """What comes in a chunk's content before damage, which is told in ``problems``."""
        whole = records.whole_records(content)
        if len(whole) < len(content):
            self.problems.append(f"the chunk at byte {position} is damaged; what comes before in it is read")
        return whole

    def _unclosed(self, chunk: records.Record, size: int) -> bytes:
        """The whole records behind the head of a chunk that was being written; empty where there is no message.

        Compressed ones cannot be told from damage.
        """
        content = records.record_data(self._file, replace(chunk, stop=size))
        stop = 0
        ops = set()
        try:
            for inner in records.buffer_records(content):
                stop = inner.stop
                ops.add(inner.op)
        except DamagedBagError:
            pass
        return content[:stop] if records.MESSAGE in ops else b""


def _lacks_chunks(header: records.Record, size: int, chunks: int) -> bool:
    """Whether a bag ends between two records, in front of where its head says that the index is, and lacks chunks."""
    try:
        return header.number("index_pos") > size and chunks < header.number("chunk_count")
    except DamagedBagError:
        return False


def _cut_off(position: int, size: int, spans: list[BagSpan]) -> str:
    rest = "what comes before is read" if spans else "no message comes whole before that"
    return f"it is cut off at byte {position} of {size}; {rest}"


def _connections(content: bytes) -> dict[int, Connection]:
    """The connections that are described in a chunk."""
    inner = (record for record in records.buffer_records(content) if record.op == records.CONNECTION)
    found = (records.connection(record, content[record.start : record.stop]) for record in inner)
    return {one.id: one for one in found}


def _walked_span(position: int, content: bytes, stop: int | None = None) -> list[BagSpan]:
    """The chunk at ``position`` with the messages found in it; empty where there are none."""
    entries = records.walk(content)
    if not entries:
        return []
    times = np.concatenate([log_ns for log_ns, _, _ in entries.values()])
    counts = {key: len(log_ns) for key, (log_ns, _, _) in entries.items()}
    return [BagSpan(position, int(times.min()), int(times.max()), counts, stop)]


def _read_index(file: IO[bytes], header: records.Record) -> tuple[dict[int, Connection], list[BagSpan]]:
    """Connections and chunks as the index at the end of the bag lists them.

    DamagedBagError where it does not list what stands in front of it.
    """
    index_at = position = header.number("index_pos")
    if header.op != records.BAG_HEADER or position == 0:
        raise DamagedBagError("it has no index")
    found: dict[int, Connection] = {}
    for _ in range(header.number("conn_count")):
        record = records.file_record(file, position)
        one = records.connection(record, records.record_data(file, record))
        found[one.id] = one
        position = record.stop
    spans = []
    for _ in range(header.number("chunk_count")):
        record = records.file_record(file, position)
        counts = dict(struct.iter_unpack("<II", records.record_data(file, record)))
        start_ns, end_ns = record.time_ns("start_time"), record.time_ns("end_time")
        spans.append(BagSpan(record.number("chunk_pos"), start_ns, end_ns, counts))
        position = record.stop
    listed = {span.offset: span.counts for span in spans}
    if listed != dict(_chunks_before(file, header.stop, index_at)) or len(listed) != len(spans):
        raise DamagedBagError("its index does not list its chunks")
    if not all(span.counts.keys() <= found.keys() for span in spans):
        raise DamagedBagError("its index does not list its connections")
    return found, [span for span in spans if any(span.counts.values())]


def _chunks_before(file: IO[bytes], position: int, index_at: int) -> Iterator[tuple[int, dict[int, int]]]:
    """Where each chunk begins and how many messages of each connection are in it, by the heads of the records.

    The data of the chunks is not read.
    """
    while position < index_at:
        chunk = records.file_record(file, position)
        if chunk.op != records.CHUNK:
            raise DamagedBagError("there is no chunk")
        counts: dict[int, int] = {}
        stop = chunk.stop
        while stop < index_at and (record := records.file_record(file, stop)).op == records.INDEX:
            counts[record.number("conn")] = record.number("count")
            stop = record.start + record.number("count") * records.INDEX_ENTRY.itemsize
        yield position, counts
        position = stop
