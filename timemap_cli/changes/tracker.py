"""Follows changes over time: found where a faster level differs from the slowest, then watched at their places.

A level that differs from what the slowest held a round ago gives a candidate (`compare`); in a young memory all levels
turn at once. Its place is watched from then on: in every
round of estimates the nodes just renewed are asked whether the surface stands there or one sees past it, at every
level. So a level adopts, an event is undone, and comes back. What nobody looked at is left as it was.

The fastest level is quick to believe a passer-by. An event is reported when a slower level has adopted it, or when it
came back after it had been undone; until then it is only suspected, and forgotten when it goes.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from timemap_cli.changes.compare import news
from timemap_cli.changes.difference import Change, Kind
from timemap_cli.changes.events import Event, Transition, Turn
from timemap_cli.changes.matching import best_match, overlap
from timemap_cli.changes.moves import pair_moves
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side
from timemap_cli.changes.track import Track
from timemap_cli.changes.view import View
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.state import State

Estimates = Mapping[str, Mapping[int, Estimate]]  # newest of each level and node
_DEFAULT = Rules()


class Tracker:
    """All events of a map so far, and what is suspected."""

    def __init__(self, levels: Sequence[str], radius: float, rules: Rules = _DEFAULT) -> None:
        """`levels` fastest first; `radius` [m] is how far a node sees. One level alone has no events."""
        self.levels = tuple(levels)
        self.radius = radius
        self._rules = rules
        self._tracks: list[Track] = []
        self._reported = 0
        self._before: dict[int, Estimate] = {}  # by node: the slowest level's, of an earlier round

    @property
    def events(self) -> tuple[Event, ...]:
        """All events reported so far, in the order in which they were."""
        found = [track.event() for track in self._tracks if track.id is not None]
        return tuple(sorted(found, key=lambda event: event.id))

    def left(self, level: str) -> list[Event]:
        """Events that hold and that a level has adopted, with the outline of what stood where nothing stands now."""
        adopted = [t for t in self._tracks if t.id is not None and t.is_open and t.adopted[level] is not None]
        gone = [track.event() for track in adopted if track.kind is Kind.VANISHED]
        moved = [(track.event(), track.points_before) for track in adopted if track.kind is Kind.MOVED]
        return gone + [replace(event, points=points) for event, points in moved if points is not None]

    def kept(self) -> State:
        """What is watched, for `restore`; what the slowest level held before goes with the nodes."""
        return {"reported": self._reported, "tracks": [track.kept() for track in self._tracks]}

    def kept_before(self, node: int) -> State:
        """What the slowest level held of a node in an earlier round, for `restore_before`."""
        before = self._before.get(node)
        return before.kept() if before is not None else {}

    def restore(self, state: State) -> None:
        """Go on watching what another tracker kept."""
        self._reported = state["reported"]
        self._tracks = [Track.restored(one) for one in state["tracks"]]

    def restore_before(self, node: int, state: State) -> None:
        """Take over what another tracker kept of a node."""
        if state:
            self._before[node] = Estimate.restored(node, self.levels[-1], state)

    def update(
        self, nodes: Sequence[Node], newest: Estimates, renewed: Sequence[Estimate]
    ) -> list[Transition]:
        """Take note of a round of estimates; `newest` holds them already. Returns what was found out."""
        if len(self.levels) < 2 or not renewed:
            return []
        view = View.of({estimate.node for estimate in renewed}, nodes, newest, self.levels, self.radius)
        if view is None:
            return []
        found: list[Transition] = []
        for level, change in self._candidates(nodes, view):
            found += self._sight(change, level)
        slowest = self.levels[-1]
        self._before |= view.estimates[slowest]
        for track in self._tracks:
            found += track.look(view, self._rules)
        self._tracks = [track for track in self._tracks if not track.is_over]
        return found + self._join_moved() + self._report()

    def _candidates(self, nodes: Sequence[Node], view: View) -> Iterator[tuple[str, Change]]:
        """Changes from what the slowest level held before this round to each level now, slower levels first."""
        before = {n: e for n, e in self._before.items() if view.has_in_reach(nodes[n])}
        if not before:
            return
        held = Side.of(before, nodes, self.radius, self._rules)
        for level in reversed(self.levels):  # slower levels know the outline better
            rules = Rules.of_candidates(is_fastest=level == self.levels[0])
            renewed = {
                n: e
                for n, e in view.estimates[level].items()
                if n not in before or before[n].stamp_ns != e.stamp_ns
            }
            if renewed:
                for change in news(held, Side.of(renewed, nodes, self.radius, rules), rules):
                    yield level, change

    def _sight(self, change: Change, level: str) -> list[Transition]:
        """Put a candidate where it belongs: to what is watched there already, or to something new."""
        dropped: list[Transition] = []
        if change.points_before is not None:  # moved: one event, with what was known of it as vanished
            gone = best_match(change.points_before, [t for t in self._tracks if t.kind is Kind.VANISHED])
            if gone is not None:
                dropped = self._drop(gone)
        same = [t for t in self._tracks if t.takes(change.kind)]
        track = best_match(change.points, same)
        if track is not None:
            track.refine(change, slower=level != self.levels[0])
            for other in [t for t in same if t is not track and overlap(t.points, track.points) > 0.5]:
                dropped += self._drop(other)
        elif not self._is_told(change):
            self._tracks.append(Track.of(change, self.levels))
        return dropped

    def _join_moved(self) -> list[Transition]:
        """Make one of what vanished here and appeared there, in another room perhaps, on the same round."""
        sure = [
            track for track in self._tracks if track.is_open and track.is_sure and track.moved_from is None
        ]
        newest_ns = max((track.since_ns for track in sure), default=0)
        lately = [track for track in sure if track.since_ns >= newest_ns - self._rules.max_age_ns]
        gone = [track for track in lately if track.kind is Kind.VANISHED]
        come = [track for track in lately if track.kind is Kind.APPEARED]
        dropped: list[Transition] = []
        for left, entered in pair_moves(gone, come, self._rules) if gone and come else ():
            come[entered].has_moved_from(gone[left].points)
            dropped += self._drop(gone[left])
        return dropped

    def _is_told(self, change: Change) -> bool:
        """Whether a candidate only says that something is undone, or that its place is left since it moved."""
        undone = [track for track in self._tracks if track.is_undone_by(change.kind)]
        left = [track.points_before for track in self._tracks if track.points_before is not None]
        return best_match(change.points, undone) is not None or (
            change.kind is Kind.VANISHED and any(overlap(change.points, points) > 0.5 for points in left)
        )

    def _drop(self, track: Track) -> list[Transition]:
        self._tracks = [one for one in self._tracks if one is not track]
        return [Transition(Turn.DROPPED, track.event())] if track.id is not None else []

    def _report(self) -> list[Transition]:
        """Events that are sure enough now."""
        found = []
        for track in self._tracks:
            if track.id is None and track.is_sure:
                track.id = self._reported
                self._reported += 1
                found.append(Transition(Turn.SEEN, track.event()))
                found += [
                    Transition(Turn.ADOPTED, track.event(), level)
                    for level in self.levels
                    if track.adopted[level] is not None
                ]
        return found
