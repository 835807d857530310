"""Which change events are missing, new, or seen at another place or time."""

import math
from collections.abc import Iterator, Mapping, Sequence

from timemap_cli.checks.snapshot import SeenEvent
from timemap_cli.checks.tolerances import TOLERANCES, within
from timemap_cli.checks.verdict import Measure, Spot
from timemap_cli.model.ordering import to_order
from timemap_cli.times import format_time

_SAME_M = 1.0  # farther apart are two events
_FIRM_NODES = 3  # what fewer nodes saw comes and goes with the noise


def event_measures(
    expected: Sequence[SeenEvent], found: Sequence[SeenEvent], allowed: Mapping[str, float]
) -> Iterator[Measure]:
    """Figures of the events; those that fewer than three nodes could tell are not missed and not new."""
    pairs = _pairs(expected, found, allowed)
    partners = {id(event) for pair in pairs for event in pair}
    for name, side, told in (
        ("events.missing", expected, "expected but not there"),
        ("events.new", found, "not expected"),
    ):
        alone = [event for event in side if id(event) not in partners and event.nodes >= _FIRM_NODES]
        text = f"{len(alone)} of {len(side)} change events {told}"
        yield _measure(name, len(alone), _with(text, alone), allowed, [_spot(event) for event in alone])
    firm = [pair for pair in pairs if min(one.nodes for one in pair) >= _FIRM_NODES]
    yield _farthest("events.place", firm, allowed)
    yield _latest("events.time", firm, allowed)


def _pairs(
    expected: Sequence[SeenEvent], found: Sequence[SeenEvent], allowed: Mapping[str, float]
) -> list[tuple[SeenEvent, SeenEvent]]:
    """Events of one kind at nearly the same place; each has one partner at most.

    Events that enough nodes saw come first, since one without a partner is missed or new; then those that are within
    the tolerances, since a door that opens twice is seen twice at one place; then the nearest.
    """
    near = [
        (
            -sum(event.nodes >= _FIRM_NODES for event in (one, other)),
            not within(_apart(one, other), allowed["events.place"])
            or not within(_delay(one, other), allowed["events.time"]),
            to_order(_apart(one, other)),
            abs(one.since_ns - other.since_ns),
            i,
            j,
        )
        for i, one in enumerate(expected)
        for j, other in enumerate(found)
        if one.kind == other.kind and _apart(one, other) <= _SAME_M
    ]
    taken: set[int] = set()
    given: set[int] = set()
    pairs = []
    for *_, i, j in sorted(near):
        if i not in taken and j not in given:
            taken.add(i)
            given.add(j)
            pairs.append((expected[i], found[j]))
    return pairs


def _apart(one: SeenEvent, other: SeenEvent) -> float:
    return math.hypot(one.x - other.x, one.y - other.y)


def _farthest(
    name: str, pairs: Sequence[tuple[SeenEvent, SeenEvent]], allowed: Mapping[str, float]
) -> Measure:
    worst = max(pairs, key=lambda pair: to_order(_apart(*pair)), default=None)
    if worst is None:
        return _measure(name, 0.0, "no change event to compare", allowed)
    distance = _apart(*worst)
    told = f"{_named(worst[0])} lies {distance:.2f} m off its place"
    return _measure(name, distance, told, allowed, [_spot(worst[1])])


def _latest(name: str, pairs: Sequence[tuple[SeenEvent, SeenEvent]], allowed: Mapping[str, float]) -> Measure:
    worst = max(pairs, key=lambda pair: _delay(*pair), default=None)
    if worst is None:
        return _measure(name, 0.0, "no change event to compare", allowed)
    one, other = worst
    told = f"{_named(one)} is seen {_span(other)}, expected {_span(one)}"
    delay = _delay(one, other)
    if math.isinf(delay):  # one still holds: as good as a missing event
        return _measure(name, 10 * max(1.0, allowed[name]), told, allowed, [_spot(other)])
    return _measure(name, delay, told, allowed, [_spot(other)])


def _delay(one: SeenEvent, other: SeenEvent) -> float:
    """By how many seconds they begin or end apart; +inf where one ended and the other holds."""
    if (one.until_ns is None) != (other.until_ns is None):
        return math.inf
    ends = (
        abs(one.until_ns - other.until_ns) if one.until_ns is not None and other.until_ns is not None else 0
    )
    return max(abs(one.since_ns - other.since_ns), ends) / 1e9


def _span(event: SeenEvent) -> str:
    until = "" if event.until_ns is None else f" until {format_time(event.until_ns)}"
    return f"from {format_time(event.since_ns)}{until}"


def _named(event: SeenEvent) -> str:
    return f"'{event.kind}' at {event.x:.2f}, {event.y:.2f}"


def _with(text: str, events: Sequence[SeenEvent]) -> str:
    return f"{text}: {', '.join(map(_named, events))}" if events else text


def _spot(event: SeenEvent) -> Spot:
    return Spot(event.x, event.y, f"{event.kind}, {event.size:.2f} m, since {format_time(event.since_ns)}")


def _measure(
    name: str, value: float, text: str, allowed: Mapping[str, float], spots: Sequence[Spot] = ()
) -> Measure:
    return Measure(name, None, float(value), allowed[name], TOLERANCES[name].unit, text, tuple(spots))
