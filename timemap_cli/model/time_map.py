"""A map of nodes that remember what they see at several time scales: the method of the paper, from end to end."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.estimator import Estimated, Estimator
from timemap_cli.model.gate import Gate, Passage, passing
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import NO_NODE, Placement
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.model.virtual_scan import CLEAR, virtual_scans

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Learnt:
    """What became of a block of scans."""

    used: int
    node_not_seen: int  # the node's centre was not in what the scan saw free
    no_node: int  # nodes were given, and none is near


class TimeMap:
    """The nodes, and the memory of every level."""

    def __init__(
        self,
        levels: Sequence[Level],
        gate: Gate,
        estimator: Estimator,
        *,
        angle_bins: int,
        radius: float,
        spacing: float,
        seed: int = 0,
        nodes: Sequence[Node] = (),
    ) -> None:
        """`levels` fastest first; `radius` and `spacing` [m]; given `nodes` are all there will be."""
        self._placement = Placement(spacing, nodes)
        self._memories = [Memory(level, angle_bins, seed) for level in levels]
        self._changed: list[set[int]] = [set() for _ in levels]
        self._gate = gate
        self._passages: dict[int, Passage] = {}
        self._estimator = estimator
        self._angle_bins = angle_bins
        self._radius = radius
        self._make_room()

    @property
    def nodes(self) -> Sequence[Node]:
        """All nodes, in the order in which they were made."""
        return self._placement.nodes

    @property
    def levels(self) -> tuple[str, ...]:
        """Names of the levels, fastest first."""
        return tuple(memory.level.name for memory in self._memories)

    def learn(self, sweeps: Sweeps) -> Learnt:
        """Give each scan to its node: the fastest level takes every one, slower ones what passes the gate."""
        places = _places(sweeps)
        nodes = self._placement.assign(places[:, :2])
        near = np.flatnonzero(nodes != NO_NODE)
        self._make_room()
        ranges, judged = virtual_scans(
            sweeps.rows(near), self._placement.centres[nodes[near]], self._angle_bins, self._radius
        )
        rows = near[judged]
        nodes, stamps_ns, ranges = nodes[rows], sweeps.stamps_ns[rows], ranges[judged]
        passes = passing(self._gate, nodes.tolist(), places[rows], stamps_ns, self._passages)
        self._remember(0, nodes, stamps_ns, ranges)
        for slower in range(1, len(self._memories)):
            self._remember(slower, nodes[passes], stamps_ns[passes], ranges[passes])
        return Learnt(len(rows), len(near) - len(rows), len(sweeps) - len(near))

    def _remember(self, level: int, nodes: Ints, stamps_ns: Ints, ranges: npt.NDArray[np.uint16]) -> None:
        self._changed[level].update(self._memories[level].remember(nodes, stamps_ns, ranges).tolist())

    def _make_room(self) -> None:
        for memory in self._memories:
            memory.add_nodes(self.nodes)

    def estimates(self) -> list[Estimate]:
        """Estimates of what changed since the last call, level by level and in order of node."""
        found: list[Estimate] = []
        for memory, changed in zip(self._memories, self._changed, strict=True):
            nodes = np.array(sorted(changed), np.int64)
            changed.clear()
            for part in np.array_split(nodes, -(-len(nodes) // _NODES_AT_ONCE) or 1):
                remembered = memory.recall(part)
                found += _as_estimates(
                    part, memory.level.name, remembered.stamps_ns, self._estimator(remembered)
                )
        return found


_NODES_AT_ONCE = 16  # bounds the memory of an estimate

_METRES = np.append((np.arange(CLEAR) / 1000).astype(np.float32), np.float32([np.inf, np.nan]))


def _as_estimates(nodes: Ints, level: str, stamps_ns: Ints, found: Estimated) -> list[Estimate]:
    metres = _METRES.take(found.ranges)
    support, plausibility = found.support.astype(np.float32), found.plausibility.astype(np.float32)
    samples = found.samples.astype(np.uint16)
    return [
        Estimate(node, level, stamp_ns, metres[i], support[i], plausibility[i], samples[i])
        for i, (node, stamp_ns) in enumerate(zip(nodes.tolist(), stamps_ns.tolist(), strict=True))
    ]


def _places(sweeps: Sweeps) -> Floats:
    """x, y [m] and yaw [rad] (n, 3) of the laser at its first beam, in the map frame."""
    pose = sweeps.map_from_laser_first
    return np.column_stack((pose[:, 0, 3], pose[:, 1, 3], np.arctan2(pose[:, 1, 0], pose[:, 0, 0])))
