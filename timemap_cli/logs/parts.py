"""The files of one recording read as one, in the order of their log times."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from timemap_cli.logs.chunked import split_at
from timemap_cli.logs.message_types import is_read
from timemap_cli.logs.raw import RawMessages, Storage

NEVER_NS = 2**63 - 1


def stretches_of_all(
    storages: Sequence[Storage], topics: Collection[str], start_ns: int | None, end_ns: int | None
) -> Iterator[list[RawMessages]]:
    """Messages of these topics with ``start_ns <= log time < end_ns``; each list covers the next stretch of log time.

    The storages are in the order of their starts; those that overlap are read together, and a list may then
    hold several items of a connection's id.
    """
    chosen = [(storage, _connections(storage, topics)) for storage in storages]
    for group in _overlapping([(storage, ids) for storage, ids in chosen if ids]):
        sources = [(one.start_ns, one.stretches(ids, start_ns, end_ns)) for one, ids in group]
        yield from sources[0][1] if len(sources) == 1 else _merged(sources)


def _connections(storage: Storage, topics: Collection[str]) -> set[int]:
    return {one.id for one in storage.connections if one.topic in topics and is_read(one)}


def _overlapping(chosen: Sequence[tuple[Storage, set[int]]]) -> list[list[tuple[Storage, set[int]]]]:
    """Storages in groups, none of which overlaps the next."""
    groups: list[list[tuple[Storage, set[int]]]] = []
    end_ns = 0
    for storage, ids in chosen:
        if groups and storage.start_ns < end_ns:
            groups[-1].append((storage, ids))
        else:
            groups.append([(storage, ids)])
        end_ns = max(end_ns, storage.end_ns)
    return groups


def _merged(sources: Sequence[tuple[int, Iterator[list[RawMessages]]]]) -> Iterator[list[RawMessages]]:
    """The lists of sources that overlap; messages are kept back until no source can hold anything older."""
    read_to = {number: begin_ns for number, (begin_ns, _) in enumerate(sources)}
    waiting: list[RawMessages] = []
    while read_to:
        number = min(read_to, key=lambda one: (read_to[one], one))
        parts = next(sources[number][1], None)
        if parts is None:
            del read_to[number]
        else:
            waiting += parts
            read_to[number] = max(int(part.log_ns[-1]) for part in parts)
        ready, waiting = split_at(waiting, min(read_to.values(), default=NEVER_NS))
        if ready:
            yield ready
