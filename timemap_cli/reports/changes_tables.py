"""Change events for spreadsheets and for maps."""

import csv
import io
from collections.abc import Sequence

from timemap_cli.file_names import json_text
from timemap_cli.reports.event_selection import Event
from timemap_cli.times import format_time

_PLAIN = ("id", "kind", "x", "y", "support", "share_held", "looks", "toggles", "recurring", "not_seen_since")
_TIMES = ("first_seen_ns", "last_seen_ns", "looked_ns", "closed_ns")
_BOUNDS = ("x_min", "y_min", "x_max", "y_max")


def changes_csv(events: Sequence[Event], levels: Sequence[str]) -> str:
    """A line per event under one of names (RFC 4180); lengths in metres, times RFC 3339 in UTC, empty for none."""
    adopted = [f"adopted_{level}" for level in levels]
    times = [name.removesuffix("_ns") for name in _TIMES]
    out = io.StringIO()
    lines = csv.DictWriter(
        out, [*_PLAIN[:4], *_BOUNDS, *times, *adopted, "nodes", *_PLAIN[4:]], lineterminator="\r\n"
    )
    lines.writeheader()
    for event in events:
        lines.writerow(
            {name: event[name] for name in _PLAIN}
            | dict(zip(_BOUNDS, event["bounds"], strict=True))
            | {name: _time(event[f"{name}_ns"]) for name in times}
            | {f"adopted_{level}": _time(event["adopted"].get(level)) for level in levels}
            | {"nodes": " ".join(map(str, event["nodes"]))}
        )
    return out.getvalue()


def changes_geojson(events: Sequence[Event]) -> str:
    """A FeatureCollection of polygons (RFC 7946, but in metres of the map frame); properties as in the JSON."""
    features = [
        {
            "type": "Feature",
            "id": event["id"],
            "geometry": {"type": "Polygon", "coordinates": [[*event["outline"], event["outline"][0]]]},
            "properties": {name: value for name, value in event.items() if name not in ("id", "outline")},
        }
        for event in events
    ]
    return json_text({"type": "FeatureCollection", "features": features})


def _time(stamp_ns: str | None) -> str:
    return "" if stamp_ns is None else format_time(int(stamp_ns))
