"""A baseline as a text file that a reviewer reads: a line for each setting, event, node, and ring of a level."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from timemap_cli.checks.coding import decoded, encoded
from timemap_cli.checks.snapshot import Input, LevelRings, Scans, SeenEvent, Snapshot
from timemap_cli.checks.tolerances import checked
from timemap_cli.errors import TimemapError, UsageError, no_such_file
from timemap_cli.model.nodes import Node
from timemap_cli.times import format_time, parse_time

FORMAT = "timemap.baseline/1"
HEAD = "# What the map of these recordings is expected to be, for `timemap check`; --update-baseline writes it anew.\n"
_RINGS_NOTE = (
    "# Ranges round the node, counter-clockwise from the map's +x: centimetres, then a letter for each angle bin,",
    "# a..z 1..26 cm farther than the one before, A..Z nearer, = as far; ?12 twelve unknown bins, *3 three clear ones.",
)


@dataclass(frozen=True, slots=True)
class Baseline:
    """What a result is expected to be, and the tolerances that are not at their defaults."""

    expected: Snapshot
    tolerances: Mapping[str, float]


def dump(baseline: Baseline) -> str:
    """The file's text; the same baseline gives the same text."""
    return HEAD + "\n".join(_lines(baseline)) + "\n"


def read(path: Path) -> Baseline:
    """A baseline from its file.

    Raises UsageError where there is none, where it is anything else, or for tolerances that are not known;
    TimemapError where it cannot be read or is damaged.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise no_such_file(path, "--update-baseline makes it") from error
    except UnicodeDecodeError as error:
        raise not_a_baseline(path) from error
    except OSError as error:
        raise TimemapError(f"cannot read {path}: {(error.strerror or str(error)).lower()}") from error
    if f"\nformat: {FORMAT}\n" not in f"\n{text[:1000]}":
        raise not_a_baseline(path)
    try:
        return _baseline(YAML(typ="safe", pure=True).load(text), path)
    except UsageError:
        raise
    except (YAMLError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise TimemapError(
            f"{path} is damaged: {' '.join(str(error).split())[:200]}", hint="--update-baseline makes it anew"
        ) from error


def not_a_baseline(path: Path) -> UsageError:
    """The error for a file that is no baseline, or one of another version."""
    return UsageError(f"{path} is not a baseline of the format {FORMAT}", hint="--update-baseline makes one")


def _lines(baseline: Baseline) -> Iterator[str]:
    one = baseline.expected
    yield f"format: {FORMAT}"
    yield f"version: {json.dumps(one.version)}"
    yield from _list("inputs", [{"name": i.name, "sha256": i.sha256} for i in one.inputs])
    yield from _mapping("settings", one.settings)
    yield f"map_frame: {json.dumps(one.map_frame)}"
    yield f"radius: {one.radius}"
    yield f"angle_bins: {one.angle_bins}"
    yield f"no_return: {json.dumps(one.no_return)}"
    yield from _rows("beams", {json.dumps(topic): kinds for topic, kinds in one.beams.items()})
    dropped = ", ".join(f"{reason}: {count}" for reason, count in sorted(one.scans.dropped.items()))
    yield f"scans: {{read: {one.scans.read}, used: {one.scans.used}, dropped: {{{dropped}}}}}"
    yield from _mapping("tolerances", dict(sorted(baseline.tolerances.items())))
    yield from _list("events", [_event_values(event) for event in one.events])
    yield from _rows("nodes", {str(i): {"x": node.x, "y": node.y} for i, node in enumerate(one.nodes)})
    yield from _RINGS_NOTE
    yield "levels:"
    for level, rings in one.levels.items():
        yield f"  {level}:"
        yield from (_ring_line(node, rings) for node in range(len(one.nodes)) if rings.digests[node])


def _mapping(name: str, values: Mapping[str, object]) -> Iterator[str]:
    yield f"{name}:" if values else f"{name}: {{}}"
    yield from (f"  {key}: {json.dumps(value)}" for key, value in values.items())


def _rows(name: str, rows: Mapping[str, Mapping[str, object]]) -> Iterator[str]:
    yield f"{name}:" if rows else f"{name}: {{}}"
    yield from (f"  {key}: {_flow(row)}" for key, row in rows.items())


def _list(name: str, rows: Sequence[Mapping[str, object]]) -> Iterator[str]:
    yield f"{name}:" if rows else f"{name}: []"
    yield from (f"- {_flow(row)}" for row in rows)


def _flow(row: Mapping[str, object]) -> str:
    return "{" + ", ".join(f"{key}: {json.dumps(value)}" for key, value in row.items()) + "}"


def _event_values(event: SeenEvent) -> dict[str, object]:
    return {
        "kind": event.kind,
        "x": event.x,
        "y": event.y,
        "size": event.size,
        "nodes": event.nodes,
        "since": format_time(event.since_ns),
        "until": None if event.until_ns is None else format_time(event.until_ns),
        "adopted": list(event.adopted),
    }


def _ring_line(node: int, rings: LevelRings) -> str:
    ranges = rings.ranges[node]
    figures = (
        f"known: {np.count_nonzero(~np.isnan(ranges))}, clear: {np.count_nonzero(np.isposinf(ranges))}, "
        f"support: {rings.support[node]:.2f}"
    )
    return f'    {node}: {{digest: "{rings.digests[node]}", {figures}, ranges: "{encoded(ranges)}"}}'


def _baseline(values: Any, path: Path) -> Baseline:
    places = values["nodes"]
    nodes = tuple(Node(float(places[i]["x"]), float(places[i]["y"])) for i in range(len(places)))
    bins = int(values["angle_bins"])
    scans = values["scans"]
    expected = Snapshot(
        version=str(values["version"]),
        inputs=tuple(Input(one["name"], one["sha256"]) for one in values["inputs"]),
        settings=dict(values["settings"]),
        map_frame=str(values["map_frame"]),
        radius=float(values["radius"]),
        angle_bins=bins,
        no_return=str(values["no_return"]),
        beams={topic: dict(kinds) for topic, kinds in values["beams"].items()},
        scans=Scans(int(scans["read"]), int(scans["used"]), dict(scans["dropped"])),
        nodes=nodes,
        levels={name: _rings(rows or {}, len(nodes), bins) for name, rows in values["levels"].items()},
        events=tuple(_event(one) for one in values["events"]),
    )
    return Baseline(expected, checked(values["tolerances"], str(path)))


def _rings(rows: Mapping[int, Mapping[str, Any]], nodes: int, bins: int) -> LevelRings:
    ranges = np.full((nodes, bins), np.nan)
    support = np.zeros(nodes)
    digests = [""] * nodes
    for node, row in rows.items():
        if not 0 <= node < nodes:
            raise ValueError(f"there is no node {node}")
        ranges[node] = decoded(str(row["ranges"]), bins)
        support[node] = float(row["support"])
        digests[node] = str(row["digest"])
    return LevelRings(ranges, support, tuple(digests))


def _event(values: Mapping[str, Any]) -> SeenEvent:
    return SeenEvent(
        kind=str(values["kind"]),
        x=float(values["x"]),
        y=float(values["y"]),
        size=float(values["size"]),
        nodes=int(values["nodes"]),
        since_ns=parse_time(values["since"], 0, 0),
        until_ns=None if values["until"] is None else parse_time(values["until"], 0, 0),
        adopted=tuple(values["adopted"]),
    )
