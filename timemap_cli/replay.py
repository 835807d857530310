"""From recordings to a result: the one place where logs, model and results meet."""

import json
import time
from collections import Counter
from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import ExitStack, closing
from copy import deepcopy
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from timemap_cli import assembly
from timemap_cli.ahead import ahead
from timemap_cli.config import Settings, dump, settings_hash
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.fingerprint import sha256
from timemap_cli.logs.recordings import Recording, open_recordings
from timemap_cli.logs.stream import EndOfRecording, ScanCounts, sweeps
from timemap_cli.logs.survey import Survey, survey
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.observer import Observations, Observer
from timemap_cli.model.schedule import Schedule
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.model.time_map import TimeMap
from timemap_cli.results.given_nodes import read_nodes
from timemap_cli.results.writer import VIEWERS_SPAN_NS, ResultWriter
from timemap_cli.times import format_time, parse_time

_NOT_LOST = ("outside_time",)  # reasons for dropping a scan that the user asked for


class Progress(Protocol):
    """Watches a replay."""

    def __call__(self, share: float, scans: int) -> None:
        """Take note that this share of the recordings (0..1) is done and so many scans were read."""


@dataclass(frozen=True, slots=True)
class ReplaySummary:
    """What a replay did. Every scan read is used or counted under a reason."""

    result: Path
    nodes: int
    levels: tuple[str, ...]
    scans_read: int
    scans_used: int
    dropped: Mapping[str, int]  # scans by reason
    seconds: float
    warnings: tuple[str, ...]
    data_lost: bool  # a recording is damaged, or more scans were dropped than max_dropped


def replay(
    logs: Sequence[Path],
    output: Path,
    settings: Settings,
    *,
    force: bool = False,
    nodes: Path | None = None,
    start: str | None = None,
    end: str | None = None,
    progress: Progress | None = None,
) -> ReplaySummary:
    """Replay recordings in time order through a map of nodes that remember, into a result file.

    `nodes` gives all nodes there will be; `start` (closed) and `end` (open) cut by the scans' stamps. An existing
    `output` is replaced only with `force`, and only when the new one is complete. Raises TimemapError.
    """
    began = time.perf_counter()
    with ExitStack() as stack:
        recordings = [stack.enter_context(recording) for recording in open_recordings(logs)]
        plan = survey(recordings, settings)
        given = read_nodes(nodes, plan.selection.map_frame) if nodes else ()
        result = stack.enter_context(_result(output, settings, plan, force=force))
        run = _Run(assembly.time_map(settings, given), result, assembly.schedule(settings))
        start_ns, end_ns = _span_ns(plan, start, end)
        counts = ScanCounts()
        blocks = sweeps(recordings, plan.selection, plan.beams, counts, start_ns=start_ns, end_ns=end_ns)
        observed = partial(_observed, blocks, assembly.observer(settings, given), counts, recordings)
        for step in stack.enter_context(closing(ahead(observed))):
            run.take(step)
            if progress is not None:
                progress(_share_done(plan, run.newest_ns), run.read.counts.read)
        summary = _summary(output, settings, plan, run, time.perf_counter() - began)
        _require_some_use(summary)
        metadata = _metadata(settings, recordings, run.read.digests, summary)
        result.finish(metadata, dump(settings), _report(plan, summary))
    return summary


@dataclass(frozen=True, slots=True)
class _Step:
    """A step of reading, and how far it has come."""

    seen: Observations | None  # None: a recording has ended
    counts: ScanCounts
    damage: tuple[str, ...]  # what is wrong with the recordings, as far as read
    digests: tuple[str, ...] = ()  # SHA-256 of each recording; with the last step


def _observed(
    blocks: Iterable[Sweeps | EndOfRecording],
    observer: Observer,
    counts: ScanCounts,
    recordings: Sequence[Recording],
) -> Generator[_Step, None, None]:
    for block in blocks:
        seen = None if isinstance(block, EndOfRecording) else observer.observe(block)
        yield _Step(seen, deepcopy(counts), _damage(recordings))
    digests = tuple(sha256(recording.path) for recording in recordings)
    yield _Step(None, counts, _damage(recordings), digests)  # with what was dropped after the last block


def _damage(recordings: Sequence[Recording]) -> tuple[str, ...]:
    return tuple(f"{r.path}: {problem}" for r in recordings for problem in r.problems)


class _Run:
    """A replay under way: observations go in, and what they change goes to the result."""

    def __init__(self, time_map: TimeMap, result: ResultWriter, schedule: Schedule) -> None:
        self.time_map = time_map
        self.used = 0
        self.dropped: Counter[str] = Counter()
        self.read = _Step(None, ScanCounts(), ())
        self.newest_ns: int | None = None  # stamp of the newest scan learnt
        self.began_anew = False  # stamps went back from one recording to the next
        self._maps_are_due = False
        self._result = result
        self._schedule = schedule
        self._latest: dict[str, dict[int, Estimate]] = {level: {} for level in time_map.levels}

    def take(self, step: _Step) -> None:
        self.read = step
        if step.seen is None:
            self._end_recording()
        else:
            self._replay(step.seen)

    def _replay(self, seen: Observations) -> None:
        self.used += len(seen)
        self.dropped.update(node_not_seen=seen.node_not_seen, no_node=seen.no_node)
        for part, estimates_are_due in self._schedule.parts(seen.stamps_ns):
            self._learn(seen.part(part))
            if estimates_are_due:
                self._write_estimates()

    def _end_recording(self) -> None:
        """Write the maps, if anything has changed since: recordings may end together."""
        self._write_estimates()
        if self.newest_ns is not None and self._maps_are_due:
            self._result.write_maps(self._latest, self.time_map.nodes, self.newest_ns)
            self._maps_are_due = False

    @property
    def span_ns(self) -> int:
        """Time that the result spans so far."""
        return self._result.span_ns

    def _learn(self, scans: Observations) -> None:
        if not len(scans):
            return
        self.time_map.learn(scans)
        first_ns = int(scans.stamps_ns[0])
        if (
            self.newest_ns is None
        ):  # the result's time begins with the first scan, not with the first estimates
            self._result.write_nodes(self.time_map.nodes, first_ns)
        elif first_ns < self.newest_ns:
            self.began_anew = True
        self.newest_ns = int(scans.stamps_ns[-1])

    def _write_estimates(self) -> None:
        if self.newest_ns is None:
            return
        estimates = self.time_map.estimates()
        self._result.write_nodes(self.time_map.nodes, self.newest_ns)
        self._result.write_estimates(estimates, self.newest_ns)
        for found in estimates:
            self._latest[found.level][found.node] = found
            self._maps_are_due = True


def _result(output: Path, settings: Settings, plan: Survey, *, force: bool) -> ResultWriter:
    return ResultWriter(
        output,
        levels=[level.name for level in settings.levels],
        angle_bins=settings.map.angle_bins,
        radius=settings.map.radius,
        map_frame=plan.selection.map_frame,
        force=force,
    )


def _span_ns(plan: Survey, start: str | None, end: str | None) -> tuple[int | None, int | None]:
    """What is replayed, by the scans' stamps; UsageError where that is nothing."""
    start_ns = None if start is None else parse_time(start, *plan.span_ns)
    end_ns = None if end is None else parse_time(end, *plan.span_ns)
    if start_ns is not None and end_ns is not None and start_ns >= end_ns:
        raise UsageError(f"--start {start} is not before --end {end}", hint=_span_hint(plan))
    return start_ns, end_ns


def _span_hint(plan: Survey) -> str:
    return "the recordings go from {} to {}".format(*map(format_time, plan.span_ns))


def _share_done(plan: Survey, now_ns: int | None) -> float:
    """Share of the recordings' time that is over now."""
    if now_ns is None:
        return 0.0
    done = sum(min(max(now_ns, begin_ns), end_ns) - begin_ns for begin_ns, end_ns in plan.spans_ns)
    return done / max(1, sum(end_ns - begin_ns for begin_ns, end_ns in plan.spans_ns))


def _summary(output: Path, settings: Settings, plan: Survey, run: _Run, seconds: float) -> ReplaySummary:
    dropped = Counter(run.read.counts.dropped) + run.dropped
    lost = sum(count for reason, count in dropped.items() if reason not in _NOT_LOST)
    wanted = run.read.counts.read - sum(dropped[reason] for reason in _NOT_LOST)
    return ReplaySummary(
        result=output,
        nodes=len(run.time_map.nodes),
        levels=run.time_map.levels,
        scans_read=run.read.counts.read,
        scans_used=run.used,
        dropped=dict(sorted(dropped.items())),
        seconds=seconds,
        warnings=(*plan.selection.warnings, *plan.problems, *run.read.damage, *_other_warnings(run)),
        data_lost=bool(run.read.damage) or lost > settings.input.max_dropped * wanted,
    )


def _require_some_use(summary: ReplaySummary) -> None:
    if not summary.scans_used:
        reasons = (
            ", ".join(f"{reason} {count}" for reason, count in summary.dropped.items()) or "there is none"
        )
        raise TimemapError(
            f"no scan could be used: {reasons}", hint="timemap info LOG... tells what the recordings hold"
        )


def _other_warnings(run: _Run) -> Generator[str, None, None]:
    if run.began_anew:
        yield "the stamps of a recording begin before those of the one before it end: do not ask for times in between"
    for level, shortfall in run.time_map.shortfalls.items():
        if shortfall > 0.1:
            yield f"level {level} forgets more slowly than its half-life says: its window is too long for it"
    if unusable := run.read.counts.transforms_dropped:
        yield f"{unusable} transforms or poses could not be used"
    if run.span_ns > VIEWERS_SPAN_NS:
        yield f"the result spans {run.span_ns / 86400e9:.0f} days; Foxglove and Lichtblick open up to 93"


def _metadata(
    settings: Settings, recordings: Sequence[Recording], digests: Sequence[str], summary: ReplaySummary
) -> dict[str, str]:
    """What the result's metadata record says of where it comes from."""
    inputs = [{"name": r.path.name, "sha256": digest} for r, digest in zip(recordings, digests, strict=True)]
    return {
        "inputs": json.dumps(inputs),
        "settings_sha256": settings_hash(settings),
        "seed": str(settings.seed),
        "scans_read": str(summary.scans_read),
        "scans_used": str(summary.scans_used),
        "scans_dropped": json.dumps(summary.dropped),
    }


def _report(plan: Survey, summary: ReplaySummary) -> dict[str, Any]:
    """The summary as the result keeps it: nothing in it depends on where or how fast it was made."""
    return {
        "schema": "timemap.report/1",
        "nodes": summary.nodes,
        "levels": list(summary.levels),
        "scans": {"read": summary.scans_read, "used": summary.scans_used, "dropped": dict(summary.dropped)},
        "no_return": plan.no_return,
    }
