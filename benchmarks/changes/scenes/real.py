"""Recordings of real robots: a corridor from which two objects are gone, and places where nothing changed.

They are no part of the project: the scene measures those that are in the folder that it is given.
"""

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.changes.days import compared, refusal
from benchmarks.changes.maps import levels_of, walls_left
from benchmarks.changes.places import VANISHED, Event, claims, places_of_changes, read_events
from benchmarks.changes.recordings import Replayed, known_as, replayed, timemap_json
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.scores import find
from benchmarks.changes.table import claim_line, left_line
from benchmarks.changes.truth import Episode, Recorded, TrueChange, Truth


@dataclass(frozen=True, slots=True)
class Corridor:
    """Runs in which known objects are gone after the first: files, and a table of the objects' bounds."""

    name: str
    runs: tuple[str, ...]
    expected: str


@dataclass(frozen=True, slots=True)
class Quiet:
    """A recording in which nothing changes, and what a replay has to be told of it."""

    name: str
    file: str
    options: tuple[str, ...] = ()


WEAN = Corridor(
    "wean", ("wean/wean_run1.mcap", "wean/wean_run3.mcap", "wean/wean_run4.mcap"), "wean/EXPECTED_CHANGES.csv"
)
QUIET = (
    Quiet("intel", "intel/intel.mcap"),
    Quiet("olin_mac1", "olin_mac1", ("--map-frame", "odom")),
    Quiet("bham_pioneer", "bham_pioneer/trace1.bag"),
)


def real_recordings(work: Work) -> Iterator[str]:
    """Figures of the recordings that are there."""
    data = work.data
    if data is None:
        yield "not measured: --data names the folder of the recordings"
        return
    quiet = [one for one in QUIET if (data / one.file).exists()]
    corridors = [one for one in (WEAN,) if (data / one.expected).exists()]
    if not quiet and not corridors:
        yield f"not measured: {data} holds none of the recordings"
    for corridor in corridors:
        yield _corridor(corridor, work, data)
    for one in quiet:
        yield _quiet(one, work, data)


def _corridor(corridor: Corridor, work: Work, data: Path) -> str:
    runs = [data / run for run in corridor.runs]
    spans = [_span(run) for run in runs]
    recordings = tuple(
        Recorded(r.name, i, *span, ()) for i, (r, span) in enumerate(zip(runs, spans, strict=True), 1)
    )
    gone = expected((data / corridor.expected).read_text(encoding="utf-8"), recordings[0].end_ns + 1)
    truth = Truth(recordings, gone)
    all_runs = _replay(corridor.name, runs, work)
    apart = [_replay(f"{corridor.name}_{run.stem}", [run], work) for run in (runs[0], runs[-1])]
    first, last = recordings[0], recordings[-1]
    ends = ("--between", str(first.end_ns), str(last.end_ns))
    told: dict[str, list[Event] | str] = {"changes": _events(all_runs.result)}
    for level in levels_of(all_runs.result):
        told[f"diff --between, {level}"] = _differences(level, last, str(all_runs.result), *ends)
    told["diff of two results, mid"] = _differences("mid", last, *(str(one.result) for one in apart))
    return "\n".join([f"{corridor.name}: {all_runs.lost}", _left(all_runs.result), *_lines(told, truth)])


def expected(table: str, since_ns: int) -> tuple[TrueChange, ...]:
    """The objects that are gone from `since_ns` on, from a table of their bounds [m]; `#` begins a comment."""
    rows = csv.DictReader(line for line in table.splitlines() if not line.startswith("#"))
    found = []
    for i, row in enumerate(rows, 1):
        x_min, x_max, y_min, y_max = (float(row[key]) for key in ("x_min", "x_max", "y_min", "y_max"))
        outline = ((x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max))
        found.append(TrueChange(f"object {i}", VANISHED, outline, None, (Episode(since_ns, None),)))
    return tuple(found)


def _lines(told: Mapping[str, Sequence[Event] | str], truth: Truth) -> list[str]:
    """For each way of asking, what is told of the truth, and everything else that is told."""
    lines = []
    for how, events in told.items():
        if isinstance(events, str):
            lines.append(f"  {how}: {events}")
            continue
        found = find(claims(events), places_of_changes(truth), truth)
        objects = f"{len(found.match)} of {len(found.places)} told, " if found.places else ""
        lines.append(f"  {how}: {objects}{len(found.false)} others")
        lines += [claim_line(claim) for claim in found.false]
    return lines


def _quiet(one: Quiet, work: Work, data: Path) -> str:
    """Everything that is told is false."""
    recording = data / one.file
    start_ns, end_ns = _span(recording)
    middle_ns = (start_ns + end_ns) // 2
    here = Recorded(recording.name, 1, start_ns, end_ns, ())
    whole = _replay(one.name, [recording], work, *one.options)
    halves = [
        _replay(f"{one.name}_{half}", [recording], work, *one.options, option, str(middle_ns))
        for half, option in (("begins", "--end"), ("ends", "--start"))
    ]
    result = str(whole.result)
    told: dict[str, list[Event] | str] = {"changes": _events(whole.result)}
    for other in ("mid", "short"):
        told[f"diff --level long {other}"] = _differences("long", here, result, other_level=other)
    for level in levels_of(whole.result):
        told[f"diff --between middle and end, {level}"] = _differences(
            level, here, result, "--between", str(middle_ns), str(end_ns)
        )
    told["diff of its halves, mid"] = _differences("mid", here, *(str(half.result) for half in halves))
    nothing = Truth((here,), ())
    return "\n".join([f"{one.name}: {whole.lost}", _left(whole.result), *_lines(told, nothing)])


def _left(result: Path) -> str:
    document = timemap_json("changes", str(result))
    left = {level: walls_left(result, document, level) for level in levels_of(result)}
    return f"  {left_line(left)}"


def _events(result: Path) -> list[Event]:
    return read_events(timemap_json("changes", str(result)))


def _differences(level: str, after: Recorded, *arguments: str, other_level: str = "") -> list[Event] | str:
    """What a call of `timemap diff` tells, or why it refuses."""
    try:
        return compared(level, after, 1, *arguments, other_level=other_level)[0]
    except RuntimeError as error:
        return refusal(error)


def _span(recording: Path) -> tuple[int, int]:
    """First and last stamp of a recording."""
    (log,) = timemap_json("info", str(recording), also=range(1, 4))["logs"]
    return int(log["start_ns"]), int(log["end_ns"])


def _replay(name: str, recordings: Sequence[Path], work: Work, *options: str) -> Replayed:
    key = known_as(recordings, *options)
    return replayed(
        recordings, work.folder / "real" / f"{name}_{key}.timemap.mcap", *options, again=work.again
    )
