"""Which scans are not learnt: those of a lost robot contradict nearly all that their node has long held.

A changed world is told from a lost robot by what the robot saw at the nodes before (`Whereabouts`); where that does
not tell them apart, by scans that go on to contradict, and agree with each other while the robot moves.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from timemap_cli.model.contradiction import Bounds, firm_ranges
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.observer import Observations
from timemap_cli.model.state import State
from timemap_cli.model.virtual_scan import UNSEEN, Bools, Ranges
from timemap_cli.model.whereabouts import Whereabouts

ENOUGH_SCANS = 15  # samples behind a range that judges; and scans of a moving robot that overrule it ...
PERSISTENCE_NS = 600_000_000_000  # ... if so much time lies between the first of them and the last
AGREEMENT = 0.5  # of the share that sets aside: two scans of one world contradict each other in less


@dataclass(frozen=True, slots=True)
class Doubt:
    """The world as scans that were set aside at a node show it."""

    witness: Ranges  # (angle_bins,) virtual scan [mm] or a code
    since_ns: int  # stamp of the first of them
    votes: int  # how many more of them agree with it than contradict it, taken while the robot moved

    def prevails(self, stamp_ns: int) -> bool:
        """Whether it has been confirmed often and long enough."""
        lasted = not 0 <= stamp_ns - self.since_ns < PERSISTENCE_NS  # below 0: the clock began anew
        return self.votes >= ENOUGH_SCANS and lasted


class Guard:
    """Judges scans by the newest estimate that the slowest level made of their node."""

    def __init__(self, max_contradiction: float, *, angle_bins: int, radius: float, window: int) -> None:
        """`max_contradiction`: share of the angle bins from which on a scan may be set aside; at 1 none is.

        `radius`: how far a node looks [m]; `window`: samples that the slowest level holds.
        """
        self._max = max_contradiction
        self._reach = math.floor(radius * 1000 + 1e-6)
        self._min_samples = min(ENOUGH_SCANS, window)
        self._expected = Bounds.open(0, angle_bins)  # a row for each node
        self._doubts: dict[int, Doubt] = {}  # by node
        self._whereabouts = Whereabouts(max_contradiction, angle_bins)

    def expect(self, estimates: Iterable[Estimate]) -> None:
        """Judge their nodes by these estimates of the slowest level from now on."""
        found = list(estimates)
        if not found or self._max >= 1:
            return
        nodes = np.array([estimate.node for estimate in found], np.int64)
        bounds = Bounds.around(firm_ranges(found, self._min_samples), self._reach)
        self._expected = self._expected.with_rows(nodes, bounds)
        self._whereabouts.forget(set(nodes.tolist()))
        for node in self._doubts.keys() & set(nodes.tolist()):
            if self._agree(self._doubts[node].witness, self._expected.rows(np.array([node]))):
                del self._doubts[node]  # it has been learnt

    def believed(self, seen: Observations) -> Bools:
        """Which of n observations may be learnt (n,); they must come in stamp order."""
        believed = np.ones(len(seen), np.bool_)
        shares = self._contradictions(seen).tolist()
        rows = zip(seen.nodes.tolist(), seen.stamps_ns.tolist(), shares, strict=True)
        for row, (node, stamp_ns, share) in enumerate(rows):
            self._whereabouts.come_to(stamp_ns)
            if math.isnan(share):
                continue
            self._whereabouts.see(node, seen.ranges[row], share)
            doubtful = share >= self._max
            if doubtful and not self._whereabouts.are_wrong(seen.ranges[row], self._expected):
                continue
            if doubtful or node in self._doubts:
                believed[row] = self._hear(seen, row, doubtful=doubtful)
        return believed

    def _contradictions(self, seen: Observations) -> npt.NDArray[np.float64]:
        """Share (n,) of each observation that contradicts what is expected; NaN where too little is."""
        shares = np.full(len(seen), np.nan)
        rows = np.flatnonzero(seen.nodes < len(self._expected))
        shares[rows] = self._expected.rows(seen.nodes[rows]).contradiction(seen.ranges[rows])
        return shares

    def kept_of_all(self) -> State:
        """What is known of the robot, for `restore_of_all`."""
        return self._whereabouts.kept()

    def restore_of_all(self, state: State) -> None:
        """Take over what another guard kept of no node alone."""
        self._whereabouts.restore(state)

    def kept(self, node: int) -> State:
        """What is expected of a node, and doubted, for `restore`."""
        state: State = {}
        if node < len(self._expected) and self._expected.say_something(node):
            state |= {"low": self._expected.low[node], "width": self._expected.width[node]}
        if (doubt := self._doubts.get(node)) is not None:
            state |= {"witness": doubt.witness, "since_ns": doubt.since_ns, "votes": doubt.votes}
        return state

    def restore(self, node: int, state: State) -> None:
        """Take over what another guard kept of a node."""
        if "low" in state:
            bounds = Bounds(state["low"][None], state["width"][None])
            self._expected = self._expected.with_rows(np.array([node]), bounds)
        if "witness" in state:
            self._doubts[node] = Doubt(state["witness"], state["since_ns"], state["votes"])

    def _hear(self, seen: Observations, row: int, *, doubtful: bool) -> bool:
        """Whether one observation may be learnt, after what it says about its node's doubt was heard."""
        node, stamp_ns, ranges = int(seen.nodes[row]), int(seen.stamps_ns[row]), seen.ranges[row]
        moved, doubt = bool(seen.passes[row]), self._doubts.get(node)
        agrees = doubt is None or not self._contradict(ranges, doubt)
        if not doubtful:
            if moved and not agrees:  # things are as the node has long held
                del self._doubts[node]
            return True
        if moved:
            doubt = self._doubts[node] = _heard(doubt, ranges, stamp_ns, agrees=agrees)
        return agrees and doubt is not None and doubt.prevails(stamp_ns)

    def _contradict(self, ranges: Ranges, doubt: Doubt) -> bool:
        around = Bounds.around(doubt.witness[None], self._reach)
        return bool(around.contradiction(ranges[None])[0] >= AGREEMENT * self._max)

    def _agree(self, ranges: Ranges, expected: Bounds) -> bool:
        return bool(expected.contradiction(ranges[None])[0] < AGREEMENT * self._max)


def _heard(doubt: Doubt | None, ranges: Ranges, stamp_ns: int, *, agrees: bool) -> Doubt:
    """A doubt after one more scan that was set aside: the majority vote of Boyer and Moore.

    A scan that has too little in common with the witness agrees, and adds what it saw to it.
    """
    if doubt is None or (not agrees and doubt.votes == 0):
        return Doubt(ranges.copy(), stamp_ns, 1)
    if not agrees:
        return replace(doubt, votes=doubt.votes - 1)
    witness = np.where(doubt.witness == UNSEEN, ranges, doubt.witness)
    return replace(doubt, witness=witness, votes=min(ENOUGH_SCANS, doubt.votes + 1))
