"""From scans to what their nodes learn from them: which node, whether it can be judged, and who may take it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from timemap_cli.model.elementary import bearings
from timemap_cli.model.free_ways import FreeWays, Outlook
from timemap_cli.model.gate import Gate, Passage, Passages, passing
from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import NO_NODE, Placement
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.model.virtual_scan import Bools, Ranges, virtual_scans

CHOICES = 3  # nodes that are tried for a scan: the nearest, and farther ones if it stands behind a wall

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Observations:
    """What n scans of a block say of their nodes, in stamp order, and what became of the block's other scans."""

    nodes: Ints  # (n,) number of the node
    stamps_ns: Ints  # (n,)
    ranges: Ranges  # (n, angle_bins) virtual scans [mm]
    passes: Bools  # (n,) slower levels may take it
    node_not_seen: int  # scans that say nothing of their node: it is hidden, or no beam is evidence
    no_node: int  # scans that no given node is near
    all_nodes: Sequence[Node]  # the observer's list, which only ever grows

    def __len__(self) -> int:
        return len(self.nodes)

    def part(self, rows: slice | Ints) -> "Observations":
        """These observations alone."""
        return replace(
            self,
            nodes=self.nodes[rows],
            stamps_ns=self.stamps_ns[rows],
            ranges=self.ranges[rows],
            passes=self.passes[rows],
        )


def gathered(some: Sequence[Observations]) -> Observations:
    """Observations of consecutive blocks as those of one; at least one."""
    if len(some) == 1:
        return some[0]
    return Observations(
        np.concatenate([one.nodes for one in some]),
        np.concatenate([one.stamps_ns for one in some]),
        np.concatenate([one.ranges for one in some]),
        np.concatenate([one.passes for one in some]),
        node_not_seen=sum(one.node_not_seen for one in some),
        no_node=sum(one.no_node for one in some),
        all_nodes=some[-1].all_nodes,
    )


@dataclass(frozen=True, slots=True)
class _Seen:
    """What becomes of n scans; filled in as it is found out."""

    nodes: Ints  # (n,)
    judged: Bools  # (n,) the scan says something of its node
    ranges: Ranges  # (n, angle_bins) [mm]

    @classmethod
    def nothing(cls, n: int, angle_bins: int) -> "_Seen":
        return cls(np.full(n, NO_NODE), np.zeros(n, np.bool_), np.empty((n, angle_bins), np.uint16))


class Observer:
    """Gives every scan to its node and turns it into what it would have been from there."""

    def __init__(
        self,
        gate: Gate,
        *,
        angle_bins: int,
        radius: float,
        spacing: float,
        nodes: Sequence[Node] = (),
        likely: Sequence[Node] = (),
    ) -> None:
        """`radius`: how far a node looks [m]; given `nodes` are all there will be.

        `spacing` [m] and `likely` are as in Placement.
        """
        self._placement = Placement(spacing, nodes, likely)
        self._gate = gate
        self._passages: Passages = {}
        self._ways = FreeWays()
        self._angle_bins = angle_bins
        self._radius = radius

    @property
    def nodes(self) -> Sequence[Node]:
        """All nodes so far, in the order of their numbers."""
        return self._placement.nodes

    def kept(self) -> State:
        """What the observer holds, for `restore`."""
        passages = [(p.x, p.y, p.yaw) for p in self._passages.values()]
        return {
            "nodes": self._placement.centres,
            "all_given": self._placement.all_given,
            "passed": np.array(list(self._passages), np.int64).reshape(-1, 2),
            "passed_at": np.array(passages, np.float64).reshape(-1, 3),
            "passed_ns": np.array([p.stamp_ns for p in self._passages.values()], np.int64),
            **prefixed("ways", self._ways.kept()),
        }

    def restore(self, state: State) -> None:
        """Go on where another observer stopped."""
        self._placement.nodes = [Node(x, y) for x, y in state["nodes"].tolist()]
        self._placement.all_given = bool(state["all_given"])
        columns = (state[name].tolist() for name in ("passed", "passed_at", "passed_ns"))
        for (node, scanner), (x, y, yaw), stamp_ns in zip(*columns, strict=True):
            self._passages[node, scanner] = Passage(x, y, yaw, stamp_ns)
        self._ways.restore(without_prefix("ways", state))

    def observe(self, sweeps: Sweeps) -> Observations:
        """Observations from a block of scans; blocks must come in stamp order."""
        places = _places(sweeps)
        seen = self._seen(sweeps, places[:, :2])
        rows = np.flatnonzero(seen.judged)
        nodes, stamps_ns = seen.nodes[rows], sweeps.stamps_ns[rows]
        near = int(np.count_nonzero(seen.nodes != NO_NODE))
        return Observations(
            nodes,
            stamps_ns,
            seen.ranges[rows],
            passing(self._gate, nodes.tolist(), places[rows], stamps_ns, self._passages, sweeps.scanner),
            node_not_seen=near - len(rows),
            no_node=len(sweeps) - near,
            all_nodes=self._placement.nodes,
        )

    def _seen(self, sweeps: Sweeps, places: Floats) -> "_Seen":
        """Give each scan to the nearest node that it can judge; where walls hide all of them, to a new one.

        `places` (n, 2) [m, map frame]. A new node changes what becomes of later scans: they begin anew.
        """
        seen = _Seen.nothing(len(sweeps), self._angle_bins)
        ways = self._ways.look(sweeps)
        begin = 0
        while begin < len(sweeps):
            rows = np.arange(begin, len(sweeps))
            seen.nodes[rows], known = self._placement.assign(places[rows])
            unseen = self._judge(seen, rows[seen.nodes[rows] != NO_NODE], sweeps, ways)
            unseen = self._judge_farther(seen, unseen, known[unseen - begin], places, sweeps, ways)
            hidden = unseen[ways.are_blocked(unseen, self._placement.centres_of(seen.nodes[unseen]))]
            number = int(known[hidden[0] - begin]) if len(hidden) else 0
            if not len(hidden) or not self._placement.may_insert(number):
                break
            begin = int(hidden[0])
            self._placement.insert(places[begin], number)
        return seen

    def _judge(self, seen: "_Seen", rows: Ints, sweeps: Sweeps, ways: Outlook) -> Ints:
        """See the nodes of the scans `rows` (k,) from their places; returns the rows that cannot judge theirs."""
        centres = self._placement.centres_of(seen.nodes[rows])
        free = ways.free(rows, centres)
        seen.ranges[rows], judged = virtual_scans(
            sweeps.rows(rows), centres, free, self._angle_bins, self._radius
        )
        seen.judged[rows] = judged
        return rows[~judged]

    def _judge_farther(
        self, seen: "_Seen", hidden: Ints, known: Ints, places: Floats, sweeps: Sweeps, ways: Outlook
    ) -> Ints:
        """Give scans whose nearest node is `hidden` (k,) to the next that they see, of those `known` (k,) by then."""
        for choice in range(1, CHOICES):
            near, node = self._placement.farther(places[hidden], known, choice)
            rows = hidden[near]
            before = seen.nodes[rows]
            seen.nodes[rows] = node[near]
            still = self._judge(seen, rows, sweeps, ways)
            seen.nodes[still] = before[np.isin(rows, still)]
            left = ~seen.judged[hidden]
            hidden, known = hidden[left], known[left]
        return hidden


def _places(sweeps: Sweeps) -> Floats:
    """x, y [m] and yaw [rad] (n, 3) of the laser at its first beam, in the map frame."""
    pose = sweeps.map_from_laser_first
    return np.column_stack((pose[:, 0, 3], pose[:, 1, 3], bearings(pose[:, 0, 0], pose[:, 1, 0])))
