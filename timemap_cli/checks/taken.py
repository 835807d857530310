"""The snapshot of a result."""

import hashlib
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from timemap_cli.checks.coding import rounded
from timemap_cli.checks.snapshot import (
    Input,
    LevelRings,
    Scans,
    SeenEvent,
    Snapshot,
    require_comparable_size,
)
from timemap_cli.errors import TimemapError, shown
from timemap_cli.model.elementary import distance
from timemap_cli.model.estimates import Estimate
from timemap_cli.results.reader import ResultReader

_DIGEST = 12  # hexadecimal digits: two rings are the same by chance once in 10^14
_SECOND_NS = 10**9


def taken(reader: ResultReader) -> Snapshot:
    """What a result holds at its end. Raises TimemapError where it is damaged, or larger than can be compared."""
    report = reader.report
    try:
        require_comparable_size(len(reader.nodes), reader.angle_bins, len(reader.levels))
        settings = flat_settings(reader.settings)
    except ValueError as error:
        raise TimemapError(f"{reader.path} cannot be checked: {error}") from error
    return Snapshot(
        version=reader.version,
        inputs=tuple(Input(one["name"], one["sha256"]) for one in reader.inputs),
        settings=settings,
        map_frame=reader.map_frame,
        radius=reader.radius,
        angle_bins=reader.angle_bins,
        no_return=report.get("no_return", ""),
        beams=report.get("beams", {}),
        scans=_scans(reader),
        nodes=tuple(reader.nodes),
        levels={level: _rings(reader, level) for level in reader.levels},
        events=tuple(_event(event) for event in reader.changes["events"]),
        laid=None if (given := reader.nodes_were_given) is None else not given,
    )


def flat_settings(settings: Mapping[str, Any], path: str = "") -> dict[str, object]:
    """Nested settings by their whole names; a level stands under its own: `levels.long.window`.

    ValueError where they are none: an unnamed level, a name that is no word.
    """
    flat: dict[str, object] = {}
    for key, value in settings.items():
        if not _is_word(key):
            raise ValueError(f"its settings have the name {shown(key)}")
        if key == "levels":
            for level in _levels(value):
                named = {name: one for name, one in level.items() if name != "name"}
                flat |= flat_settings(named, f"{path}levels.{level['name']}.")
        elif isinstance(value, Mapping):
            flat |= flat_settings(value, f"{path}{key}.")
        else:
            flat[f"{path}{key}"] = value
    return flat


def _levels(values: object) -> list[Mapping[str, Any]]:
    if not isinstance(values, list) or not all(isinstance(one, Mapping) for one in values):
        raise ValueError("its settings have no list of levels")
    if not all(_is_word(level.get("name")) for level in values):
        raise ValueError("its settings have a level without a name")
    return values


def _is_word(name: object) -> bool:
    return isinstance(name, str) and re.fullmatch(r"\w{1,255}", name) is not None


def _scans(reader: ResultReader) -> Scans:
    read, used, dropped = reader.scans
    return Scans(read, used, {reason: count for reason, count in dropped.items() if count})


def _rings(reader: ResultReader, level: str) -> LevelRings:
    estimates = reader.estimates(level)
    ranges = np.full((len(reader.nodes), reader.angle_bins), np.nan)
    support = np.zeros(len(reader.nodes))
    digests = [""] * len(reader.nodes)
    for node, estimate in estimates.items():
        ranges[node] = rounded(estimate.ranges.astype(np.float64))
        known = ~np.isnan(ranges[node])
        support[node] = round(float(estimate.support[known].mean()), 2) if known.any() else 0.0
        digests[node] = _digest(estimate)
    return LevelRings(ranges, support, tuple(digests))


def _digest(estimate: Estimate) -> str:
    """Of what is the same wherever it is computed: whole millimetres, statuses and counts, in no byte order but one."""
    millimetres = np.nan_to_num(estimate.ranges.astype(np.float64) * 1000, nan=-1.0, posinf=-2.0)
    content = b"".join(
        np.rint(part).astype("<i4").tobytes() for part in (millimetres, estimate.status, estimate.samples)
    )
    return hashlib.sha256(content).hexdigest()[:_DIGEST]


def _event(event: Mapping[str, Any]) -> SeenEvent:
    x_min, y_min, x_max, y_max = event["bounds"]
    until = event["episodes"][-1]["until_ns"]
    return SeenEvent(
        kind=event["kind"],
        x=round(event["x"], 2) + 0.0,
        y=round(event["y"], 2) + 0.0,
        size=round(distance(x_max - x_min, y_max - y_min), 2),
        nodes=len(event["nodes"]) + len(event["against"]),
        since_ns=_whole(event["first_seen_ns"]),
        until_ns=None if until is None else _whole(until),
        adopted=tuple(level for level, at_ns in event["adopted"].items() if at_ns is not None),
    )


def _whole(stamp_ns: str) -> int:
    return int(stamp_ns) // _SECOND_NS * _SECOND_NS
