"""Whether two outlines are of the same place."""

from collections.abc import Iterable
from typing import Protocol, TypeVar

import numpy as np

from timemap_cli.changes.rings import Floats
from timemap_cli.changes.things import distances

NEAR_M = 0.3  # as far as parts of one thing may lie apart; poses included
_SAME = 0.5  # share of the points of the smaller outline


class HasPoints(Protocol):
    """Something with an outline."""

    @property
    def points(self) -> Floats:
        """(n, 2) [m, map frame]."""


T = TypeVar("T", bound=HasPoints)


def overlap(one: Floats, other: Floats) -> float:
    """Share of the points of an outline (n, 2) that lie near the other's (m, 2), of the one that lies nearer."""
    apart = np.maximum(one.min(axis=0) - other.max(axis=0), other.min(axis=0) - one.max(axis=0))
    if (apart > NEAR_M).any():
        return 0.0
    near = distances(one, other) <= NEAR_M
    return float(max(near.any(axis=1).mean(), near.any(axis=0).mean()))


def best_match(points: Floats, among: Iterable[T]) -> T | None:
    """What overlaps most with these points, by half at least; of equals the first."""
    shares = [(overlap(points, one.points), one) for one in among]
    best = max(shares, key=lambda pair: pair[0], default=None)
    return best[1] if best is not None and best[0] >= _SAME else None
