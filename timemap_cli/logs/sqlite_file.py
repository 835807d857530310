"""Reading of rosbag2's SQLite files (.db3) down to undecoded messages, through rosbags."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path

import apsw  # comes with rosbags
from rosbags.interfaces import Connection as RosbagsConnection
from rosbags.interfaces import ConnectionExtRosbag2, MessageDefinitionFormat
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

from timemap_cli.logs.raw import Connection, RawMessages, from_messages, ros2_name

MOST_MESSAGES = 2048  # in one stretch
MOST_BYTES = 4 << 20
DEFINITION_FORMATS = {MessageDefinitionFormat.MSG: "msg", MessageDefinitionFormat.IDL: "idl"}


class SqliteFile:
    """A rosbag2 database that is open for reading (a ``Storage``)."""

    format = "ROS 2 sqlite3"

    def __init__(self, path: Path) -> None:
        """Open it; raises what rosbags raises."""
        self._reader = Sqlite3Reader(path)
        self._reader.open()
        self._rosbags_connections = {connection.id: connection for connection in self._reader.connections}
        self.connections = tuple(map(_connection, self._reader.connections))
        metadata = self._reader.metadata
        self.start_ns = metadata.start_time if metadata.message_count else 0
        self.end_ns = metadata.end_time - 1 if metadata.message_count else 0
        self.remarks: list[str] = []
        self.problems: list[str] = []
        journal = path.with_name(f"{path.name}-wal")
        if journal.exists() and journal.stat().st_size:
            self.problems.append(
                f"it was not closed when recording ended; the messages in {journal.name} are not read"
            )

    def close(self) -> None:
        """Release the file."""
        self._reader.close()

    def stretches(
        self, connections: Collection[int], start_ns: int | None, end_ns: int | None
    ) -> Iterator[list[RawMessages]]:
        """Messages of the connections with these ids, see ``Storage``."""
        own = {connection.id: connection for connection in self.connections}
        wanted = [self._rosbags_connections[key] for key in own if key in connections]
        found: dict[int, tuple[list[int], list[bytes]]] = {}
        n_messages = n_bytes = 0
        for connection, log_ns, raw in self._messages(wanted, start_ns, end_ns):
            times, contents = found.setdefault(connection.id, ([], []))
            times.append(log_ns)
            contents.append(raw)
            n_messages += 1
            n_bytes += len(raw)
            if n_messages >= MOST_MESSAGES or n_bytes >= MOST_BYTES:
                yield [from_messages(own[key], *found[key]) for key in sorted(found)]
                found, n_messages, n_bytes = {}, 0, 0
        if found:
            yield [from_messages(own[key], *found[key]) for key in sorted(found)]

    def _messages(
        self, wanted: list[RosbagsConnection], start_ns: int | None, end_ns: int | None
    ) -> Iterator[tuple[RosbagsConnection, int, bytes]]:
        """What rosbags reads, as far as the database is not damaged."""
        try:
            yield from self._reader.messages(wanted, start_ns, end_ns)
        except apsw.Error as error:
            self.problems.append(f"the database is damaged ({error}); what comes before is read")


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
