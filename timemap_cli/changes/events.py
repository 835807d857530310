"""What became of one place of the map over time."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from timemap_cli.changes.difference import Kind
from timemap_cli.changes.rings import Floats

Bounds = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Episode:
    """A time in which the change held: from the first scan that showed it to the first that showed it undone."""

    since_ns: int
    until_ns: int | None  # None: it still holds, as far as anybody has looked


@dataclass(frozen=True, slots=True)
class Event:
    """A change of one place, and when it was seen, adopted and undone.

    Times are header stamps of scans. Where a thing appeared or moved to, the change holds while it stands there;
    where one vanished, while it is gone. Nobody having looked changes nothing.
    """

    id: int
    kind: Kind
    points: Floats  # (n, 2) [m] map frame: the surface where it stands, or stood
    moved_from: tuple[float, float] | None  # [m] where a moved thing stood
    support: float  # 0..1, as in Change
    first_seen_ns: int
    last_seen_ns: int  # newest scan that showed it
    looked_ns: int  # newest scan that could tell
    adopted: Mapping[str, int | None]  # level -> when its estimates first showed it; fastest level first
    nodes: tuple[int, ...]  # that show it, by their newest word
    against: tuple[int, ...]  # nodes whose newest word is that it is undone
    episodes: tuple[Episode, ...]  # in order of time, at least one
    looks: int  # rounds of estimates in which some node could tell
    looks_held: int  # of these, in which it held

    @property
    def holds(self) -> bool:
        """Whether the change stands, by the newest word."""
        return self.episodes[-1].until_ns is None

    @property
    def closed_ns(self) -> int | None:
        """When it was seen undone; None while it holds."""
        return self.episodes[-1].until_ns

    @property
    def recurring(self) -> bool:
        """Whether it came back after it had been undone."""
        return len(self.episodes) > 1

    @property
    def share_held(self) -> float:
        """Share 0..1 of the looks in which it held."""
        return self.looks_held / max(1, self.looks)

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of the points [m]."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def bounds(self) -> Bounds:
        """x_min, y_min, x_max, y_max of the points [m]."""
        (x_min, y_min), (x_max, y_max) = self.points.min(axis=0).tolist(), self.points.max(axis=0).tolist()
        return x_min, y_min, x_max, y_max


class Turn(Enum):
    """What can happen to an event."""

    SEEN = "seen"  # reported for the first time
    ADOPTED = "adopted"  # a level shows it now
    CLOSED = "closed"  # it is undone
    REOPENED = "reopened"  # it is so again
    DROPPED = "dropped"  # it turned out to be a part of another event


@dataclass(frozen=True, slots=True)
class Transition:
    """Something that was found out about an event."""

    turn: Turn
    event: Event  # as it is afterwards
    level: str | None = None  # that adopted it
