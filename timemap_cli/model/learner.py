"""From observations to estimates: the map learns, and is asked for estimates when they are due."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.guard import Guard
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observations
from timemap_cli.model.schedule import Schedule
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.time_map import TimeMap


class Mark(Enum):
    """What comes between the blocks of observations."""

    RECORDING_ENDS = "recording ends"
    RESUMED = "resumed"  # what comes now is new; what came before it, an earlier replay saw the end of


@dataclass(frozen=True, slots=True)
class Round:
    """Estimates made together, of the nodes that had changed."""

    estimates: list[Estimate]  # level by level and in order of node
    newest_ns: (
        int  # stamp of the newest scan learnt; in the first round, which has no estimates, of the first
    )
    nodes: int  # how many nodes the map knows: the first so many


@dataclass(frozen=True, slots=True)
class Learnt:
    """What came of a block of observations, or of a recording's end."""

    rounds: list[Round]
    lost: int  # scans of the block that were set aside: they contradict nearly all that their node has long held
    shortfalls: dict[str, float]  # so far; as in TimeMap
    mark: Mark | None  # what it came of, if not of observations


@dataclass(frozen=True, slots=True)
class Keep:
    """Asks for all that is remembered of a node; or, None, of no node alone."""

    node: int | None


@dataclass(frozen=True, slots=True)
class Kept:
    """The answer, for `Learner.restore`."""

    node: int | None
    state: State


Asked = Observations | Mark | Keep
Answer = Learnt | Kept


class Learner:
    """A map that learns, what it is not to learn, and when it is to be estimated."""

    def __init__(self, time_map: TimeMap, guard: Guard, schedule: Schedule) -> None:
        self._map = time_map
        self._guard = guard
        self._schedule = schedule
        self._newest_ns: int | None = None
        self._has_begun = False

    def take(self, asked: Asked) -> Answer:
        """Learn a block of observations; where a recording ends, what changed is estimated."""
        if isinstance(asked, Keep):
            return Kept(asked.node, self._kept(asked.node))
        rounds: list[Round] = []
        lost = 0
        if isinstance(asked, Observations):
            rounds, lost = self._learn(asked)
        elif asked is Mark.RECORDING_ENDS:
            rounds = self._end()
        else:
            self._has_begun = False
        return Learnt(rounds, lost, self._map.shortfalls, asked if isinstance(asked, Mark) else None)

    def restore(self, kept: Iterable[Kept], nodes: Sequence[Node]) -> None:
        """Go on where another learner stopped: what is of no node alone comes first; `nodes` are the observer's."""
        for one in kept:
            if one.node is None:
                self._newest_ns = one.state["newest_ns"]
                self._schedule.restore(without_prefix("schedule", one.state))
                self._map.restore_of_all(without_prefix("map", one.state), nodes)
                self._guard.restore_of_all(without_prefix("guard", one.state))
            elif one.node < len(self._map.nodes):
                self._map.restore(one.node, without_prefix("map", one.state))
                self._guard.restore(one.node, without_prefix("guard", one.state))

    def _kept(self, node: int | None) -> State:
        if node is None:
            parts = prefixed("schedule", self._schedule.kept()) | prefixed("map", self._map.kept_of_all())
            return {"newest_ns": self._newest_ns, **parts, **prefixed("guard", self._guard.kept_of_all())}
        if node >= len(self._map.nodes):  # no scan of it has been learnt
            return {}
        return prefixed("map", self._map.kept(node)) | prefixed("guard", self._guard.kept(node))

    def _learn(self, seen: Observations) -> tuple[list[Round], int]:
        rounds: list[Round] = []
        lost = 0
        for part, estimates_are_due in self._schedule.parts(seen.stamps_ns):
            scans = self._believed(seen.part(part))
            lost += part.stop - part.start - len(scans)
            if len(scans):
                self._map.learn(scans)
                if not self._has_begun:
                    self._has_begun = True
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
        return [Round(estimates, self._newest_ns, len(self._map.nodes))] if estimates else []
