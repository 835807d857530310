"""What the whole pages of a damaged rosbag2 database hold."""

from __future__ import annotations

import re
from array import array
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import IO

import numpy as np

from timemap_cli.logs.raw import Connection, Int64s, ros2_name
from timemap_cli.logs.shared_handles import HANDLES
from timemap_cli.logs.sqlite_pages import Pages, Row

TYPE_NAME = re.compile(rb"\w+/(\w+/)?\w+")
DEFINITION_FORMATS = {b"ros2msg": "msg", b"ros2idl": "idl"}

ID, TOPIC, TIME, PAGE, PLACE = range(5)  # columns of what is known of a message


class Rescue:
    """Messages and topics of a damaged database, told by the shape of their rows."""

    def __init__(self, path: Path) -> None:
        """Look through all pages of the file. Raises OSError, or ValueError where there is no topic in them."""
        self._file: IO[bytes] = HANDLES.open(path)
        try:
            self._pages = Pages(self._file)
            self._messages, self.connections = _found(self._pages)
        except BaseException:
            self._file.close()
            raise
        times = self._messages[:, TIME]
        self.start_ns = int(times.min(initial=2**63 - 1)) if len(times) else 0
        self.end_ns = int(times.max(initial=0))

    @property
    def missing(self) -> int:
        """How many messages there were beside those found, by the gaps in their numbers, which begin with 1."""
        return int(self._messages[:, ID].max(initial=0)) - len(self._messages)

    def messages(
        self, topics: Collection[int], start_ns: int, end_ns: int, behind: tuple[int, int]
    ) -> Iterator[tuple[int, int, int, bytes]]:
        """(id, topic, log time, bytes) with ``start_ns <= log time < end_ns`` and (log time, id) after ``behind``."""
        for key, topic, log_ns, page, place in self._messages.tolist():
            if topic in topics and start_ns <= log_ns < end_ns and (log_ns, key) > behind:
                content = self._pages.last_column(page, place)
                if content is not None:
                    yield key, topic, log_ns, content

    def close(self) -> None:
        """Release the file."""
        self._file.close()


def _found(pages: Pages) -> tuple[Int64s, tuple[Connection, ...]]:
    """What is known of each message (n, 5), in order of log time and id; and the topics."""
    known = array("q")
    topics: dict[int, tuple[bytes, ...]] = {}
    definitions: dict[bytes, tuple[bytes, bytes]] = {}
    for row in pages.rows():
        if _is_message(row):
            _, topic, log_ns, _ = row.values
            known.extend((row.rowid, int(topic or 0), int(log_ns or 0), row.page, row.place))
        elif texts := _texts(row):
            name, second, third = texts[:3]
            if TYPE_NAME.fullmatch(second) and name.startswith(b"/"):
                topics[row.rowid] = name, second, third
            elif second in DEFINITION_FORMATS:
                definitions[name] = second, third
    if not topics:
        raise ValueError("the database is damaged, and no topic is left in it")
    messages = np.frombuffer(known, np.int64).reshape(-1, 5)
    messages = messages[np.isin(messages[:, TOPIC], list(topics))]
    messages = messages[np.unique(messages[:, ID], return_index=True)[1]]
    messages = messages[np.lexsort((messages[:, ID], messages[:, TIME]))]
    counts = {key: int(np.count_nonzero(messages[:, TOPIC] == key)) for key in topics}
    return messages, tuple(
        _connection(key, topics[key], definitions.get(topics[key][1]), counts[key]) for key in sorted(topics)
    )


def _is_message(row: Row) -> bool:
    """Whether it is (id, topic, log time, bytes); the id stands beside the row and not in it."""
    is_shaped = len(row.kinds) == 4 and row.kinds[0] == 0 and row.kinds[3] >= 12 and row.kinds[3] % 2 == 0
    return is_shaped and all(isinstance(value, int) for value in row.values[1:3]) and row.rowid > 0


def _texts(row: Row) -> tuple[bytes, ...]:
    """The columns of a row of an id and three texts at least; empty for any other row."""
    if row.kinds[0] != 0 or len(row.kinds) < 4 or row.missing:
        return ()
    texts = tuple(value for value in row.values[1:4] if isinstance(value, bytes))
    return texts if len(texts) == 3 else ()


def _connection(
    key: int, topic: tuple[bytes, ...], definition: tuple[bytes, bytes] | None, count: int
) -> Connection:
    name, msgtype, encoding = (text.decode("utf-8", "replace") for text in topic)
    kind, text = definition or (b"", b"")
    return Connection(
        id=key,
        topic=name,
        msgtype=ros2_name(msgtype),
        encoding=encoding,
        definition=text.decode("utf-8", "replace"),
        definition_format=DEFINITION_FORMATS.get(kind, ""),
        count=count,
    )
