"""What a result holds, as a document and as a text of one screen."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from timemap_cli.model.estimates import Estimate
from timemap_cli.reports.changes_json import summary
from timemap_cli.reports.tables import plural
from timemap_cli.results.channels import LevelTopic
from timemap_cli.results.reader import ResultReader
from timemap_cli.times import format_time

Document = dict[str, Any]


def result_document(result: ResultReader) -> Document:
    """One of the `results` of the schema timemap.info/1. Times are strings of nanoseconds, lengths metres."""
    metadata = result.metadata
    return {
        "path": str(result.path),
        "version": metadata.get("version"),
        "start_ns": str(result.start_ns),
        "end_ns": str(result.end_ns),
        "inputs": result.inputs,
        "resumed_from": result.resumed_from,
        "can_be_resumed": result.can_be_resumed,
        "map_frame": result.map_frame,
        "nodes": len(result.nodes),
        "radius_m": result.radius,
        "angle_bins": result.angle_bins,
        "scans": result.report["scans"],
        "levels": [_level(result, level) for level in result.levels],
        "changes": summary(result.changes["events"]),
        "settings_sha256": metadata.get("settings_sha256"),
        "settings": result.config,
    }


def result_text(found: Document) -> str:
    """The document as a paragraph. Ends without a newline."""
    rows = list(_rows(found))
    width = max(len(word) for word, _ in rows)
    return "\n".join([found["path"], *(f"  {word.ljust(width)}  {text}" for word, text in rows)])


def _level(result: ResultReader, level: str) -> Document:
    newest = result.estimates(level)
    return {
        "name": level,
        "estimates": result.count(LevelTopic.SCAN.of(level)),
        "nodes": len(newest),
        "known": _known(newest),
    }


def _known(estimates: Mapping[int, Estimate]) -> float | None:
    """Share of the angle bins in which the newest estimates know a range, or that it is clear."""
    known = [float((~np.isnan(estimate.ranges)).mean()) for estimate in estimates.values()]
    return round(sum(known) / len(known), 4) if known else None


def _rows(found: Document) -> Iterator[tuple[str, str]]:
    yield "format", f"result of timemap {found['version']}"
    yield "span", f"{_time(found['start_ns'])} to {_time(found['end_ns'])}"
    names = ", ".join(str(one["name"]) for one in found["inputs"])
    earlier = found["resumed_from"]
    yield "made of", f"{names}, resumed from {earlier['name']}" if earlier else names
    scans = found["scans"]
    dropped = ", ".join(f"{reason} {count}" for reason, count in scans["dropped"].items())
    used = f"{scans['read']} read, {scans['used']} used"
    yield "scans", f"{used}, dropped: {dropped}" if dropped else used
    looking = f"looking {found['radius_m']:g} m far into {found['angle_bins']} angle bins"
    yield "map", f"{plural(found['nodes'], 'node')} in '{found['map_frame']}', {looking}"
    for level in found["levels"]:
        held = f"{plural(level['estimates'], 'estimate')} of {plural(level['nodes'], 'node')}"
        known = "" if level["known"] is None else f", {100 * level['known']:.0f} % of the angle bins known"
        yield f"level {level['name']}", held + known
    events = found["changes"]
    yield "changes", f"{plural(events['events'], 'event')}, {events['open']} of them open"
    yield "resuming", "timemap replay LOG... --resume RESULT" if found["can_be_resumed"] else "not possible"


def _time(stamp_ns: str) -> str:
    return format_time(int(stamp_ns))
