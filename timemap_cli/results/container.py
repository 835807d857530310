"""The MCAP container of a result: opening it, its records, and the messages of one topic."""

import io
import struct
from collections.abc import Callable, Collection, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self, TypeVar

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Attachment, Chunk, ChunkIndex, McapRecord, Metadata
from mcap.stream_reader import CRCValidationError, StreamReader, get_chunk_data_stream
from mcap.summary import Summary
from zstandard import ZstdError, frame_content_size

from timemap_cli.errors import TimemapError, UsageError, no_such_file, refuse_pipe
from timemap_cli.results import channels

_MOST_BYTES = (
    1 << 28
)  # of a chunk, unpacked: the largest messages, points of 10,000 nodes, are a quarter of it
_MAGIC = b"\x89MCAP0\r\n"
_RECORDINGS = (_MAGIC, b"#ROSBAG", b"SQLite format 3\x00")
_RECORD = struct.Struct("<BQ")  # opcode, length of what follows
_FOOTER = struct.Struct("<BQQQI")  # opcode, length, start of the summary and of its offsets, checksum
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
_T = TypeVar("_T")

# What mcap and the decompressors raise when they are given anything else than a whole file.
_DAMAGE = (
    McapError,
    StopIteration,
    ZstdError,
    EOFError,
    ValueError,
    KeyError,
    RuntimeError,
    MemoryError,
    struct.error,
)


class ResultFile:
    """A result opened for reading.

    Raises UsageError if there is no such file, or if it is a recording or anything else than a result;
    TimemapError where it is damaged, then or at any later call.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._stream = _open(path)
        try:
            self._reader = SeekingReader(self._stream, validate_crcs=True)
            self._summary = self._read_summary()
            self.metadata = self._read_metadata()
        except BaseException:
            self._stream.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    @property
    def span_ns(self) -> tuple[int, int]:
        """Log time of the first and the last message."""
        statistics = self._summary.statistics or self._read_summary().statistics
        return (statistics.message_start_time, statistics.message_end_time) if statistics else (0, 0)

    def attachment(self, name: str) -> str:
        """Text of an attachment."""
        for index in self._summary.attachment_indexes:
            if index.name == name:
                found = self._record(index.offset)
                if isinstance(found, Attachment) and found.name == name:
                    return self._guarded(found.data.decode)
                raise self._damaged("its records do not fit together")
        raise self._damaged(f"{name} is missing")

    def messages(self, topics: Collection[str], until_ns: int | None = None) -> Iterator[tuple[str, bytes]]:
        """Topic and bytes of the messages of some topics, as written, up to and including a log time."""
        wanted = self._channels_of(topics)
        end_ns = self.span_ns[1] if until_ns is None else until_ns
        for chunk in self._chunks_with(wanted):
            if chunk.message_start_time <= end_ns:
                yield from ((topic, data) for topic, _, data in self._messages_of(chunk, wanted, end_ns))

    def count(self, topic: str) -> int:
        """How many messages a topic has."""
        counts = self._summary.statistics.channel_message_counts if self._summary.statistics else {}
        return sum(counts.get(channel, 0) for channel in self._channels_of([topic]))

    def times_ns(self, topic: str) -> tuple[int, ...]:
        """Log times of the messages of a topic, in order."""
        wanted, end_ns = self._channels_of([topic]), self.span_ns[1]
        found = (self._messages_of(chunk, wanted, end_ns) for chunk in self._chunks_with(wanted))
        return tuple(log_ns for some in found for _, log_ns, _ in some)

    def last_message(self, topic: str) -> bytes | None:
        """The last message of a topic, found from the end of the file; None if there is none."""
        wanted = self._channels_of([topic])
        for chunk in reversed(self._chunks_with(wanted)):
            if found := self._messages_of(chunk, wanted, self.span_ns[1]):
                return found[-1][2]
        return None

    def _channels_of(self, topics: Collection[str]) -> dict[int, str]:
        return {c.id: c.topic for c in self._summary.channels.values() if c.topic in topics}

    def _chunks_with(self, wanted: Mapping[int, str]) -> list[ChunkIndex]:
        """Chunks that hold a message of one of these channels, or do not tell, in the order of writing."""
        chunks = sorted(self._summary.chunk_indexes, key=lambda c: c.chunk_start_offset)
        if any(
            one.chunk_start_offset + one.chunk_length > two.chunk_start_offset
            for one, two in pairwise(chunks)
        ):
            # A small file could list one chunk a million times.
            raise self._damaged("its records do not fit together")
        return [c for c in chunks if not c.message_index_offsets or wanted.keys() & c.message_index_offsets]

    def _messages_of(
        self, index: ChunkIndex, wanted: Mapping[int, str], end_ns: int
    ) -> list[tuple[str, int, bytes]]:
        return self._guarded(lambda: list(_messages(self._load(index), wanted, end_ns)))

    def _load(self, index: ChunkIndex) -> bytes:
        """A chunk, unpacked and checked."""
        self._stream.seek(index.chunk_start_offset + _RECORD.size)
        chunk = Chunk.read(ReadDataStream(self._stream))
        # The frame's own claim counts for the memory that is taken; -1 where it makes none.
        claimed = frame_content_size(chunk.data) if chunk.compression == "zstd" else len(chunk.data)
        if max(claimed, chunk.uncompressed_size) > _MOST_BYTES:
            raise ValueError("a chunk that no replay writes")
        data, size = get_chunk_data_stream(chunk, validate_crc=True)
        return data.read(size)

    def _read_summary(self) -> Summary:
        self._guarded(lambda: _require_no_chunks(self._stream))
        summary = self._guarded(self._reader.get_summary)
        if summary is None or summary.statistics is None:
            raise self._damaged("its end is missing")
        return summary

    def _read_metadata(self) -> dict[str, str]:
        for index in self._summary.metadata_indexes:
            if index.name == channels.METADATA:
                found = self._record(index.offset)
                if isinstance(found, Metadata) and found.name == index.name:
                    return dict(found.metadata)
                raise self._damaged("its metadata is missing")
        raise _not_a_result(self.path, recording=True)

    def _record(self, offset: int) -> McapRecord:
        """The record at a place of the file."""

        def read() -> McapRecord:
            self._stream.seek(offset)
            reader = StreamReader(
                self._stream, skip_magic=True, emit_chunks=True, record_size_limit=_MOST_BYTES
            )
            return next(reader.records)

        return self._guarded(read)

    def _guarded(self, read: Callable[[], _T]) -> _T:
        """Call something that reads, and say in our words what goes wrong."""
        try:
            return read()
        except CRCValidationError as error:
            raise self._damaged("a checksum does not match") from error
        except _DAMAGE as error:
            raise self._damaged("its records do not fit together") from error
        except OSError as error:
            raise _unreadable(self.path, error) from error

    def _damaged(self, reason: str) -> TimemapError:
        return TimemapError(
            f"{self.path} is damaged: {reason}", hint="make it again with `timemap replay`, or copy it again"
        )


def is_result(path: Path) -> bool:
    """Whether there is a result, as far as its own metadata tells; damaged ones are none."""
    if not path.is_file():  # opening a pipe would wait for somebody to write
        return False
    try:
        ResultFile(path).close()
    except TimemapError:
        return False
    return True


def _require_no_chunks(stream: BinaryIO) -> None:
    """ValueError where the summary holds a chunk: the reader would unpack it, whatever its size."""
    end = stream.seek(-_FOOTER.size - len(_MAGIC), io.SEEK_END)
    opcode, _, place, _, _ = _FOOTER.unpack(stream.read(_FOOTER.size))
    while opcode == Opcode.FOOTER and 0 < place < end:
        stream.seek(place)
        kind, length = _RECORD.unpack(stream.read(_RECORD.size))
        if kind == Opcode.CHUNK:
            raise ValueError("a chunk in the summary")
        place += _RECORD.size + length


def _messages(chunk: bytes, wanted: Mapping[int, str], end_ns: int) -> Iterator[tuple[str, int, bytes]]:
    """Topic, log time and bytes of the messages of some channels in an unpacked chunk, from record to record."""
    place = 0
    while place < len(chunk):
        opcode, length = _RECORD.unpack_from(chunk, place)
        place += _RECORD.size
        if opcode == Opcode.MESSAGE:
            channel, _, log_ns, _ = _MESSAGE.unpack_from(chunk, place)
            if channel in wanted and log_ns <= end_ns:
                yield wanted[channel], log_ns, chunk[place + _MESSAGE.size : place + length]
        place += length


def _open(path: Path) -> BinaryIO:
    refuse_pipe(path)
    if path.is_dir():
        raise _not_a_result(path, recording=(path / "metadata.yaml").exists())
    try:
        stream = path.open("rb")
    except FileNotFoundError as error:
        raise no_such_file(path, "results are made by `timemap replay`") from error
    except OSError as error:
        raise _unreadable(path, error) from error
    head = stream.read(16)
    stream.seek(0)
    if not head.startswith(_MAGIC):
        stream.close()
        raise _not_a_result(path, recording=head.startswith(_RECORDINGS))
    return stream


def _unreadable(path: Path, error: OSError) -> TimemapError:
    return TimemapError(f"cannot read {path}: {(error.strerror or str(error)).lower()}")


def _not_a_result(path: Path, *, recording: bool) -> UsageError:
    if recording:
        return UsageError(
            f"{path} is a recording, not a result of timemap", hint=f"to make one: timemap replay {path}"
        )
    return UsageError(f"{path} is not a result of timemap", hint="results are made by `timemap replay`")
