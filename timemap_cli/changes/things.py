"""Runs of several nodes that are parts of one thing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from timemap_cli.changes.rings import Floats
from timemap_cli.changes.runs import Run
from timemap_cli.model.elementary import lengths


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that one side has and the other has not."""

    runs: tuple[Run, ...]
    points: Floats  # (n, 2) [m] map frame, of all runs
    alone: bool = False  # it was seen whole, with something farther on either side
    passed: tuple[Run, ...] = ()  # of the other side's nodes, where they see past it, along its surface


def link(runs: Sequence[Run], reach_m: float) -> list[Thing]:
    """Joins runs whose points come within `reach_m` of each other, directly or through other runs."""
    if not runs:
        return []
    low = np.array([run.points.min(axis=0) for run in runs]) - reach_m
    high = np.array([run.points.max(axis=0) for run in runs])
    groups = _Groups(len(runs))
    for i, run in enumerate(runs):
        overlap = (low[i + 1 :] <= high[i]) & (low[i] <= high[i + 1 :])
        for j in (np.flatnonzero(overlap.all(axis=1)) + i + 1).tolist():
            if groups.find(i) != groups.find(j) and gap(run.points, runs[j].points) <= reach_m:
                groups.join(i, j)
    members: dict[int, list[Run]] = {}
    for i, run in enumerate(runs):
        members.setdefault(groups.find(i), []).append(run)
    return [Thing(tuple(parts), np.concatenate([p.points for p in parts])) for parts in members.values()]


def distances(a: Floats, b: Floats) -> Floats:
    """Distance of every point of a (n, 2) from every point of b (m, 2), (n, m) [m]."""
    return lengths(a[:, None] - b[None])


def gap(a: Floats, b: Floats) -> float:
    """Distance of the two points of a (n, 2) and b (m, 2) that are nearest to each other [m]."""
    return float(distances(a, b).min())


class _Groups:
    """Disjoint sets of 0..n-1; a set is named by its smallest member."""

    def __init__(self, n: int) -> None:
        self._parent = list(range(n))

    def find(self, i: int) -> int:
        while self._parent[i] != i:
            self._parent[i] = self._parent[self._parent[i]]
            i = self._parent[i]
        return i

    def join(self, i: int, j: int) -> None:
        low, high = sorted((self.find(i), self.find(j)))
        self._parent[high] = low
