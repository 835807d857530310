"""Claims about places in a row that are emptied and filled: which are told, and which claims are false.

Neighbouring pallets stand so close that one claim may tell several of them, so a claim tells every place that it
covers for at least half of its length along the row. It may not reach farther than 0.5 m beyond what it tells. A place
that was emptied and filled in one night changed by some decimetres: to tell that is neither right nor false.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from benchmarks.changes.matching import BEYOND_M, NEAR_M
from benchmarks.changes.truth import Bounds, gap

COVERED = 0.5  # share of a place's length along the row


@dataclass(frozen=True, slots=True)
class Turn:
    """A place that was filled, emptied, or (kind None) filled anew: from a day up to the day before another."""

    place: int
    kind: str | None  # appeared, vanished
    bounds: Bounds
    day: int
    until_day: int | None  # None: to the end

    def holds(self, day: int) -> bool:
        """Whether it is to be seen on a day."""
        return self.day <= day and (self.until_day is None or day < self.until_day)


@dataclass(frozen=True, slots=True)
class SlotClaim:
    """What one difference tells on one day."""

    kind: str
    bounds: Bounds
    day: int


@dataclass(frozen=True, slots=True)
class SlotScore:
    """How well the claims of all days tell the turns."""

    told: int
    turns: int
    false: tuple[SlotClaim, ...]
    again: int  # of these, told before by another claim
    at_once: int  # told on the first day

    @property
    def recall(self) -> float:
        """Share of the turns that are told."""
        return self.told / self.turns if self.turns else 1.0

    @property
    def f1(self) -> float:
        """Harmonic mean of recall and precision, each turn that is told counted as a right claim."""
        everything = self.told + self.turns + len(self.false)
        return 2 * self.told / everything if everything else 1.0


def score_slots(claims: Iterable[SlotClaim], turns: Sequence[Turn]) -> SlotScore:
    """Judge claims, in the order of their days; a claim that tells only what was told before is false."""
    told: dict[tuple[int, int], int] = {}  # day of the claim by place and day of the turn
    false, again = [], 0
    for claim in claims:
        here = [turn for turn in turns if turn.holds(claim.day) and _touches(claim, turn)]
        right = [(turn.place, turn.day) for turn in here if turn.kind is not None]
        new = [turn for turn in right if turn not in told]
        if not here or _beyond(claim.bounds, [turn.bounds for turn in here]) > BEYOND_M:
            false.append(claim)
        elif right and not new:
            false.append(claim)
            again += 1
        else:
            told |= dict.fromkeys(new, claim.day)
    wanted = sum(turn.kind is not None for turn in turns)
    at_once = sum(day == claimed for (_, day), claimed in told.items())
    return SlotScore(len(told), wanted, tuple(false), again, at_once)


def _touches(claim: SlotClaim, turn: Turn) -> bool:
    """Whether a claim tells a turn; of one that is filled anew, whether it is near."""
    if turn.kind is None:
        return gap(claim.bounds, turn.bounds) <= NEAR_M
    (x_min, _, x_max, _), (left, _, right, _) = claim.bounds, turn.bounds
    covered = min(x_max, right) - max(x_min, left)
    near = gap(claim.bounds, turn.bounds) <= NEAR_M
    return claim.kind == turn.kind and near and covered >= COVERED * (right - left)


def _beyond(told: Bounds, true: Sequence[Bounds]) -> float:
    """How far bounds reach beyond those of all others together [m]."""
    x_min, y_min = (min(bounds[i] for bounds in true) for i in (0, 1))
    x_max, y_max = (max(bounds[i] for bounds in true) for i in (2, 3))
    return max(x_min - told[0], y_min - told[1], told[2] - x_max, told[3] - y_max)
