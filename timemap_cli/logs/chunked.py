"""Reading of chunked files (MCAP, ROS 1 bag): chunks are loaded in time order and handed on by log time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from timemap_cli.logs.raw import Connection, RawMessages

STRETCH_BYTES = 4 << 20  # chunks are joined up to this size, so that small chunks cost no more than big ones
MOST_HELD_BYTES = 512 << 20  # of chunks that overlap in time
LARGEST_STRETCH_BYTES = 16 << 20  # and divided beyond it


@dataclass(frozen=True, slots=True)
class ChunkSpan:
    """Where a chunk lies in the file, and the log times of its first and its last message."""

    offset: int
    start_ns: int
    end_ns: int


Span = TypeVar("Span", bound=ChunkSpan)


def stretches(
    spans: Sequence[Span], load: Callable[[Span], list[RawMessages]]
) -> Iterator[list[RawMessages]]:
    """Messages of all chunks in log-time order, also where chunks overlap in time.

    ``load`` gives a chunk's messages: for each connection at most one item, in log-time order. They are
    kept back until no later chunk can hold anything older, or until they are more than MOST_HELD_BYTES: a
    file of chunks that all span the same hours would else be held whole. What is then older comes late.
    """
    ordered = sorted(spans, key=lambda span: (span.start_ns, span.offset))
    waiting: list[RawMessages] = []
    ready: list[RawMessages] = []
    n_bytes = 0
    for index, span in enumerate(ordered):
        waiting += load(span)
        if index + 1 < len(ordered):
            done, waiting = split_at(waiting, ordered[index + 1].start_ns)
        else:
            done, waiting = waiting, []
        if _held_bytes(waiting) > MOST_HELD_BYTES:
            done, waiting = done + waiting, []
        ready += done
        n_bytes += sum(part.n_bytes for part in done)
        if n_bytes >= STRETCH_BYTES:
            yield from _divided(join(ready))
            ready, n_bytes = [], 0
    if ready:
        yield from _divided(join(ready))


def _held_bytes(parts: Sequence[RawMessages]) -> int:
    """Bytes of the chunks that some messages are in."""
    return sum({id(part.data): len(part.data) for part in parts}.values())


def with_shortfall(
    lists: Iterator[list[RawMessages]], wanted: Iterable[Connection], problems: list[str]
) -> Iterator[list[RawMessages]]:
    """The same lists; once all have been taken, an entry in ``problems`` where they hold less than announced."""
    found: Counter[str] = Counter()
    for parts in lists:
        for part in parts:
            found[part.connection.topic] += len(part)
        yield parts
    announced: Counter[str] = Counter()
    for connection in wanted:
        announced[connection.topic] += connection.count
    problems += [
        f"{count - found[topic]} of {count} messages of {topic} are missing"
        for topic, count in sorted(announced.items())
        if found[topic] < count
    ]


def split_at(parts: list[RawMessages], time_ns: int) -> tuple[list[RawMessages], list[RawMessages]]:
    """Messages before ``time_ns``, and the others; empty parts are left out."""
    before, after = [], []
    for part in parts:
        cut = int(np.searchsorted(part.log_ns, time_ns))
        if cut:
            before.append(part[:cut])
        if cut < len(part):
            after.append(part[cut:])
    return before, after


def _divided(parts: list[RawMessages]) -> Iterator[list[RawMessages]]:
    """The same messages in successive lists of about LARGEST_STRETCH_BYTES at most."""
    n_lists = -(-sum(part.n_bytes for part in parts) // LARGEST_STRETCH_BYTES)
    if n_lists > 1:
        times = np.sort(np.concatenate([part.log_ns for part in parts]))
        for index in range(1, n_lists):
            before, parts = split_at(parts, int(times[len(times) * index // n_lists]))
            if before:
                yield before
    if parts:
        yield parts


def join(parts: Sequence[RawMessages]) -> list[RawMessages]:
    """One item for each connection, in log-time order, over a common buffer; in order of connection ids."""
    by_connection: dict[int, list[RawMessages]] = {}
    for part in parts:
        by_connection.setdefault(part.connection.id, []).append(part)
    if len(by_connection) == len(parts):
        return [by_connection[key][0] for key in sorted(by_connection)]
    buffers = {id(part.data): part.data for part in parts}
    data = np.concatenate(list(buffers.values()))
    ends = np.cumsum([len(buffer) for buffer in buffers.values()])
    bases = {key: int(end) - len(buffer) for (key, buffer), end in zip(buffers.items(), ends, strict=True)}
    joined = []
    for key in sorted(by_connection):
        group = by_connection[key]
        whole = RawMessages(
            group[0].connection,
            np.concatenate([part.log_ns for part in group]),
            data,
            np.concatenate([part.starts + bases[id(part.data)] for part in group]),
            np.concatenate([part.sizes for part in group]),
        )
        joined.append(in_log_order(whole))
    return joined


def in_log_order(messages: RawMessages) -> RawMessages:
    """The same messages sorted by log time; those of one time stay in the order they had."""
    if len(messages) > 1 and (messages.log_ns[1:] < messages.log_ns[:-1]).any():
        return messages[np.argsort(messages.log_ns, kind="stable")]
    return messages


def within(messages: RawMessages, start_ns: int | None, end_ns: int | None) -> RawMessages:
    """The messages with ``start_ns <= log time < end_ns``, of messages in log-time order."""
    first = 0 if start_ns is None else int(np.searchsorted(messages.log_ns, start_ns))
    last = len(messages) if end_ns is None else int(np.searchsorted(messages.log_ns, end_ns))
    return messages if last - first == len(messages) else messages[first : max(first, last)]
