"""The truth and the events of a result, both taken apart into places where something came or went.

A thing that moved is two places: it vanished there and appeared here. So an event that says "moved" and two
events that say "vanished" and "appeared" are equally right; how many moves were told as such is counted aside.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from benchmarks.changes.truth import Bounds, Episode, TrueChange, Truth, bounds_of

APPEARED, VANISHED, MOVED = "appeared", "vanished", "moved"
_OPPOSITE = {APPEARED: VANISHED, VANISHED: APPEARED}


@dataclass(frozen=True, slots=True)
class Place:
    """Where and from when until when something is to be told, and as which kinds it may be told."""

    change: TrueChange
    kinds: frozenset[str]
    bounds: Bounds
    since_ns: int
    until_ns: int | None
    toggles: int = 1  # how often it really came or went


@dataclass(frozen=True, slots=True)
class Event:
    """One event of `timemap changes --json`."""

    name: str
    kind: str
    bounds: Bounds
    first_seen_ns: int
    last_seen_ns: int
    adopted: dict[str, int | None]  # by level, the fastest first
    nodes: tuple[int, ...]
    moved_from: Bounds | None = None
    toggles: int = 1  # how often it was opened or closed
    recurring: bool = False


@dataclass(frozen=True, slots=True)
class Claim:
    """One place of an event."""

    event: Event = field(repr=False)
    kind: str
    bounds: Bounds


def places_of_changes(truth: Truth) -> list[Place]:
    """What events are to tell: each change once, however often it recurs."""
    found = []
    for change in truth.changes:
        first, last = change.episodes[0], change.episodes[-1]
        toggles = sum(ns <= truth.end_ns for e in change.episodes for ns in _ends(e))
        if change.recurring:
            kinds, until_ns = frozenset((APPEARED, VANISHED)), None
        else:
            kinds, until_ns = frozenset((_here(change),)), last.until_ns
        box = bounds_of(change.outline)
        found.append(Place(change, kinds, box, first.since_ns, until_ns, toggles))
        if change.from_outline:
            box = bounds_of(change.from_outline)
            found.append(Place(change, frozenset((VANISHED,)), box, first.since_ns, None))
    return found


def places_of_transitions(truth: Truth) -> list[Place]:
    """What comparing one day with the next is to tell: every coming and every going by itself."""
    found = []
    for change in truth.changes:
        box, kind = bounds_of(change.outline), _here(change)
        ends = [
            (ns, k) for e in change.episodes for ns, k in zip(_ends(e), (kind, _OPPOSITE[kind]), strict=False)
        ]
        if change.from_outline:
            origin = bounds_of(change.from_outline)
            found.append(Place(change, frozenset((VANISHED,)), origin, ends[0][0], None))
        for (since_ns, k), (until_ns, _) in pairwise([*ends, (None, kind)]):
            if since_ns is not None and since_ns <= truth.end_ns:
                found.append(Place(change, frozenset((k,)), box, since_ns, until_ns))
    return found


def _here(change: TrueChange) -> str:
    """What is to be seen where the change's outline is."""
    return VANISHED if change.kind == VANISHED else APPEARED


def _ends(episode: Episode) -> list[int]:
    return [ns for ns in (episode.since_ns, episode.until_ns) if ns is not None]


def read_events(document: dict[str, Any]) -> list[Event]:
    """The events of a document of schema timemap.changes/1; ValueError for any other."""
    if document.get("schema") != "timemap.changes/1":
        raise ValueError(f"schema is {document.get('schema')!r}, not 'timemap.changes/1'")
    return [_event(event) for event in document["events"]]


def _event(e: dict[str, Any]) -> Event:
    return Event(
        str(e["id"]), e["kind"], _bounds(e["bounds"]), int(e["first_seen_ns"]), int(e["last_seen_ns"]),
        {level: None if ns is None else int(ns) for level, ns in e["adopted"].items()},
        tuple(e["nodes"]), moved_from(e.get("moved_from"), _bounds(e["bounds"])),
        _toggles(e), bool(e.get("recurring")),
    )  # fmt: skip


def moved_from(told: Sequence[float] | None, here: Bounds) -> Bounds | None:
    """Where a moved thing stood, told as bounds or as its centre; then it has the size that it has `here`."""
    if told is None:
        return None
    if len(told) == 4:
        return _bounds(told)
    x, y = told
    half_x, half_y = (here[2] - here[0]) / 2, (here[3] - here[1]) / 2
    return x - half_x, y - half_y, x + half_x, y + half_y


def _bounds(values: Sequence[float]) -> Bounds:
    x_min, y_min, x_max, y_max = map(float, values)
    return x_min, y_min, x_max, y_max


def _toggles(e: dict[str, Any]) -> int:
    """Openings and closings of all episodes."""
    return sum(1 + (episode["until_ns"] is not None) for episode in e["episodes"])


def claims(events: Sequence[Event]) -> list[Claim]:
    """The places that events tell, in their order."""
    found = []
    for event in events:
        found.append(Claim(event, APPEARED if event.kind == MOVED else event.kind, event.bounds))
        if event.moved_from:
            found.append(Claim(event, VANISHED, event.moved_from))
    return found
