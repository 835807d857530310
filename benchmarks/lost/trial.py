"""A map that has learnt some drives, and what one more makes of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.lost.drives import Drive
from timemap_cli import assembly
from timemap_cli.config import Settings
from timemap_cli.model.contradiction import Bounds, firm_ranges
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.guard import ENOUGH_SCANS
from timemap_cli.model.learner import Asked, Keep, Kept, Learnt, Mark
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observations, Observer

OFF = 0.2  # [m] by which a range is another one
_FAR = 20.0  # [m] where clear stands, behind all
_BLOCK = 16  # scans; estimates that are made within one judge from the next one on

Held = dict[tuple[str, int], Estimate]
"""Newest estimates by level and node."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the scans of drives."""

    scans: int  # that said something of their nodes
    judged: int  # of these, that could be held against a firm estimate
    lost: int  # of these, that were set aside


@dataclass(frozen=True, slots=True)
class Map:
    """What a replay knows after some drives."""

    nodes: Sequence[Node]
    kept: Sequence[Kept]
    held: Held


def learnt(
    drives: Sequence[Drive], settings: Settings, before: Map | None = None
) -> tuple[list[Outcome], Map]:
    """Learn drives, one after the other, beginning anew or where a map stands, all of whose nodes are then given."""
    given = () if before is None else tuple(before.nodes)
    observer = assembly.observer(settings, given)
    learner = assembly.learner(settings, given, None if before is None else partial(iter, before.kept))
    held = {} if before is None else dict(before.held)
    outcomes = []
    for drive in drives:
        scans = judged = lost = 0
        for asked in _asked(drive, observer):
            if isinstance(asked, Observations):
                scans, judged = scans + len(asked), judged + _judged(asked, held, settings)
            answer = learner(asked)
            assert isinstance(answer, Learnt)
            lost += answer.lost
            held |= {(e.level, e.node): e for made in answer.rounds for e in made.estimates}
        outcomes.append(Outcome(scans, judged, lost))
    keeps = [learner(Keep(node)) for node in (None, *range(len(observer.nodes)))]
    return outcomes, Map(list(observer.nodes), [one for one in keeps if isinstance(one, Kept)], held)


def off(one: Map, other: Map, level: str) -> float:
    """Share of the angle bins that two maps of the same nodes know of which they say different ranges."""
    different = known = 0
    for key in (key for key in one.held.keys() & other.held.keys() if key[0] == level):
        a, b = (np.minimum(m.held[key].ranges.astype(np.float64), _FAR) for m in (one, other))
        both = ~np.isnan(a) & ~np.isnan(b)
        known += int(both.sum())
        different += int((np.abs(a[both] - b[both]) > OFF).sum())
    return different / max(1, known)


def _asked(drive: Drive, observer: Observer) -> Iterator[Asked]:
    for block in drive:
        for start in range(0, len(block), _BLOCK):
            yield observer.observe(block.rows(slice(start, start + _BLOCK)))
    yield Mark.RECORDING_ENDS


def _judged(seen: Observations, held: Held, settings: Settings) -> int:
    """How many observations a firm estimate of the slowest level can be held against."""
    slowest = settings.levels[-1]
    known = [i for i, node in enumerate(seen.nodes.tolist()) if (slowest.name, node) in held]
    if not known:
        return 0
    estimates = [held[slowest.name, node] for node in seen.nodes[known].tolist()]
    firm = firm_ranges(estimates, min(ENOUGH_SCANS, slowest.window))
    bounds = Bounds.around(firm, round(settings.map.radius * 1000))
    return int((~np.isnan(bounds.contradiction(seen.ranges[known]))).sum())
