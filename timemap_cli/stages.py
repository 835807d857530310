"""The two ends of a replay: scans become what the nodes see, and what was learnt of it is written."""

from collections.abc import Iterator, Mapping, Sequence

from timemap_cli.changes.tracker import Tracker
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.stream import LEAST_SCANS, EndOfRecording, ScanCounts, sweeps
from timemap_cli.logs.survey import Survey
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.learner import Learnt, Round
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observations, Observer, gathered
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.results.writer import ResultWriter


class Observing:
    """Reads the recordings and turns their scans into what the nodes see; counts what becomes of every scan."""

    def __init__(self, recordings: Sequence[Recording], plan: Survey, observer: Observer) -> None:
        self.counts = ScanCounts()
        self.used = 0
        self.newest_ns: int | None = None
        self.began_anew = False  # stamps went back from one recording to the next
        self._recordings = recordings
        self._plan = plan
        self._observer = observer

    @property
    def nodes(self) -> Sequence[Node]:
        """All nodes so far, in the order of their numbers."""
        return self._observer.nodes

    @property
    def damage(self) -> tuple[str, ...]:
        """What is wrong with the recordings, as far as read."""
        return tuple(f"{r.path}: {problem}" for r in self._recordings for problem in r.problems)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is odd about the recordings, while nothing of them is lost."""
        return tuple(f"{r.path}: {remark}" for r in self._recordings for remark in r.remarks)

    def set_aside(self, scans: int) -> None:
        """Take note that so many of the scans seen were not learnt."""
        self.used -= scans
        self.counts.drop("lost", scans)

    def steps(self, start_ns: int | None, end_ns: int | None) -> Iterator[Observations | None]:
        """Blocks of observations in stamp order; None where a recording has ended."""
        plan, counts = self._plan, self.counts
        blocks = sweeps(
            self._recordings,
            plan.selection,
            plan.beams,
            counts,
            start_ns=start_ns,
            end_ns=end_ns,
            drives=plan.drives,
            latest_ns=plan.latest_ns,
        )
        # Two scanners in turn, or bearings that differ from scan to scan, make blocks of one scan.
        waiting: list[Observations] = []
        for block in blocks:
            is_end = isinstance(block, EndOfRecording)
            if not isinstance(block, EndOfRecording):
                waiting.append(self._observed(block))
            if waiting and (is_end or sum(map(len, waiting)) >= LEAST_SCANS):
                yield gathered(waiting)
                waiting = []
            if is_end:
                yield None
        if waiting:
            yield gathered(waiting)

    def _observed(self, block: Sweeps) -> Observations:
        seen = self._observer.observe(block)
        self._count(seen)
        return seen

    def _count(self, seen: Observations) -> None:
        self.used += len(seen)
        self.counts.drop("node_not_seen", seen.node_not_seen)
        self.counts.drop("no_node", seen.no_node)
        if len(seen):
            self.began_anew |= self.newest_ns is not None and int(seen.stamps_ns[0]) < self.newest_ns
            self.newest_ns = int(seen.stamps_ns[-1])


class Writing:
    """Writes what was learnt into the result, and follows the changes in it."""

    def __init__(self, result: ResultWriter, tracker: Tracker) -> None:
        self.tracker = tracker
        self.nodes: Sequence[Node] = ()
        self.shortfalls: Mapping[str, float] = {}
        self._result = result
        self._latest: dict[str, dict[int, Estimate]] = {level: {} for level in tracker.levels}
        self._newest_ns = 0
        self._maps_are_due = False

    @property
    def span_ns(self) -> int:
        """Time that the result spans so far."""
        return self._result.span_ns

    def take(self, learnt: Learnt, all_nodes: Sequence[Node]) -> None:
        """Write what came of one step; `all_nodes` holds at least those that it speaks of."""
        self.shortfalls = learnt.shortfalls
        for made in learnt.rounds:
            self._write(made, all_nodes[: made.nodes])
        if learnt.ends_recording and self._maps_are_due:  # recordings may end together
            self._result.write_maps(self._latest, self.nodes, self._newest_ns)
            self._maps_are_due = False

    def _write(self, made: Round, nodes: Sequence[Node]) -> None:
        self.nodes, self._newest_ns = nodes, made.newest_ns
        self._result.write_nodes(nodes, made.newest_ns)
        self._result.write_estimates(made.estimates, made.newest_ns)
        for estimate in made.estimates:
            self._latest[estimate.level][estimate.node] = estimate
            self._maps_are_due = True
        found = self.tracker.update(nodes, self._latest, made.estimates)
        if found:
            self._result.write_changes(found, self.tracker.events, made.newest_ns)
