"""Which recordings are parts of one drive and share their transforms."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from timemap_cli.logs.batches import TransformBatch
from timemap_cli.logs.history import NO_PARENT, History, usable
from timemap_cli.logs.interleave import Recorded, joined
from timemap_cli.logs.scan_window import WINDOW_NS

Drive = tuple[int, ...]  # indices of recordings
Edge = tuple[str, str]  # parent, child

# Two recorders of one robot may have missed different messages, and the robot moves in between.
OTHER_PLACE_M = 0.5
TRACE_OF_OTHER_TURN = 1 + math.sqrt(3)  # 1 + 2 cos of 30 degrees
OTHER_SHARE = 0.1  # of the stamps that both cover


def drives(
    recordings: Sequence[Recorded], transforms: Sequence[Sequence[TransformBatch]]
) -> tuple[Drive, ...]:
    """Recordings that overlap or follow within 10 s, but not those that tell other poses for the same stamps.

    The latter are two robots, or two runs of a simulation whose clock began anew. ``transforms`` are a
    sample of each recording's. The recordings stand in the order of their starts, and so do the drives.
    """
    found: list[list[int]] = []
    for group in joined(recordings, WINDOW_NS):
        apart: list[list[int]] = []
        moving = {index: _Moving.of(transforms[index]) for index in group} if len(group) > 1 else {}
        for index in group:
            fitting = (d for d in apart if not any(_contradict(moving[index], moving[other]) for other in d))
            drive = next(fitting, None)
            if drive is None:
                apart.append([index])
            else:
                drive.append(index)
        found += apart
    return tuple(map(tuple, found))


@dataclass(frozen=True, slots=True)
class _Moving:
    """The moving edges of a recording, each with all its samples that are poses, and the span of their stamps."""

    edges: Mapping[Edge, TransformBatch]
    first_ns: int
    last_ns: int

    @classmethod
    def of(cls, batches: Sequence[TransformBatch]) -> _Moving:
        parts: dict[Edge, list[TransformBatch]] = {}
        for batch in batches:
            if not batch.static:
                parts.setdefault((batch.parent, batch.child), []).append(batch)
        edges = {edge: whole for edge, some in parts.items() if len((whole := _usable(some)).stamps_ns)}
        first_ns = min((int(edge.stamps_ns.min()) for edge in edges.values()), default=0)
        last_ns = max((int(edge.stamps_ns.max()) for edge in edges.values()), default=0)
        return cls(edges, first_ns, last_ns)


def _usable(parts: Sequence[TransformBatch]) -> TransformBatch:
    first = parts[0]
    translation = np.concatenate([part.translation for part in parts])
    good, rotation = usable(translation, np.concatenate([part.rotation for part in parts]))
    stamps_ns = np.concatenate([part.stamps_ns for part in parts])[good]
    return TransformBatch(
        first.parent, first.child, False, stamps_ns, stamps_ns, translation[good], rotation[good]
    )


def _contradict(some: _Moving, others: _Moving) -> bool:
    """Whether an edge that both have is in other places at the stamps that both cover."""
    if some.first_ns > others.last_ns or others.first_ns > some.last_ns:  # as most parts of a drive
        return False
    return any(
        _differ(batch, others.edges[edge]) for edge, batch in some.edges.items() if edge in others.edges
    )


def _differ(one: TransformBatch, other: TransformBatch) -> bool:
    if one.stamps_ns.min() > other.stamps_ns.max() or other.stamps_ns.min() > one.stamps_ns.max():
        return False
    samples = []
    for batch in (other, one):
        history = History()
        history.add(batch.stamps_ns, batch.translation, batch.rotation, 0)
        samples.append(history.sample(one.stamps_ns))
    (known, there), (_, here) = samples
    both = known != NO_PARENT
    if not both.any():
        return False
    apart = there[both, :, 3] - here[both, :, 3]
    far = (apart * apart).sum(axis=1) > OTHER_PLACE_M * OTHER_PLACE_M
    trace = (there[both, :, :3] * here[both, :, :3]).sum(axis=(1, 2))
    return bool((far | (trace < TRACE_OF_OTHER_TURN)).mean() > OTHER_SHARE)
