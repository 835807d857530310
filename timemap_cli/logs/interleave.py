"""Several recordings read as one, in the order of their log times."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Protocol

from timemap_cli.logs.batches import BadBatch, Batch

NEVER_NS = 2**62  # after all log times


class RecordedTopic(Protocol):
    """What is needed of a topic."""

    @property
    def name(self) -> str:
        """As recorded."""

    @property
    def msgtype(self) -> str:
        """As in ``sensor_msgs/msg/LaserScan``."""


class Recorded(Protocol):
    """What is needed of a recording."""

    @property
    def start_ns(self) -> int:
        """Log time [ns] of the first message."""

    @property
    def end_ns(self) -> int:
        """Log time [ns] of the last message."""

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        """All topics."""

    def batches(self, topics: Collection[str]) -> Iterator[list[Batch]]:
        """Lists of batches, each list covering the next stretch of log time."""


def joined(recordings: Sequence[Recorded], gap_ns: int) -> list[list[int]]:
    """Indices of recordings that overlap or follow one another within ``gap_ns``: the parts of one drive.

    The recordings stand in the order of their starts.
    """
    groups: list[list[int]] = []
    end_ns = 0
    for index, recording in enumerate(recordings):
        if groups and recording.start_ns <= end_ns + gap_ns:
            groups[-1].append(index)
            end_ns = max(end_ns, recording.end_ns)
        else:
            groups.append([index])
            end_ns = recording.end_ns
    return groups


def interleaved(
    recordings: Sequence[Recorded], topics: Mapping[int, Collection[str]], group: Sequence[int]
) -> Iterator[tuple[int, list[Batch] | None, int]]:
    """Yield (recording, its next batches, log time [ns] up to which all recordings have been read).

    None instead of batches says that the recording has ended. A recording is opened when its turn comes.
    """
    read_to = {index: recordings[index].start_ns for index in group}
    sources: dict[int, Iterator[list[Batch]]] = {}
    while read_to:
        index = min(read_to, key=lambda i: (read_to[i], i))
        if index not in sources:
            sources[index] = recordings[index].batches(topics[index])
        batches = next(sources[index], None)
        if batches is None:
            del read_to[index]
        else:
            read_to[index] = max(read_to[index], _last_log_ns(batches))
        yield index, batches, min(read_to.values(), default=NEVER_NS)


def _last_log_ns(batches: Sequence[Batch]) -> int:
    times = [b.log_ns for b in batches if not isinstance(b, BadBatch) and len(b.log_ns)]
    return max((int(log_ns.max()) for log_ns in times), default=-NEVER_NS)
