"""From observations to estimates: the map learns, and is asked for estimates when they are due."""

from dataclasses import dataclass

import numpy as np

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.guard import Guard
from timemap_cli.model.observer import Observations
from timemap_cli.model.schedule import Schedule
from timemap_cli.model.time_map import TimeMap


@dataclass(frozen=True, slots=True)
class Round:
    """Estimates made together, of the nodes that had changed."""

    estimates: list[Estimate]  # level by level and in order of node
    newest_ns: int  # stamp of the newest scan learnt; in the first round of all, which has no estimates, of the first
    nodes: int  # how many nodes the map knows: the first so many


@dataclass(frozen=True, slots=True)
class Learnt:
    """What came of a block of observations, or of a recording's end."""

    rounds: list[Round]
    lost: int  # scans of the block that were set aside: they contradict nearly all that their node has long held
    shortfalls: dict[str, float]  # so far; as in TimeMap
    ends_recording: bool


class Learner:
    """A map that learns, what it is not to learn, and when it is to be estimated."""

    def __init__(self, time_map: TimeMap, guard: Guard, schedule: Schedule) -> None:
        self._map = time_map
        self._guard = guard
        self._schedule = schedule
        self._newest_ns: int | None = None

    def take(self, seen: Observations | None) -> Learnt:
        """Learn a block of observations; None says that a recording has ended: what changed is estimated then."""
        rounds, lost = (self._end(), 0) if seen is None else self._learn(seen)
        return Learnt(rounds, lost, self._map.shortfalls, ends_recording=seen is None)

    def _learn(self, seen: Observations) -> tuple[list[Round], int]:
        rounds: list[Round] = []
        lost = 0
        for part, estimates_are_due in self._schedule.parts(seen.stamps_ns):
            scans = self._believed(seen.part(part))
            lost += part.stop - part.start - len(scans)
            if len(scans):
                self._map.learn(scans)
                if self._newest_ns is None:
                    rounds.append(Round([], int(scans.stamps_ns[0]), len(self._map.nodes)))
                self._newest_ns = int(scans.stamps_ns[-1])
            if estimates_are_due:
                rounds += self._end()
        return rounds, lost

    def _believed(self, seen: Observations) -> Observations:
        believed = self._guard.believed(seen)
        return seen if believed.all() else seen.part(np.flatnonzero(believed))

    def _end(self) -> list[Round]:
        if self._newest_ns is None:
            return []
        estimates = self._map.estimates()
        self._guard.expect(found for found in estimates if found.level == self._map.levels[-1])
        return [Round(estimates, self._newest_ns, len(self._map.nodes))]
