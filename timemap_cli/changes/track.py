"""One place that is watched."""

from collections.abc import Sequence
from dataclasses import astuple, dataclass, field, fields

import numpy as np

from timemap_cli.changes.difference import Change, Kind
from timemap_cli.changes.events import Episode, Event, Transition, Turn
from timemap_cli.changes.rings import Floats
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import GONE, STANDS, UNTOLD
from timemap_cli.changes.view import View
from timemap_cli.model.state import State

_GRID_M = 0.05  # points of an outline closer than this are one
_CONFIRMED = 2  # rounds in which an episode is seen, or seen undone, before it counts


@dataclass(slots=True, eq=False)
class Track:
    """A change at its place: what every node and level says of it, and since when.

    Takes its side: +1 is a word for the change, -1 one against it.
    """

    levels: tuple[str, ...]
    kind: Kind
    points: Floats
    support: float
    moved_from: tuple[float, float] | None
    points_before: Floats | None
    adopted: dict[str, int | None]
    alone: bool = False  # it was seen whole, with something farther on either side
    id: int | None = None  # given when it is reported
    by_slower: bool = False  # a slower level has told the outline
    words: dict[int, int] = field(default_factory=dict)  # newest word of each node, at the fastest level
    episodes: list[Episode] = field(default_factory=list)
    held: int = 0  # rounds in which the newest episode was seen
    lasting: int = 0  # episodes that were seen in more than one round
    undone_ns: int | None = None  # first scan that showed it undone, if it is not sure yet
    last_seen_ns: int = 0
    looked_ns: int = 0
    looks: int = 0
    looks_held: int = 0

    @classmethod
    def of(cls, change: Change, levels: Sequence[str]) -> "Track":
        """A change that was just found."""
        return cls(
            tuple(levels),
            change.kind,
            _thinned(change.points),
            change.support,
            change.moved_from,
            change.points_before,
            dict.fromkeys(levels),
            change.alone,
        )

    def kept(self) -> State:
        """All that is known, for `restored`, in a form that JSON can hold."""
        before = self.points_before
        return {one.name: getattr(self, one.name) for one in fields(self)} | {
            "kind": self.kind.value,
            "points": self.points.tolist(),
            "points_before": None if before is None else before.tolist(),
            "words": list(self.words.items()),
            "episodes": [astuple(episode) for episode in self.episodes],
        }

    @classmethod
    def restored(cls, state: State) -> "Track":
        """The track that was kept."""
        before, moved_from = state["points_before"], state["moved_from"]
        told = {
            "levels": tuple(state["levels"]),
            "kind": Kind(state["kind"]),
            "points": np.array(state["points"], np.float64),
            "points_before": None if before is None else np.array(before, np.float64),
            "moved_from": None if moved_from is None else tuple(moved_from),
            "words": dict(state["words"]),
            "episodes": [Episode(*times) for times in state["episodes"]],
        }
        return cls(**(state | told))

    @property
    def is_open(self) -> bool:
        """Whether the change holds, by the newest word."""
        return bool(self.episodes) and self.episodes[-1].until_ns is None

    @property
    def is_sure(self) -> bool:
        """Whether it may be reported: a slower level has adopted it, or it lasted, went and came back."""
        adopted = any(self.adopted[level] is not None for level in self.levels[1:])
        return bool(self.episodes) and (adopted or self.lasting > 1)

    @property
    def is_over(self) -> bool:
        """Whether it may be forgotten: nothing but a passer-by."""
        return self.id is None and not self.is_open and not self.lasting

    @property
    def since_ns(self) -> int:
        """Since when the newest episode holds; there is at least one."""
        return self.episodes[-1].since_ns

    def has_moved_from(self, points: Floats) -> None:
        """Take note that what appeared is what left an outline (n, 2) [m, map frame] elsewhere."""
        x, y = points.mean(axis=0).tolist()
        self.kind, self.moved_from, self.points_before = Kind.MOVED, (x, y), points

    def takes(self, kind: Kind) -> bool:
        """Whether a candidate of a kind at this place is this change seen again."""
        if kind is Kind.VANISHED or self.kind is Kind.VANISHED:
            return kind is self.kind
        return True

    def is_undone_by(self, kind: Kind) -> bool:
        """Whether a candidate of a kind at this place only says that this change is undone, for levels that had it."""
        opposite = (kind is Kind.VANISHED) != (self.kind is Kind.VANISHED)
        return opposite and (self.adopted[self.levels[-1]] is not None or not self.is_open)

    def refine(self, change: Change, *, slower: bool) -> None:
        """Learn from a candidate what the outline is, and whether it has only moved."""
        if slower or not self.by_slower:
            points = (
                np.concatenate((self.points, change.points)) if slower == self.by_slower else change.points
            )
            self.points = _thinned(points)
            self.support = change.support
        self.by_slower |= slower
        self.alone |= change.alone
        if change.kind is Kind.MOVED:
            self.kind, self.moved_from, self.points_before = (
                change.kind,
                change.moved_from,
                change.points_before,
            )

    def look(self, view: View, rules: Rules) -> list[Transition]:
        """Ask the renewed nodes about the place, level by level."""
        side = side_of(self.kind)
        said = {level: side * view.words(self.points, level, rules) for level in self.levels}
        fastest = said[self.levels[0]]
        told = np.flatnonzero(fastest)
        for row in told.tolist():
            self.words[int(view.places.numbers[row])] = int(fastest[row])
        now_ns = int(view.stamps_ns[told].max(initial=0))
        majority = {level: int(np.sign(word.astype(np.int64).sum())) for level, word in said.items()}
        turns = self._follow(majority, now_ns) if len(told) else []
        adopting = [
            level
            for level in self.levels
            if majority[level] > 0 and self.adopted[level] is None and self.episodes
        ]
        for level in adopting:
            self.adopted[level] = self.last_seen_ns
        if self.id is None:
            return []
        event = self.event()
        return [Transition(turn, event) for turn in turns] + [
            Transition(Turn.ADOPTED, event, level) for level in adopting
        ]

    def _follow(self, majority: dict[str, int], now_ns: int) -> list[Turn]:
        """Take the fastest level's newest word; that it is undone, a slower level or a second round must confirm."""
        word = majority[self.levels[0]]
        if word == UNTOLD:
            return []
        self.looked_ns = max(self.looked_ns, now_ns)
        self.looks += 1
        if word > 0:
            self.looks_held += 1
            return self._hold(now_ns)
        if not self.is_open:
            return []
        sure = self.undone_ns is not None or any(majority[level] < 0 for level in self.levels[1:-1])
        self.undone_ns = self.undone_ns or now_ns
        if not sure:
            return []
        self.episodes[-1] = Episode(self.episodes[-1].since_ns, self.undone_ns)
        self.undone_ns = None
        return [Turn.CLOSED]

    def _hold(self, now_ns: int) -> list[Turn]:
        turns = []
        self.undone_ns = None
        if not self.is_open:
            turns = [Turn.REOPENED] if self.episodes else []
            self.episodes.append(Episode(now_ns, None))
            self.held = 0
        self.held += 1
        self.lasting += self.held == _CONFIRMED
        self.last_seen_ns = max(self.last_seen_ns, now_ns)
        return turns

    def event(self) -> Event:
        """The change as it is known now."""
        return Event(
            id=-1 if self.id is None else self.id,
            kind=self.kind,
            points=self.points,
            moved_from=self.moved_from,
            support=self.support,
            first_seen_ns=self.episodes[0].since_ns,
            last_seen_ns=self.last_seen_ns,
            looked_ns=self.looked_ns,
            adopted=dict(self.adopted),
            nodes=tuple(sorted(node for node, word in self.words.items() if word > 0)),
            against=tuple(sorted(node for node, word in self.words.items() if word < 0)),
            episodes=tuple(self.episodes),
            looks=self.looks,
            looks_held=self.looks_held,
        )


def side_of(kind: Kind) -> int:
    """The word that speaks for a change of this kind."""
    return GONE if kind is Kind.VANISHED else STANDS


def _thinned(points: Floats) -> Floats:
    """One of the points (n, 2) in each cell of a grid, the same whatever their order."""
    points = points[np.lexsort(points.T)]
    cells = np.floor(points / _GRID_M).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return points[first]
