"""What `timemap diff` tells from day to day, and how much it could compare.

Each level's newest estimates at the end of a day are compared with those at the end of the day before.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from benchmarks.changes.places import Claim, Event, Place, claims, moved_from, places_of_transitions
from benchmarks.changes.recordings import timemap_json
from benchmarks.changes.scores import Found, false_area, find, seen_in
from benchmarks.changes.truth import Recorded, Truth


@dataclass(frozen=True, slots=True)
class Days:
    """What one level's differences from day to day are worth."""

    level: str  # with a star where only the turns that last its half-life are to be told
    found: Found  # places of transitions, told on whatever day
    at_once: int  # of these, told on the first patrol after
    quiet_false: int
    quiet_area: float  # [m^2]
    area: float  # [m^2] that all claims cover beside the truth
    compared: float  # share of all angle bins of all nodes, mean over the pairs of days


def day_by_day(result: Path, level: str, truth: Truth, nodes: int) -> tuple[list[Event], list[float]]:
    """What each day differs in from the one before at one level, and the share of bins compared on each.

    `nodes` is the number of all nodes.
    """
    told = [
        compared(level, after, nodes, str(result), "--between", str(before.end_ns), str(after.end_ns))
        for before, after in pairwise(truth.recordings)
    ]
    return [event for events, _ in told for event in events], [share for _, share in told]


def compared(
    level: str, after: Recorded, nodes: int, *arguments: str, other_level: str = ""
) -> tuple[list[Event], float]:
    """What one call of `timemap diff` tells as events of the recording `after`, and the share of bins compared.

    RuntimeError where it refuses to compare.
    """
    told = timemap_json("diff", *arguments, "--level", level, *([other_level] if other_level else []))
    summary = told["summary"]
    share = summary["compared_bins"] / (nodes * (summary["angle_bins"] or 1))
    return [_event(change, i, level, after) for i, change in enumerate(told["changes"])], share


def refusal(error: RuntimeError) -> str:
    """Why a call of timemap failed, without the folders of files."""
    first = str(error).splitlines()[0]
    return re.sub(r"(?<!\S)/\S*/", "", first.rpartition("error: ")[2])


def judged(
    events: Sequence[Event], level: str, truth: Truth, shares: Sequence[float],
    lasting: Sequence[Place] | None = None,
) -> Days:  # fmt: skip
    """The worth of one level's differences, given as events that nobody adopts.

    With `lasting` places only these are to be told, and telling the others is neither right nor false.
    """
    every = places_of_transitions(truth)
    places = every if lasting is None else lasting
    found = find(claims(events), places, truth, [place for place in every if place not in places])
    quiet = truth.quiet()
    quiet_false = seen_in(found.false, quiet)
    name = level if lasting is None else f"{level}*"
    at_once = sum(_first_after(claim, place.since_ns, truth) for place, claim in found.pairs)
    told = [claim for claim in found.claims if claim not in found.people]
    return Days(
        name, found, at_once, len(quiet_false), false_area(quiet_false, found.places),
        false_area(told, found.places), sum(shares) / len(shares),
    )  # fmt: skip


def _event(change: dict[str, Any], number: int, level: str, after: Recorded) -> Event:
    """A difference as an event: seen throughout the later day, so that it never passes for people."""
    x_min, y_min, x_max, y_max = change["bounds"]
    bounds = (x_min, y_min, x_max, y_max)
    return Event(
        f"{level} day {after.day} no {number}", change["kind"], bounds, after.start_ns, after.end_ns, {},
        tuple(sorted({sector["node"] for sector in change["sectors"]})),
        moved_from(change["moved_from"], bounds),
    )  # fmt: skip


def _first_after(claim: Claim, since_ns: int, truth: Truth) -> bool:
    """Whether a claim is of the first patrol after a time."""
    first = next(r for r in truth.recordings if r.start_ns >= since_ns)
    return claim.event.first_seen_ns == first.start_ns
