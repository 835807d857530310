"""A baseline as a text file that a reviewer reads: a line for each setting, event, node, and ring of a level."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from timemap_cli.checks.coding import decoded, encoded
from timemap_cli.checks.fields import Fields
from timemap_cli.checks.snapshot import (
    Input,
    LevelRings,
    Scans,
    SeenEvent,
    Snapshot,
    require_comparable_size,
)
from timemap_cli.checks.tolerances import checked
from timemap_cli.errors import TimemapError, UsageError, no_such_file, refuse_pipe
from timemap_cli.model.nodes import Node
from timemap_cli.plain_yaml import Bounds, YamlError, plain_values
from timemap_cli.times import format_time, parse_time
from timemap_cli.versions import require_readable

FORMAT = "timemap.baseline/1"
HEAD = "# What the map of these recordings is expected to be, for `timemap check`; --update-baseline writes it anew.\n"
_ANEW = "remove it, or name another file: --update-baseline makes it anew then"
_PAIR = re.compile(r"\\ud[89ab][0-9a-f]{2}\\ud[c-f][0-9a-f]{2}")  # how JSON writes a letter beyond 16 bits
_WORDS = ("null", "true", "false")  # names of levels that YAML would read as something else
_MOST_OCTETS = 32_000_000  # of the largest map there may be, twice
_BINS = (1, 3600)  # angle bins of a node
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


def _missing(path: Path) -> UsageError:
    """The error where no baseline is: how to make it, and what is called much like it."""
    making = "--update-baseline makes it"
    error = no_such_file(path, making)
    return UsageError(error.message, hint=making if error.hint == making else f"{making}\n{error.hint}")


def read(path: Path) -> Baseline:
    """A baseline from its file.

    Raises UsageError where there is none, where it is anything else, or for tolerances that are not known;
    TimemapError where it cannot be read or is damaged.
    """
    refuse_pipe(path)
    try:
        with path.open("rb") as file:
            head = file.read(1000)
            if not _begins_like_one(head):  # a recording of gigabytes, perhaps
                raise _not_read(path, head)
            text = (head + file.read(_MOST_OCTETS)).decode()
    except FileNotFoundError as error:
        raise _missing(path) from error
    except UnicodeDecodeError as error:
        raise _not_a_baseline(path) from error
    except OSError as error:
        raise TimemapError(f"cannot read {path}: {(error.strerror or str(error)).lower()}") from error
    try:
        return _baseline(Fields(plain_values(text, _bounds(text)), ""), path)
    except UsageError:
        raise
    except YamlError as error:
        raise _damaged(path, f"it {error}") from error
    except ValueError as error:
        raise _damaged(path, str(error)) from error


def _bounds(text: str) -> Bounds:
    """How large a baseline may be that has so many rows: one of a large map is read for long, any other text is not."""
    rows = sum(text.count(word) for word in ("ranges:", "x:", "sha256:"))
    return Bounds(min(100_000 + 20_000 * rows, _MOST_OCTETS), 3_000 + 30 * rows)


def is_baseline(path: Path) -> bool:
    """Whether a file begins like a baseline, of any version: only such a file may give way to a new one."""
    if not path.is_file():  # opening a pipe would wait for somebody to write
        return False
    with path.open("rb") as file:
        return _begins_like_one(file.read(1000), FORMAT.partition("/")[0])


def _begins_like_one(head: bytes, form: str = f"{FORMAT}\n") -> bool:
    return f"\nformat: {form}".encode() in b"\n" + head.replace(b"\r\n", b"\n")


def _damaged(path: Path, trouble: str) -> TimemapError:
    return TimemapError(f"{path} is damaged: {' '.join(trouble.split())[:200]}", hint=_ANEW)


def _not_read(path: Path, head: bytes) -> UsageError:
    """The error for a file that is no baseline, or one of another version."""
    form, version = (_line_of(head, name) for name in ("format", "version"))
    try:
        require_readable(path, form, FORMAT, version or "unknown", _ANEW)
    except UsageError as error:
        return error
    except ValueError:
        pass
    return _not_a_baseline(path)


def _line_of(head: bytes, name: str) -> str | None:
    """What stands behind a name at the beginning of a line."""
    found = re.search(rf"^{name}: *\"?([ -~]*?)\"?\r?$", head.decode(errors="replace"), re.MULTILINE)
    return found[1] if found else None


def _not_a_baseline(path: Path) -> UsageError:
    return UsageError(f"{path} is not a baseline of the format {FORMAT}", hint=_ANEW)


def _lines(baseline: Baseline) -> Iterator[str]:
    one = baseline.expected
    yield f"format: {FORMAT}"
    yield f"version: {_quoted(one.version)}"
    yield from _list("inputs", [{"name": i.name, "sha256": i.sha256} for i in one.inputs])
    yield from _mapping("settings", one.settings)
    yield f"map_frame: {_quoted(one.map_frame)}"
    yield f"radius: {one.radius}"
    yield f"angle_bins: {one.angle_bins}"
    yield f"no_return: {_quoted(one.no_return)}"
    yield from _rows("beams", {_quoted(topic): kinds for topic, kinds in one.beams.items()})
    dropped = ", ".join(f"{reason}: {count}" for reason, count in sorted(one.scans.dropped.items()))
    yield f"scans: {{read: {one.scans.read}, used: {one.scans.used}, dropped: {{{dropped}}}}}"
    yield from _mapping("tolerances", dict(sorted(baseline.tolerances.items())))
    yield from _list("events", [_event_values(event) for event in one.events])
    if one.laid is not None:
        yield f"laid: {_quoted(one.laid)}"
    yield from _rows("nodes", {str(i): {"x": node.x, "y": node.y} for i, node in enumerate(one.nodes)})
    yield from _RINGS_NOTE
    yield "levels:"
    for level, rings in one.levels.items():
        yield f"  {_quoted(level) if level in _WORDS else level}:"
        yield from (_ring_line(node, rings) for node in range(len(one.nodes)) if rings.digests[node])


def _mapping(name: str, values: Mapping[str, object]) -> Iterator[str]:
    yield f"{name}:" if values else f"{name}: {{}}"
    yield from (f"  {key}: {_quoted(value)}" for key, value in values.items())


def _rows(name: str, rows: Mapping[str, Mapping[str, object]]) -> Iterator[str]:
    yield f"{name}:" if rows else f"{name}: {{}}"
    yield from (f"  {key}: {_flow(row)}" for key, row in rows.items())


def _list(name: str, rows: Sequence[Mapping[str, object]]) -> Iterator[str]:
    yield f"{name}:" if rows else f"{name}: []"
    yield from (f"- {_flow(row)}" for row in rows)


def _flow(row: Mapping[str, object]) -> str:
    return "{" + ", ".join(f"{key}: {_quoted(value)}" for key, value in row.items()) + "}"


def _quoted(value: object) -> str:
    """A value as YAML reads it, in ASCII: as JSON writes it, but letters beyond 16 bits and DEL in YAML's own way."""
    return _PAIR.sub(_as_yaml, json.dumps(value).replace("\x7f", "\\x7f"))


def _as_yaml(pair: "re.Match[str]") -> str:
    letter: str = json.loads(f'"{pair[0]}"')
    return f"\\U{ord(letter):08x}"


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


def _baseline(values: Fields, path: Path) -> Baseline:
    places = values.part("nodes").numbered()
    if list(places) != list(range(len(places))):
        raise ValueError("the nodes are not numbered from 0 on")
    nodes = tuple(Node(place.number("x"), place.number("y")) for place in places.values())
    bins = values.whole("angle_bins", *_BINS)
    scans = values.part("scans")
    expected = Snapshot(
        version=values.text("version"),
        inputs=tuple(Input(one.text("name"), one.text("sha256")) for one in values.rows("inputs")),
        settings=values.part("settings").plain(),
        map_frame=values.text("map_frame"),
        radius=values.number("radius"),
        angle_bins=bins,
        no_return=values.text("no_return"),
        beams={topic: kinds.numbers() for topic, kinds in values.part("beams").parts().items()},
        scans=Scans(scans.whole("read"), scans.whole("used"), scans.part("dropped").wholes()),
        nodes=nodes,
        levels=_levels(values.part("levels"), len(nodes), bins),
        events=tuple(_event(one) for one in values.rows("events")),
        laid=values.flag("laid"),
    )
    return Baseline(expected, checked(values.part("tolerances").plain(), str(path)))


def _levels(levels: Fields, nodes: int, bins: int) -> dict[str, LevelRings]:
    """The rings of each level; one that knows no node has nothing behind its name."""
    require_comparable_size(nodes, bins, len(levels.plain()))
    return {
        name: _rings(levels.part(name).numbered() if levels.has(name) else {}, nodes, bins)
        for name in levels.plain()
    }


def _rings(rows: Mapping[int, Fields], nodes: int, bins: int) -> LevelRings:
    ranges = np.full((nodes, bins), np.nan)
    support = np.zeros(nodes)
    digests = [""] * nodes
    for node, row in rows.items():
        if not 0 <= node < nodes:
            raise ValueError(f"there is no node {node}")
        ranges[node] = decoded(row.text("ranges"), bins)
        support[node] = row.number("support")
        digests[node] = row.text("digest")
    return LevelRings(ranges, support, tuple(digests))


def _event(values: Fields) -> SeenEvent:
    return SeenEvent(
        kind=values.text("kind"),
        x=values.number("x"),
        y=values.number("y"),
        size=values.number("size"),
        nodes=values.whole("nodes"),
        since_ns=_time(values.text("since")),
        until_ns=_time(values.text("until")) if values.has("until") else None,
        adopted=values.texts("adopted"),
    )


def _time(text: str) -> int:
    try:
        return parse_time(text, 0, 0)
    except UsageError as error:
        raise ValueError(error.message) from error
