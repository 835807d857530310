"""Static transforms: which recording's hold for which drive."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from timemap_cli.logs.batches import BadBatch, TransformBatch
from timemap_cli.logs.history import usable
from timemap_cli.logs.interleave import Recorded
from timemap_cli.logs.poses import transform_topics
from timemap_cli.model.state import State


@dataclass(frozen=True, slots=True)
class StaticTransforms:
    """The static transforms of some recordings, and of those that an earlier replay read.

    What a drive's own recordings say holds, then what the others say; of either the earliest recording's.
    """

    by_recording: tuple[tuple[TransformBatch, ...], ...]
    earlier: tuple[TransformBatch, ...] = ()  # of all recordings of earlier replays
    earlier_own: tuple[TransformBatch, ...] = ()  # of those whose drive may go on

    @property
    def all(self) -> tuple[TransformBatch, ...]:
        """Those of all recordings, in no order that matters."""
        return (*self.earlier, *chain.from_iterable(self.by_recording))

    def of_drive(self, group: Sequence[int], *, goes_on: bool = False) -> Iterator[TransformBatch]:
        """Those of all recordings, the ones that hold last; `goes_on`: an earlier drive does, with this group."""
        others = [index for index in range(len(self.by_recording)) if index not in group]
        yield from self._reversed(others)
        yield from self.earlier
        yield from self._reversed(group)
        yield from self.earlier_own if goes_on else ()

    def kept(self, group: Sequence[int], *, goes_on: bool) -> State:
        """What a later replay has to know of them, for `of`; the last drive was the `group`'s."""
        every = (*self._reversed(range(len(self.by_recording))), *self.earlier)
        own = (*self._reversed(group), *(self.earlier_own if goes_on else ()))
        return {"all": _as_plain(every), "own": _as_plain(own)}

    @classmethod
    def of(cls, by_recording: Iterable[Iterable[TransformBatch]], state: State | None) -> StaticTransforms:
        """Those of some recordings, and of earlier ones as they were kept."""
        earlier, own = (_from_plain(state[name]) for name in ("all", "own")) if state else ((), ())
        return cls(tuple(tuple(batches) for batches in by_recording), earlier, own)

    def _reversed(self, recordings: Sequence[int]) -> Iterator[TransformBatch]:
        for index in reversed(recordings):
            yield from self.by_recording[index]


def read_static_transforms(recording: Recorded) -> tuple[list[TransformBatch], int]:
    """All static transforms of a recording, and how many could not be decoded."""
    _, topics = transform_topics(recording.topics)
    found: list[TransformBatch] = []
    bad = 0
    for batches in recording.batches(topics) if topics else ():
        found += [batch for batch in batches if isinstance(batch, TransformBatch)]
        bad += sum(batch.count for batch in batches if isinstance(batch, BadBatch))
    return found, bad


def _as_plain(batches: Iterable[TransformBatch]) -> list[tuple[str, str, list[float], list[float]]]:
    """The transform that holds for each child frame, in a form that JSON can hold."""
    holding: dict[str, tuple[str, str, list[float], list[float]]] = {}
    for batch in batches:
        good, _ = usable(batch.translation, batch.rotation)
        for row in np.flatnonzero(good)[-1:].tolist():
            place, turn = batch.translation[row].tolist(), batch.rotation[row].tolist()
            holding[batch.child] = batch.parent, batch.child, place, turn
    return list(holding.values())


def _from_plain(plain: Iterable[tuple[str, str, list[float], list[float]]]) -> tuple[TransformBatch, ...]:
    stamp = np.zeros(1, np.int64)
    return tuple(
        TransformBatch(parent, child, True, stamp, stamp, np.array([place]), np.array([turn]))
        for parent, child, place, turn in plain
    )
