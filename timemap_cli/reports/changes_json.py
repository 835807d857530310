"""Change events as a document for programs, schema timemap.changes/1."""

from collections.abc import Sequence
from typing import Any

from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Event
from timemap_cli.changes.hull import hull

SCHEMA = "timemap.changes/1"
_LONG_NS = 3_600_000_000_000
_DIGITS = 4  # of a metre or a share: finer than any scanner


def changes_document(events: Sequence[Event], end_ns: int | None) -> dict[str, Any]:
    """Values that JSON knows, without NaN or Infinity; `end_ns` is the newest scan replayed.

    Times are strings of nanoseconds (header stamps of scans), lengths metres in the map frame. `closed_ns` is null
    while a change holds; `not_seen_since` says of one that holds that nobody has looked at it for an hour and more.
    """
    told = [_event(event, end_ns) for event in events]
    return {"schema": SCHEMA, "events": told, "summary": summary(told)}


def summary(told: Sequence[dict[str, Any]]) -> dict[str, int]:
    """Numbers of the events of a document."""
    kinds = {kind.value: sum(event["kind"] == kind.value for event in told) for kind in Kind}
    return kinds | {
        "events": len(told),
        "open": sum(event["closed_ns"] is None for event in told),
        "recurring": sum(bool(event["recurring"]) for event in told),
        "toggles": sum(event["toggles"] for event in told),
    }


def _event(event: Event, end_ns: int | None) -> dict[str, Any]:
    x, y = event.centre
    return {
        "id": event.id,
        "kind": event.kind.value,
        "x": _number(x),
        "y": _number(y),
        "bounds": [_number(value) for value in event.bounds],
        "outline": [[_number(value) for value in corner] for corner in hull(event.points).tolist()],
        "moved_from": [_number(value) for value in event.moved_from] if event.moved_from else None,
        "first_seen_ns": str(event.first_seen_ns),
        "last_seen_ns": str(event.last_seen_ns),
        "looked_ns": str(event.looked_ns),
        "not_seen_since": event.holds and end_ns is not None and end_ns - event.looked_ns > _LONG_NS,
        "closed_ns": _time(event.closed_ns),
        "adopted": {level: _time(at_ns) for level, at_ns in event.adopted.items()},
        "nodes": list(event.nodes),
        "against": list(event.against),
        "support": _number(event.support),
        "recurring": event.recurring,
        "toggles": 2 * len(event.episodes) - 2 + (not event.holds),
        "looks": event.looks,
        "share_held": _number(event.share_held),
        "episodes": [
            {"since_ns": str(episode.since_ns), "until_ns": _time(episode.until_ns)}
            for episode in event.episodes
        ],
    }


def _time(stamp_ns: int | None) -> str | None:
    return None if stamp_ns is None else str(stamp_ns)


def _number(value: float) -> float:
    return round(float(value), _DIGITS) + 0.0  # the sum turns -0.0 into 0.0
