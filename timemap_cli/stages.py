"""The two ends of a replay: scans become what the nodes see, and what was learnt of it is written."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple

from timemap_cli.changes.ghosts import without_ghosts
from timemap_cli.changes.tracker import Tracker
from timemap_cli.logs.coming import Coming, EndOfRecording, Resumed, ScanCounts, Waiting
from timemap_cli.logs.drive_stream import LEAST_SCANS
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.stream import sweeps
from timemap_cli.logs.survey import Survey
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.learner import Asked, Keep, Kept, Learnt, Mark, Round
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observations, Observer, gathered
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.pauses import Pause, longest
from timemap_cli.results.state_messages import Part, StatePart
from timemap_cli.results.writer import ResultWriter


class Observing:
    """Reads the recordings and turns their scans into what the nodes see; counts what becomes of every scan."""

    def __init__(self, recordings: Sequence[Recording], plan: Survey, observer: Observer) -> None:
        self.counts = ScanCounts()
        self.used = 0
        self.newest_ns: int | None = None
        self.began_anew = False  # stamps went back from one recording to the next
        self.pause: Pause | None = None  # the first that no robot makes
        self.state: State = {}  # what a later replay needs, once `steps` asks the memory for its part
        self._recordings = recordings
        self._plan = plan
        self._observer = observer
        self._earlier: State | None = None

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

    def restore(self, earlier: State) -> None:
        """Go on from the `state` of an earlier replay."""
        self._earlier = earlier
        self.newest_ns = earlier["newest_ns"]
        self._observer.restore(without_prefix("observer", earlier))

    def set_aside(self, scans: int) -> None:
        """Take note that so many of the scans seen were not learnt."""
        self.used -= scans
        self.counts.drop("lost", scans)

    def steps(self, start_ns: int | None, end_ns: int | None) -> Iterator[Asked]:
        """Blocks of observations in stamp order, and what comes between them.

        At the end of all recordings, before what waits to the last, the memory is asked for all that it holds.
        """
        plan, counts = self._plan, self.counts
        blocks = sweeps(
            self._recordings,
            plan.selection,
            plan.beams,
            counts,
            start_ns=start_ns,
            end_ns=end_ns,
            drives=plan.drives_within(None if self._earlier is None else start_ns, end_ns),
            latest_ns=plan.latest_ns,
            limits=plan.pose_limits,
            earlier=None if self._earlier is None else without_prefix("stream", self._earlier),
        )
        # Two scanners in turn, or bearings that differ from scan to scan, make blocks of one scan.
        waiting: list[Observations] = []
        for block in blocks:
            between = not isinstance(block, Sweeps)
            if isinstance(block, Sweeps):
                waiting.append(self._observed(block))
            if waiting and (between or sum(map(len, waiting)) >= LEAST_SCANS):
                yield gathered(waiting)
                waiting = []
            yield from self._between(block)
        if waiting:
            yield gathered(waiting)

    def _between(self, block: Coming) -> Iterator[Asked]:
        """What is to be done for what comes between the blocks of scans."""
        if isinstance(block, EndOfRecording):
            yield Mark.RECORDING_ENDS
        elif isinstance(block, Resumed):
            self.used = self.counts.read = 0  # the earlier replay has counted them
            self.counts.dropped.clear()
            yield Mark.RESUMED
        elif isinstance(block, Waiting):
            self.state = self._kept() | prefixed("stream", block.state)
            yield Keep(None)
            yield from map(Keep, range(len(self.nodes)))

    def _kept(self) -> State:
        chosen = self._plan.selection
        selection = {
            "scan_topics": chosen.scan_topics,
            "map_frame": chosen.map_frame,
            "pose": chosen.pose,
            "covariances": chosen.covariances,
        }
        observer = prefixed("observer", self._observer.kept())
        return {
            "newest_ns": self.newest_ns,
            "selection": selection,
            "missing_so_far": {topic: astuple(found) for topic, found in self._plan.missing_so_far.items()},
            **observer,
        }

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
            self.pause = self.pause or longest(self.newest_ns, seen.stamps_ns)
            self.newest_ns = int(seen.stamps_ns[-1])


class Writing:
    """Writes what was learnt into the result, and follows the changes in it."""

    def __init__(self, result: ResultWriter, levels: Sequence[str], tracker: Tracker) -> None:
        """`levels` are all there are; the tracker may leave out some."""
        self.tracker = tracker
        self.nodes: Sequence[Node] = ()
        self.shortfalls: Mapping[str, float] = {}
        self._result = result
        self._latest: dict[str, dict[int, Estimate]] = {level: {} for level in levels}
        self._newest_ns = 0
        self._round_ns: int | None = None  # newest scan of the newest round of this result
        self._maps_are_due = False
        self._maps_are_missing = False  # an earlier result had them, and this one has none
        self._is_new = True  # what comes; else an earlier result has it
        self._is_known_to_all = True  # what an earlier result had stands in this one

    @property
    def span_ns(self) -> int:
        """Time that the result spans so far."""
        return self._result.span_ns

    @property
    def is_new(self) -> bool:
        """Whether what comes is of the recordings, not what an earlier replay has written."""
        return self._is_new

    def restore(self, parts: Iterable[StatePart], nodes: Sequence[Node]) -> None:
        """Go on from what an earlier replay kept; `nodes` are the observer's."""
        for kept in parts:
            if kept.part is Part.NODE:
                self._restore_node(kept)
            elif kept.part is Part.CHANGES:
                self._maps_are_due, known = kept.state["maps_are_due"], kept.state["nodes"]
                self.nodes, self._newest_ns = nodes[:known], kept.state["newest_ns"]
                self.tracker.restore(without_prefix("tracker", kept.state))
        self._is_new = self._is_known_to_all = False

    def take(self, learnt: Learnt, all_nodes: Sequence[Node]) -> None:
        """Write what came of one step; `all_nodes` holds at least those that it speaks of."""
        self.shortfalls = learnt.shortfalls
        for made in learnt.rounds:
            self._follow(made, all_nodes[: made.nodes])
        if learnt.mark is Mark.RECORDING_ENDS and (self._maps_are_due or self._maps_are_missing):
            if self._is_new:
                self._result.write_maps(self._standing(), self.nodes, self._newest_ns)
            self._maps_are_due = self._maps_are_missing = False  # recordings may end together
        self._is_new |= learnt.mark is Mark.RESUMED

    def _standing(self) -> dict[str, dict[int, Estimate]]:
        """The newest estimates by level and node, without what other nodes have seen gone since."""
        return {
            level: without_ghosts(self.nodes, latest, self.tracker.left(level), self.tracker.radius)
            for level, latest in self._latest.items()
        }

    def keep(self, kept: Kept, reading: State) -> None:
        """Write a part of what a later replay needs; the first one brings the `reading` side's along."""
        if kept.node is None:
            changes = {
                "maps_are_due": self._maps_are_due,
                "nodes": len(self.nodes),
                "newest_ns": self._newest_ns,
            }
            changes |= prefixed("tracker", self.tracker.kept())
            self._keep(Part.READING, reading)
            self._keep(Part.LEARNING, kept.state)
            self._keep(Part.CHANGES, changes)
        else:
            self._keep(Part.NODE, kept.state | self._kept_of(kept.node), kept.node)

    def _keep(self, part: Part, state: State, node: int = 0) -> None:
        """The state is logged with the round before it: what comes of the scans that wait is not pushed behind it."""
        self._result.write_state(StatePart(part, node, state), self._round_ns)

    def _kept_of(self, node: int) -> State:
        state = prefixed("before", self.tracker.kept_before(node))
        for level, latest in self._latest.items():
            if node in latest:
                state |= prefixed(f"latest.{level}", latest[node].kept())
        return state

    def _restore_node(self, kept: StatePart) -> None:
        self.tracker.restore_before(kept.node, without_prefix("before", kept.state))
        for level, latest in self._latest.items():
            if state := without_prefix(f"latest.{level}", kept.state):
                latest[kept.node] = Estimate.restored(kept.node, level, state)

    def _follow(self, made: Round, nodes: Sequence[Node]) -> None:
        if self._is_new:
            self._round_ns = made.newest_ns
            self._write(made, nodes)
        if made.estimates:
            self.nodes, self._newest_ns = nodes, made.newest_ns
        for estimate in made.estimates:
            self._latest[estimate.level][estimate.node] = estimate
            self._maps_are_due = True
        followed = [estimate for estimate in made.estimates if estimate.level in self.tracker.levels]
        found = self.tracker.update(nodes, self._latest, followed)
        if found and self._is_new:
            self._result.write_changes(found, self.tracker.events, made.newest_ns)

    def _write(self, made: Round, nodes: Sequence[Node]) -> None:
        if not self._is_known_to_all:
            known = [estimate for latest in self._latest.values() for estimate in latest.values()]
            self._result.write_known(self.nodes, known, made.newest_ns)
            if self.tracker.events:
                self._result.write_changes([], self.tracker.events, made.newest_ns)
            self._is_known_to_all = self._maps_are_missing = True
        self._result.write_nodes(nodes, made.newest_ns)
        self._result.write_estimates(made.estimates, made.newest_ns)
