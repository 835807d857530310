"""One place that is watched."""

from collections.abc import Sequence

import numpy as np

from timemap_cli.changes.difference import Change, Kind
from timemap_cli.changes.events import Episode, Event, Transition, Turn
from timemap_cli.changes.rings import Floats
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import GONE, STANDS, UNTOLD
from timemap_cli.changes.view import View

_GRID_M = 0.05  # points of an outline closer than this are one
_CONFIRMED = 2  # rounds in which an episode is seen, or seen undone, before it counts


class Track:
    """A change at its place: what every node and level says of it, and since when.

    Takes its side: +1 is a word for the change, -1 one against it.
    """

    def __init__(self, change: Change, levels: Sequence[str]) -> None:
        self.id: int | None = None  # given when it is reported
        self.kind = change.kind
        self.points = _thinned(change.points)
        self.moved_from = change.moved_from
        self.points_before = change.points_before
        self.adopted: dict[str, int | None] = dict.fromkeys(levels)
        self._levels = tuple(levels)
        self._support = change.support
        self._by_slower = False  # a slower level has told the outline
        self._words: dict[int, int] = {}  # newest word of each node, at the fastest level
        self._episodes: list[Episode] = []
        self._held = 0  # rounds in which the newest episode was seen
        self._lasting = 0  # episodes that were seen in more than one round
        self._undone_ns: int | None = None  # first scan that showed it undone, if it is not sure yet
        self._last_seen_ns = self._looked_ns = 0
        self._looks = self._looks_held = 0

    @property
    def is_open(self) -> bool:
        """Whether the change holds, by the newest word."""
        return bool(self._episodes) and self._episodes[-1].until_ns is None

    @property
    def is_sure(self) -> bool:
        """Whether it may be reported: a slower level has adopted it, or it lasted, went and came back."""
        adopted = any(self.adopted[level] is not None for level in self._levels[1:])
        return bool(self._episodes) and (adopted or self._lasting > 1)

    @property
    def is_over(self) -> bool:
        """Whether it may be forgotten: nothing but a passer-by."""
        return self.id is None and not self.is_open and not self._lasting

    def takes(self, kind: Kind) -> bool:
        """Whether a candidate of a kind at this place is this change seen again."""
        if kind is Kind.VANISHED or self.kind is Kind.VANISHED:
            return kind is self.kind
        return True

    def is_undone_by(self, kind: Kind) -> bool:
        """Whether a candidate of a kind at this place only says that this change is undone, for levels that had it."""
        opposite = (kind is Kind.VANISHED) != (self.kind is Kind.VANISHED)
        return opposite and (self.adopted[self._levels[-1]] is not None or not self.is_open)

    def refine(self, change: Change, *, slower: bool) -> None:
        """Learn from a candidate what the outline is, and whether it has only moved."""
        if slower or not self._by_slower:
            points = (
                np.concatenate((self.points, change.points)) if slower == self._by_slower else change.points
            )
            self.points = _thinned(points)
            self._support = change.support
        self._by_slower |= slower
        if change.kind is Kind.MOVED:
            self.kind, self.moved_from, self.points_before = (
                change.kind,
                change.moved_from,
                change.points_before,
            )

    def look(self, view: View, rules: Rules) -> list[Transition]:
        """Ask the renewed nodes about the place, level by level."""
        side = side_of(self.kind)
        said = {level: side * view.words(self.points, level, rules) for level in self._levels}
        fastest = said[self._levels[0]]
        told = np.flatnonzero(fastest)
        for row in told.tolist():
            self._words[int(view.places.numbers[row])] = int(fastest[row])
        now_ns = int(view.stamps_ns[told].max(initial=0))
        majority = {level: int(np.sign(word.astype(np.int64).sum())) for level, word in said.items()}
        turns = self._follow(majority, now_ns) if len(told) else []
        adopting = [
            level
            for level in self._levels
            if majority[level] > 0 and self.adopted[level] is None and self._episodes
        ]
        for level in adopting:
            self.adopted[level] = self._last_seen_ns
        if self.id is None:
            return []
        event = self.event()
        return [Transition(turn, event) for turn in turns] + [
            Transition(Turn.ADOPTED, event, level) for level in adopting
        ]

    def _follow(self, majority: dict[str, int], now_ns: int) -> list[Turn]:
        """Take the fastest level's newest word; that it is undone, a slower level or a second round must confirm."""
        word = majority[self._levels[0]]
        if word == UNTOLD:
            return []
        self._looked_ns = max(self._looked_ns, now_ns)
        self._looks += 1
        if word > 0:
            self._looks_held += 1
            return self._hold(now_ns)
        if not self.is_open:
            return []
        sure = self._undone_ns is not None or any(majority[level] < 0 for level in self._levels[1:-1])
        self._undone_ns = self._undone_ns or now_ns
        if not sure:
            return []
        self._episodes[-1] = Episode(self._episodes[-1].since_ns, self._undone_ns)
        self._undone_ns = None
        return [Turn.CLOSED]

    def _hold(self, now_ns: int) -> list[Turn]:
        turns = []
        self._undone_ns = None
        if not self.is_open:
            turns = [Turn.REOPENED] if self._episodes else []
            self._episodes.append(Episode(now_ns, None))
            self._held = 0
        self._held += 1
        self._lasting += self._held == _CONFIRMED
        self._last_seen_ns = max(self._last_seen_ns, now_ns)
        return turns

    def event(self) -> Event:
        """The change as it is known now."""
        return Event(
            id=-1 if self.id is None else self.id,
            kind=self.kind,
            points=self.points,
            moved_from=self.moved_from,
            support=self._support,
            first_seen_ns=self._episodes[0].since_ns,
            last_seen_ns=self._last_seen_ns,
            looked_ns=self._looked_ns,
            adopted=dict(self.adopted),
            nodes=tuple(sorted(node for node, word in self._words.items() if word > 0)),
            against=tuple(sorted(node for node, word in self._words.items() if word < 0)),
            episodes=tuple(self._episodes),
            looks=self._looks,
            looks_held=self._looks_held,
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
