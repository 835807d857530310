"""Reading of rosbag2's SQLite files (.db3) down to undecoded messages.

rosbags knows the tables of all versions. The messages are read here: where SQLite refuses a damaged database, what
its whole pages hold is read without it.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from pathlib import Path
from urllib.parse import quote

import apsw
from rosbags.interfaces import Connection as RosbagsConnection
from rosbags.interfaces import ConnectionExtRosbag2, MessageDefinitionFormat
from rosbags.rosbag2 import ReaderError
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

from timemap_cli.logs.chunked import with_shortfall
from timemap_cli.logs.raw import Connection, RawMessages, from_messages, ros2_name
from timemap_cli.logs.sqlite_rescue import Rescue

MOST_MESSAGES = 2048  # in one stretch
MOST_BYTES = 4 << 20
FIRST_NS, LAST_NS = -(2**63), 2**63 - 1
DEFINITION_FORMATS = {MessageDefinitionFormat.MSG: "msg", MessageDefinitionFormat.IDL: "idl"}
# What rosbags raises about a database whose tables hold something else than it expects.
REFUSALS = (ReaderError, apsw.Error, AssertionError, KeyError, TypeError, ValueError)

Message = tuple[int, int, int, bytes]  # id, topic, log time [ns], content


class SqliteFile:
    """A rosbag2 database that is open for reading (a ``Storage``)."""

    format = "ROS 2 sqlite3"

    def __init__(self, path: Path) -> None:
        """Open it; where it is damaged, look through its pages. Raises what ``Rescue`` raises."""
        self._path = path
        self._rescue: Rescue | None = None
        self.remarks: list[str] = []
        self.problems: list[str] = []
        reader = Sqlite3Reader(Path(_in_uri(path)))  # it puts the path into a URI as it is
        try:
            reader.open()
            self._read_head(reader)
        except REFUSALS:
            rescue = self._rescued()
            self.connections = rescue.connections
            self.start_ns, self.end_ns = rescue.start_ns, rescue.end_ns
        finally:
            if reader.dbconn:
                reader.close()
        journal = path.with_name(f"{path.name}-wal")
        if journal.exists() and journal.stat().st_size:
            self.problems.append(
                f"it was not closed when recording ended; the messages in {journal.name} are not read"
            )

    def close(self) -> None:
        """Release the file."""
        if self._rescue is not None:
            self._rescue.close()

    def stretches(
        self, connections: Collection[int], start_ns: int | None, end_ns: int | None
    ) -> Iterator[list[RawMessages]]:
        """Messages of the connections with these ids, see ``Storage``."""
        wanted = {item.id: item for item in self.connections if item.id in connections}
        span = FIRST_NS if start_ns is None else start_ns, LAST_NS if end_ns is None else end_ns
        found = self._stretches(wanted, *span)
        is_whole = start_ns is None and end_ns is None
        return with_shortfall(found, wanted.values(), self.problems) if is_whole else found

    def _read_head(self, reader: Sqlite3Reader) -> None:
        """Take over what rosbags found; ValueError where its numbers do not agree."""
        self.connections = tuple(map(_connection, reader.connections))
        metadata = reader.metadata
        # The one number comes from the table, the other from its index.
        if metadata.message_count != sum(one.count for one in self.connections):
            raise ValueError("the table and its index differ")
        if metadata.message_count and not 0 <= metadata.start_time < metadata.end_time <= LAST_NS:
            raise ValueError("a time is none")
        self.start_ns = metadata.start_time if metadata.message_count else 0
        self.end_ns = metadata.end_time - 1 if metadata.message_count else 0

    def _rescued(self) -> Rescue:
        if self._rescue is None:
            self._rescue = Rescue(self._path)
            missing = f", {self._rescue.missing} messages are not" if self._rescue.missing > 0 else ""
            self.problems.append(f"the database is damaged; what its whole pages hold is read{missing}")
        return self._rescue

    def _stretches(
        self, wanted: dict[int, Connection], start_ns: int, end_ns: int
    ) -> Iterator[list[RawMessages]]:
        found: dict[int, tuple[list[int], list[bytes]]] = {}
        n_messages = n_bytes = 0
        for _, topic, log_ns, raw in self._messages(wanted, start_ns, end_ns):
            times, contents = found.setdefault(topic, ([], []))
            times.append(log_ns)
            contents.append(raw)
            n_messages += 1
            n_bytes += len(raw)
            if n_messages >= MOST_MESSAGES or n_bytes >= MOST_BYTES:
                yield [from_messages(wanted[key], *found[key]) for key in sorted(found)]
                found, n_messages, n_bytes = {}, 0, 0
        if found:
            yield [from_messages(wanted[key], *found[key]) for key in sorted(found)]

    def _messages(self, wanted: Collection[int], start_ns: int, end_ns: int) -> Iterator[Message]:
        """Messages in order of log time and id; from the first damage on by what the pages hold."""
        last = FIRST_NS, FIRST_NS
        try:
            for message in self._queried(wanted, start_ns, end_ns) if self._rescue is None else ():
                last = message[2], message[0]
                yield message
        except (apsw.Error, TypeError, ValueError):
            self._rescued()
        if self._rescue is not None:
            yield from self._rescue.messages(wanted, start_ns, end_ns, last)

    def _queried(self, wanted: Collection[int], start_ns: int, end_ns: int) -> Iterator[Message]:
        places = ",".join("?" for _ in wanted)
        database = apsw.Connection(
            f"file:{_in_uri(self._path)}?immutable=1", flags=apsw.SQLITE_OPEN_READONLY | apsw.SQLITE_OPEN_URI
        )
        try:
            for key, topic, log_ns, raw in database.execute(
                f"SELECT id, topic_id, timestamp, data FROM messages WHERE topic_id IN ({places}) "
                "AND timestamp >= ? AND timestamp < ? ORDER BY timestamp, id",
                (*wanted, start_ns, end_ns),
            ):
                if not (isinstance(log_ns, int) and isinstance(raw, bytes)):
                    raise ValueError("a row holds something else than a message")
                yield key, topic, log_ns, raw
        finally:
            database.close()


def _in_uri(path: Path) -> str:
    """A path as part of a URI, in which `?`, `#` and `%` mean something else, and bytes that are no UTF-8 nothing."""
    return quote(os.fsencode(path))


def _connection(connection: RosbagsConnection) -> Connection:
    assert isinstance(connection.ext, ConnectionExtRosbag2)
    return Connection(
        id=connection.id,
        topic=connection.topic,
        msgtype=ros2_name(connection.msgtype),
        encoding=connection.ext.serialization_format,
        definition=connection.msgdef.data,
        definition_format=DEFINITION_FORMATS.get(connection.msgdef.format, ""),
        count=connection.msgcount,
    )
