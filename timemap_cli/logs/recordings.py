"""Recordings: opened whatever their format, and read as batches."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from timemap_cli.errors import UsageError
from timemap_cli.logs.batches import BadBatch, Batch
from timemap_cli.logs.block_decoding import UNDECODABLE
from timemap_cli.logs.decode import decode
from timemap_cli.logs.files import open_files
from timemap_cli.logs.foreign_errors import translated
from timemap_cli.logs.message_types import MESSAGE_TYPES, DecoderCache, is_read
from timemap_cli.logs.parts import stretches_of_all
from timemap_cli.logs.raw import Connection


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic of a recording, the type of its messages (``sensor_msgs/msg/LaserScan``) and their number."""

    name: str
    msgtype: str
    count: int


class Recording:
    """A recording that is open for reading; close it, or use it in a ``with``.

    ``start_ns``, ``end_ns``: log times of the first and the last message, both 0 where there is none.
    ``topics`` are in order of name. ``problems`` are sentences about data that is damaged or missing;
    reading may add to them. ``remarks`` are about what is odd and costs no data. ``unusable`` holds the topics of which
    some messages read so far gave nothing, and why.
    """

    def __init__(self, path: Path) -> None:
        """Open the recording at ``path``, a file or a folder.

        Raises UsageError where there is none, or a result of ours; TimemapError where it cannot be read.
        """
        self.path = path
        self._files = ExitStack()
        try:
            with translated(path):
                self._opened = open_files(path, self._files)
        except BaseException:
            self._files.close()
            raise
        self._storages = self._opened.storages
        self._damage: list[str] = []  # messages that cannot be decoded
        self.unusable: set[tuple[str, str]] = set()
        self._decoders = DecoderCache()
        self.format = self._storages[0].format
        filled = [storage for storage in self._storages if any(one.count for one in storage.connections)]
        self.start_ns = min((storage.start_ns for storage in filled), default=0)
        self.end_ns = max((storage.end_ns for storage in filled), default=0)
        connections = [connection for storage in self._storages for connection in storage.connections]
        readable = {connection.topic for connection in connections if is_read(connection)}
        counts: Counter[tuple[str, str]] = Counter()
        for one in connections:
            # Beside messages that are read, others on the same topic do not count.
            if is_read(one) or one.topic not in readable:
                counts[one.topic, _kind(one)] += one.count
        self.topics = tuple(Topic(name, msgtype, counts[name, msgtype]) for name, msgtype in sorted(counts))

    @property
    def problems(self) -> tuple[str, ...]:
        """What is damaged or missing, as far as it has been noticed."""
        of_files = [problem for storage in self._storages for problem in storage.problems]
        return tuple(dict.fromkeys([*self._opened.problems, *of_files, *self._damage]))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is odd, while all data is there."""
        return (*self._opened.remarks, *(remark for storage in self._storages for remark in storage.remarks))

    def batches(
        self, topics: Collection[str], *, start_ns: int | None = None, end_ns: int | None = None
    ) -> Iterator[list[Batch]]:
        """Messages of these topics with ``start_ns <= log time < end_ns``, decoded.

        Each list covers the next stretch of log time, of a few MB. A topic that is not in this recording
        gives nothing. Raises TimemapError where a topic's type or encoding is none that is read.
        """
        for topic in self.topics:
            if topic.name in topics and topic.msgtype not in MESSAGE_TYPES:
                content = topic.msgtype or "untyped messages"
                raise UsageError(f"{topic.name} in {self.path} holds {content}, which cannot be used")
        bad: Counter[str] = Counter()
        with translated(self.path):
            for parts in stretches_of_all(self._storages, topics, start_ns, end_ns):
                batches = decode(parts, self._decoders)
                for batch in batches:
                    if isinstance(batch, BadBatch):
                        self.unusable.add((batch.topic, batch.reason))
                        bad[batch.topic] += batch.count if batch.reason == UNDECODABLE else 0
                yield batches
        if start_ns is None and end_ns is None:
            self._damage += [
                f"{count} messages of {topic} are damaged and left out"
                for topic, count in bad.items()
                if count
            ]

    def close(self) -> None:
        """Release the files."""
        self._files.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _kind(connection: Connection) -> str:
    """The type of the messages, and their encoding where it is none that is read."""
    if connection.msgtype in MESSAGE_TYPES and not is_read(connection):
        return f"{connection.msgtype} in {connection.encoding or 'no encoding'}"
    return connection.msgtype


def open_recordings(paths: Sequence[Path]) -> list[Recording]:
    """The recordings at these paths, ordered by start time; the caller closes them.

    Raises what ``Recording`` raises, and UsageError where one is given twice; then none is left open.
    """
    recordings: list[Recording] = []
    places: set[Path] = set()
    try:
        for path in paths:
            place = path.resolve()
            if place in places:
                raise UsageError(f"{path} is given twice", hint="name each recording once")
            places.add(place)
            recordings.append(Recording(path))
    except BaseException:
        for recording in recordings:
            recording.close()
        raise
    return sorted(recordings, key=lambda recording: recording.start_ns)
