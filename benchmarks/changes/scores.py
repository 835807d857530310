"""How well claims tell the truth: found and false places, false area, flicker and delay."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.changes.matching import fits, match, of_people
from benchmarks.changes.places import MOVED, Claim, Event, Place, claims, places_of_changes
from benchmarks.changes.truth import Bounds, Recorded, Truth
from benchmarks.changes.visits import Pace

MOST_HALF_LIVES = 1.3  # a level that takes longer is late
_CELL_M = 0.05
_AROUND_M = 0.3  # what a claim covers so near to a true place is not false


@dataclass(frozen=True, slots=True)
class Found:
    """Which places are told, by which claims, and which claims are false."""

    places: tuple[Place, ...]
    claims: tuple[Claim, ...]
    match: Mapping[int, int]  # index of the claim by index of the place
    people: tuple[Claim, ...]  # and what need not be told: neither right nor false

    @property
    def missed(self) -> list[Place]:
        """Places that no claim tells."""
        return [place for i, place in enumerate(self.places) if i not in self.match]

    @property
    def false(self) -> list[Claim]:
        """Claims that tell no place, people left out."""
        right = set(self.match.values())
        return [c for i, c in enumerate(self.claims) if i not in right and c not in self.people]

    @property
    def again(self) -> list[Claim]:
        """False claims that fit a place which another claim tells."""
        return [c for c in self.false if any(fits(c, place) for place in self.places)]

    @property
    def recall(self) -> float | None:
        """Share of the places that are told; None: there is none."""
        return len(self.match) / len(self.places) if self.places else None

    @property
    def precision(self) -> float | None:
        """Share of the claims, people left out, that are right; None: there is none."""
        told = len(self.match) + len(self.false)
        return len(self.match) / told if told else None

    @property
    def f1(self) -> float:
        """Harmonic mean of precision and recall; 1 where there was nothing to tell and nothing was told."""
        everything = 2 * len(self.match) + len(self.false) + len(self.missed)
        return 2 * len(self.match) / everything if everything else 1.0

    @property
    def pairs(self) -> list[tuple[Place, Claim]]:
        """Each place that is told, with its claim."""
        return [(self.places[p], self.claims[c]) for p, c in self.match.items()]


def find(told: Sequence[Claim], places: Sequence[Place], truth: Truth, spared: Sequence[Place] = ()) -> Found:
    """Match claims with places; a claim of people counts as such only where it tells no place.

    What fits one of the `spared` places need not be told: it is neither right nor false.
    """
    pairs = match(told, places)
    rest = [c for i, c in enumerate(told) if i not in set(pairs.values())]
    neither = [c for c in rest if of_people(c.event, truth) or any(fits(c, place) for place in spared)]
    return Found(tuple(places), tuple(told), pairs, tuple(neither))


def false_area(told: Sequence[Claim], places: Sequence[Place]) -> float:
    """Area [m^2] covered by the bounds of claims, farther than `_AROUND_M` from every place.

    A surface seen from one side has no depth, so bounds count 5 cm farther on all sides.
    """
    if not told:
        return 0.0
    boxes = np.array([claim.bounds for claim in told])
    low, high = boxes[:, :2].min(0) - 0.5, boxes[:, 2:].max(0) + 0.5
    x, y = (np.arange(low[i], high[i], _CELL_M) + _CELL_M / 2 for i in (0, 1))
    covered, true = np.zeros((len(x), len(y)), bool), np.zeros((len(x), len(y)), bool)
    for claim in told:
        covered |= _within(claim.bounds, _CELL_M, x, y)
    for place in places:
        true |= _within(place.bounds, _AROUND_M, x, y)
    return float((covered & ~true).sum()) * _CELL_M**2


def _within(
    bounds: Bounds, beyond: float, x: np.ndarray, y: np.ndarray
) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Cells (len(x), len(y)) with their centres in the bounds or not farther than `beyond` outside."""
    x_min, y_min, x_max, y_max = bounds
    inside_x = (x >= x_min - beyond) & (x <= x_max + beyond)
    inside_y = (y >= y_min - beyond) & (y <= y_max + beyond)
    return np.asarray(inside_x[:, None] & inside_y[None])


def seen_in(told: Sequence[Claim], recordings: Sequence[Recorded]) -> list[Claim]:
    """The claims whose event was first seen in one of the recordings."""
    return [c for c in told if any(r.start_ns <= c.event.first_seen_ns <= r.end_ns for r in recordings)]


@dataclass(frozen=True, slots=True)
class Adoption:
    """How long one level took to adopt one change that is told.

    Estimates are made now and then, so the level changed its mind between the estimate that shows it, after
    `half_lives`, and the one before, after `at_least`. Where it was not adopted both run until the change was
    undone or all ended.
    """

    what: str
    level: str
    at_least: float
    half_lives: float
    adopted: bool

    @property
    def late(self) -> bool:
        """Whether the level surely took, or has waited, longer than it may."""
        return self.at_least > MOST_HALF_LIVES


def adoptions(found: Found, paces: Mapping[str, Pace], end_ns: int) -> list[Adoption]:
    """Of every told place that does not recur and every level, at the nodes that the event names."""
    taken = []
    for place, claim in found.pairs:
        if place.change.recurring or not claim.event.nodes:
            continue
        for level, ns in claim.event.adopted.items():
            until_ns = ns if ns is not None else min(end_ns, place.until_ns or end_ns)
            span = (claim.event.nodes, place.since_ns, until_ns)
            passed = paces[level].half_lives(*span)
            before = passed if ns is None else paces[level].half_lives_before(*span)
            taken.append(Adoption(place.change.what, level, before, passed, ns is not None))
    return taken


@dataclass(frozen=True, slots=True)
class Score:
    """All figures of the events of a result."""

    found: Found
    patrols: int
    quiet_patrols: int
    quiet_false: int  # false places first seen on days on which nothing changed but what recurs
    quiet_area: float  # [m^2] of these
    area: float  # [m^2] that all claims but people's cover beside the truth
    flicker: float | None  # toggles per told event beyond those of the truth
    moves: tuple[int, int]  # told as moved, of so many
    recurring: tuple[int, int]  # told as recurring, of so many
    adoptions: tuple[Adoption, ...]


def score(events: Sequence[Event], truth: Truth, paces: Mapping[str, Pace]) -> Score:
    """Judge the events of a result against the truth."""
    found = find(claims(events), places_of_changes(truth), truth)
    quiet, told = truth.quiet(), [c for c in found.claims if c not in found.people]
    quiet_false = seen_in(found.false, quiet)
    return Score(
        found, len(truth.recordings), len(quiet), len(quiet_false),
        false_area(quiet_false, found.places), false_area(told, found.places), _flicker(found),
        _told(found, truth, moved=True), _told(found, truth, moved=False),
        tuple(adoptions(found, paces, truth.end_ns)),
    )  # fmt: skip


def _flicker(found: Found) -> float | None:
    """Openings and closings of told events beyond the true ones, per told event; None: none is told.

    An event that was opened once and never closed again, though the change was undone, has none too many.
    """
    pairs = {id(claim.event): (place, claim) for place, claim in found.pairs}.values()
    more = [max(0, claim.event.toggles - place.toggles) for place, claim in pairs]
    return sum(more) / len(more) if more else None


def _told(found: Found, truth: Truth, *, moved: bool) -> tuple[int, int]:
    """Changes that moved (or else recur) and are told as such, of so many."""
    wanted = [c for c in truth.changes if (c.kind == MOVED if moved else c.recurring)]
    told = [
        place.change
        for place, claim in found.pairs
        if (claim.event.kind == MOVED if moved else claim.event.recurring)
    ]
    return sum(change in told for change in wanted), len(wanted)
