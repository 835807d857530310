"""Undecoded messages: where they lie in a buffer, and what a storage format has to offer to be read."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Int64s = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Connection:
    """One writer of one topic: what its messages are, in which encoding.

    ``msgtype`` is written as in ROS 2 (``sensor_msgs/msg/LaserScan``); ``encoding`` is "cdr", "ros1" or
    what else the file says; ``definition`` is the type's own text in the ``definition_format`` "msg" or
    "idl", empty where the file has none. ``count`` is the number of messages the file's index announces.
    """

    id: int
    topic: str
    msgtype: str
    encoding: str
    definition: str
    definition_format: str
    count: int


@dataclass(frozen=True, slots=True)
class RawMessages:
    """Messages of one connection in log-time order: message i is ``data[starts[i] : starts[i] + sizes[i]]``.

    ``data`` may hold other things in between.
    """

    connection: Connection
    log_ns: Int64s  # (n,) [ns]
    data: Bytes
    starts: Int64s  # (n,)
    sizes: Int64s  # (n,)

    def __len__(self) -> int:
        return len(self.log_ns)

    def __getitem__(self, chosen: slice | NDArray[np.bool_] | Int64s) -> RawMessages:
        """The chosen messages, of the same buffer."""
        return replace(self, log_ns=self.log_ns[chosen], starts=self.starts[chosen], sizes=self.sizes[chosen])

    @property
    def n_bytes(self) -> int:
        """Length of all messages together."""
        return int(self.sizes.sum())

    def message(self, index: int) -> bytes:
        """Bytes of one message."""
        start = int(self.starts[index])
        return self.data[start : start + int(self.sizes[index])].tobytes()

    def columns(self, offset: int, width: int) -> Bytes:
        """Bytes ``offset .. offset + width`` of every message, (n, width), contiguous and writable by the caller.

        Every message must be at least ``offset + width`` long.
        """
        return windows(self.data, self.starts + offset, width)


class Storage(Protocol):
    """One file of a recording, open for reading.

    ``start_ns``, ``end_ns``: log times of the first and the last message, both 0 where there is none.
    ``problems`` are sentences about damage, found on opening or while reading; what is not damaged is read
    all the same. ``remarks`` are about what is odd and costs no data.
    """

    format: str
    connections: tuple[Connection, ...]
    start_ns: int
    end_ns: int
    problems: list[str]
    remarks: list[str]

    def stretches(
        self, connections: Collection[int], start_ns: int | None, end_ns: int | None
    ) -> Iterator[list[RawMessages]]:
        """Messages of the connections with these ids, ``start_ns <= log time < end_ns``.

        Every list covers the next stretch of log time, with at most one item for each connection.
        """

    def close(self) -> None:
        """Release the file."""


def windows(data: Bytes, starts: Int64s, width: int) -> Bytes:
    """``data[s : s + width]`` for every s in starts, as a fresh (n, width) array; all must lie inside of data."""
    if not len(starts) or not width:
        return np.empty((len(starts), width), np.uint8)
    sliding = np.lib.stride_tricks.as_strided(data, (len(data) - width + 1, width), (1, 1), writeable=False)
    return sliding[starts]


def from_messages(connection: Connection, log_ns: Sequence[int], messages: Sequence[bytes]) -> RawMessages:
    """Messages that were read one by one, joined."""
    sizes = np.fromiter(map(len, messages), np.int64, len(messages))
    data = np.frombuffer(b"".join(messages), np.uint8)
    return RawMessages(connection, np.array(log_ns, np.int64), data, np.cumsum(sizes) - sizes, sizes)


def ros2_name(msgtype: str) -> str:
    """The name of a message type as ROS 2 writes it: ``sensor_msgs/LaserScan`` is ``sensor_msgs/msg/LaserScan``."""
    package, _, name = msgtype.partition("/")
    return msgtype if not name or "/" in name else f"{package}/msg/{name}"
