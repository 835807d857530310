"""A map of nodes that remember what they saw at several time scales (paper, sec. 3 and 4)."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.estimator import Estimated, Estimator
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory, Remembered
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observations
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.virtual_scan import CLEAR

Ints = npt.NDArray[np.int64]

_NODES_AT_ONCE = 16
_METRES = np.append((np.arange(CLEAR) / 1000).astype(np.float32), np.array([np.inf, np.nan], np.float32))


class TimeMap:
    """The memory of every node at every level."""

    def __init__(
        self,
        levels: Sequence[Level],
        estimator: Estimator,
        *,
        angle_bins: int,
        seed: int = 0,
        nodes: Sequence[Node] = (),
    ) -> None:
        """`levels` fastest first; given `nodes` are known from the start."""
        self.levels = tuple(level.name for level in levels)
        self.nodes = list(nodes)  # in the order of their numbers
        self._estimator = estimator
        self._memories = [Memory(level, angle_bins, seed) for level in levels]
        for memory in self._memories:
            memory.add_nodes(self.nodes)
        self._changed: list[set[int]] = [set() for _ in levels]
        # A last observation before it does not make a level a slower one.
        self._gated = [any(faster.window > 1 for faster in levels[:i]) for i in range(len(levels))]

    @property
    def shortfalls(self) -> dict[str, float]:
        """By level: share of what its half-life asks it to forget that its window is too long for."""
        return {memory.level.name: memory.shortfall for memory in self._memories}

    def learn(self, seen: Observations) -> None:
        """Remember: the fastest level is offered every scan, slower ones those that passed the gate."""
        known = int(seen.nodes.max(initial=-1)) + 1
        self.nodes += seen.all_nodes[len(self.nodes) : known]
        for memory, changed, gated in zip(self._memories, self._changed, self._gated, strict=True):
            memory.add_nodes(self.nodes)
            rows = seen.passes if gated else slice(None)
            changed.update(
                memory.remember(seen.nodes[rows], seen.stamps_ns[rows], seen.ranges[rows]).tolist()
            )

    def kept(self, node: int) -> State:
        """All that the levels remember of a node, for `restore`."""
        state: State = {"changed": [node in changed for changed in self._changed]}
        for memory in self._memories:
            state |= prefixed(memory.level.name, memory.kept(node))
        return state

    def restore(self, node: int, state: State) -> None:
        """Take over what another map kept of a node; `restore_of_all` first."""
        for memory, changed, is_changed in zip(self._memories, self._changed, state["changed"], strict=True):
            memory.restore(node, without_prefix(memory.level.name, state))
            if is_changed:
                changed.add(node)

    def kept_of_all(self) -> State:
        """What the levels remember of no node alone, for `restore_of_all`."""
        state: State = {"nodes": len(self.nodes)}
        for memory in self._memories:
            state |= prefixed(memory.level.name, memory.kept_of_all())
        return state

    def restore_of_all(self, state: State, nodes: Sequence[Node]) -> None:
        """Take over what another map kept of no node alone; `nodes` begin with those that it knew."""
        self.nodes = list(nodes[: state["nodes"]])
        for memory in self._memories:
            memory.add_nodes(self.nodes)
            memory.restore_of_all(without_prefix(memory.level.name, state))

    def estimates(self) -> list[Estimate]:
        """Estimates of the nodes that changed since the last call, level by level and in order of node."""
        found: list[Estimate] = []
        for memory, changed in zip(self._memories, self._changed, strict=True):
            nodes = np.array(sorted(changed), np.int64)
            changed.clear()
            for start in range(0, len(nodes), _NODES_AT_ONCE):
                some = nodes[start : start + _NODES_AT_ONCE]
                remembered = memory.recall(some)
                estimated = self._estimator(remembered)
                found += _as_estimates(some, memory.level.name, remembered, estimated)
        return found


def _as_estimates(nodes: Ints, level: str, memory: Remembered, found: Estimated) -> list[Estimate]:
    metres = _METRES.take(found.ranges)
    support, known = found.support.astype(np.float32), found.known.astype(np.float32)
    samples = found.samples.astype(np.uint16)
    return [
        Estimate(
            node,
            level,
            stamp_ns,
            metres[i],
            support[i],
            known[i],
            samples[i],
            found.status[i],
            memory.last_seen_ns[i],
        )
        for i, (node, stamp_ns) in enumerate(zip(nodes.tolist(), memory.stamps_ns.tolist(), strict=True))
    ]
