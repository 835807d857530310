"""Which claim tells which place of the truth, and which claims are of people."""

from collections.abc import Sequence

from benchmarks.changes.places import APPEARED, Claim, Event, Place
from benchmarks.changes.truth import Bounds, Truth, gap

NEAR_M = 0.3  # between the bounds of a claim and of the truth
BEYOND_M = 0.5  # by which a claim may reach beyond the truth: what covers half a room tells no place
PERSON_M = 0.5  # between a claim and somebody who is there
PERSON_NS = 5_000_000_000  # by which an event's stamps may miss the time somebody was there
SHORT_LIVED_NS = 60_000_000_000


def fits(claim: Claim, place: Place) -> bool:
    """Whether kind, place and time agree.

    The bounds overlap or are at most `NEAR_M` apart, and the claim's reach at most `BEYOND_M` beyond the
    place's. The event was first seen, and adopted by any level, no earlier than the change, and first seen
    before the change was undone.
    """
    event = claim.event
    earliest = min([event.first_seen_ns, *(ns for ns in event.adopted.values() if ns is not None)])
    in_time = earliest >= place.since_ns and (place.until_ns is None or event.first_seen_ns < place.until_ns)
    return in_time and claim.kind in place.kinds and _at(claim.bounds, place.bounds)


def _at(told: Bounds, true: Bounds) -> bool:
    beyond = max(true[0] - told[0], true[1] - told[1], told[2] - true[2], told[3] - true[3])
    return gap(told, true) <= NEAR_M and beyond <= BEYOND_M


def match(told: Sequence[Claim], places: Sequence[Place]) -> dict[int, int]:
    """The index of the claim for each place that is told, by the place's index; as many as can be.

    No claim serves two places. Where there is a choice, earlier claims come first.
    """
    fitting = [[c for c, claim in enumerate(told) if fits(claim, place)] for place in places]
    place_of: dict[int, int] = {}

    def settle(place: int, tried: set[int]) -> bool:
        for claim in fitting[place]:
            if claim not in tried:
                tried.add(claim)
                if claim not in place_of or settle(place_of[claim], tried):
                    place_of[claim] = place
                    return True
        return False

    for place in range(len(places)):
        settle(place, set())
    return {place: claim for claim, place in sorted(place_of.items(), key=lambda pair: pair[1])}


def of_people(event: Event, truth: Truth) -> bool:
    """Whether an event is somebody passing, told as it should be.

    It appeared; no level but the fastest adopted it; from first to last evidence it lasted at most
    `SHORT_LIVED_NS`; and somebody really was within `PERSON_M` of its bounds at that time, give or take
    `PERSON_NS`.
    """
    slower = list(event.adopted.values())[1:]
    if event.kind != APPEARED or any(ns is not None for ns in slower):
        return False
    if event.last_seen_ns - event.first_seen_ns > SHORT_LIVED_NS:
        return False
    since_ns, until_ns = event.first_seen_ns - PERSON_NS, event.last_seen_ns + PERSON_NS
    return any(
        walked.nearest(event.bounds, since_ns, until_ns) <= PERSON_M
        for recording in truth.recordings
        for walked in recording.walked
    )
