"""The truth as JSON, schema timemap.building/1: stamps are strings of nanoseconds."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from benchmarks.changes.truth import Episode, Outline, Recorded, TrueChange, Truth, Walked, bounds_of

SCHEMA = "timemap.building/1"


def to_json(truth: Truth) -> str:
    """The truth as text."""
    document = {
        "schema": SCHEMA,
        "frame": "map",
        "recordings": [_texts(asdict(recording)) for recording in truth.recordings],
        "changes": [
            _texts(asdict(change)) | {"recurring": change.recurring, "bounds": bounds_of(change.outline)}
            for change in truth.changes
        ],
    }
    return json.dumps(document, indent=1) + "\n"


def _texts(value: Any) -> Any:
    """The value with every stamp as a string."""
    if isinstance(value, dict):
        return {key: _stamps(v) if key.endswith("_ns") else _texts(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [_texts(item) for item in value]
    return value


def _stamps(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [str(ns) for ns in value]
    return None if value is None else str(value)


def from_json(text: str) -> Truth:
    """The truth that `to_json` wrote; ValueError for any other document."""
    document = json.loads(text)
    if document.get("schema") != SCHEMA:
        raise ValueError(f"schema is {document.get('schema')!r}, not {SCHEMA!r}")
    return Truth(
        tuple(_read_recording(r) for r in document["recordings"]),
        tuple(_read_change(c) for c in document["changes"]),
    )


def _read_recording(r: dict[str, Any]) -> Recorded:
    walked = tuple(
        Walked(w["who"], tuple(map(int, w["stamps_ns"])), tuple((p[0], p[1]) for p in w["positions"]))
        for w in r["walked"]
    )
    return Recorded(r["file"], r["day"], int(r["start_ns"]), int(r["end_ns"]), walked)


def _read_change(c: dict[str, Any]) -> TrueChange:
    origin = c["from_outline"]
    episodes = tuple(
        Episode(int(e["since_ns"]), None if e["until_ns"] is None else int(e["until_ns"]))
        for e in c["episodes"]
    )
    return TrueChange(
        c["what"], c["kind"], _read_outline(c["outline"]), _read_outline(origin) if origin else None, episodes
    )


def _read_outline(corners: Sequence[Sequence[float]]) -> Outline:
    return tuple((corner[0], corner[1]) for corner in corners)
