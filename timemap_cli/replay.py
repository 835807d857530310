"""From recordings to a result: the one place where logs, model and results meet."""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Protocol

from timemap_cli import assembly
from timemap_cli.config import Settings, dump, settings_hash
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.beams import BeamCounts
from timemap_cli.logs.fingerprint import sha256
from timemap_cli.logs.pose_quality import JUMP, UNCERTAIN
from timemap_cli.logs.recordings import Recording, open_recordings
from timemap_cli.logs.survey import Survey, survey
from timemap_cli.model.learner import Kept
from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import MOST_NODES
from timemap_cli.overridden import overridden
from timemap_cli.reports.changes_json import changes_document
from timemap_cli.results.given_nodes import read_nodes
from timemap_cli.results.writer import VIEWERS_SPAN_NS, ResultWriter
from timemap_cli.resuming import Earlier
from timemap_cli.second_process import mapped
from timemap_cli.stages import Observing, Writing
from timemap_cli.times import format_time, parse_time

# Reasons for dropping a scan by which nothing is lost: the user asked for it, or the scan is there once more.
_NOT_LOST = ("outside_time", "duplicate")


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
    likely: Sequence[Node] = (),
    start: str | None = None,
    end: str | None = None,
    resume: Path | None = None,
    progress: Progress | None = None,
) -> ReplaySummary:
    """Replay recordings in time order through a map of nodes that remember, into a result file.

    `nodes` gives all nodes there will be; a node that is due near a `likely` one is made there; `start` (closed) and
    `end` (open) cut by the scans' stamps; `resume` is a result of earlier recordings, to go on from with the same
    settings: the map becomes what it would be if all were
    replayed in one go. An existing `output` is replaced only with `force`, and only when the new one is complete.
    Raises TimemapError.
    """
    began = time.perf_counter()
    with ExitStack() as stack:
        earlier = _earlier(resume, settings)
        if earlier is not None:
            stack.enter_context(earlier.damage_told())
        recordings = [stack.enter_context(recording) for recording in open_recordings(logs)]
        plan = _surveyed(recordings, settings, earlier)
        given = read_nodes(nodes, plan.selection.map_frame) if nodes else ()
        result = stack.enter_context(_result(output, settings, plan, force=force))
        observing = Observing(recordings, plan, assembly.observer(settings, given, likely))
        writing = Writing(result, [level.name for level in settings.levels], assembly.tracker(settings))
        start_ns, end_ns = _span_ns(plan, start, end)
        if earlier is not None:
            earlier.require_before(logs, plan.span_ns, start_ns)
            observing.restore(earlier.reading)
            writing.restore(earlier.parts(), observing.nodes)
        learning = partial(assembly.learner, settings, given)
        if earlier is not None:
            learning = partial(assembly.learner, settings, earlier.nodes, earlier.learnt)
        steps = observing.steps(start_ns, end_ns)
        for answer in stack.enter_context(closing(mapped(learning, steps))):
            if isinstance(answer, Kept):
                writing.keep(answer, observing.state)
                continue
            if writing.is_new:
                observing.set_aside(answer.lost)
            writing.take(answer, observing.nodes)
            if progress is not None:
                progress(_share_done(plan, observing.newest_ns), observing.counts.read)
        summary = _summary(output, settings, plan, observing, writing, resume, time.perf_counter() - began)
        _require_some_use(summary, plan, start=start, end=end, nodes=nodes)
        metadata = _metadata(settings, recordings, summary, resume)
        changes = changes_document(writing.tracker.events, observing.newest_ns)
        result.finish(metadata, dump(settings), _report(plan, summary), changes)
    return summary


def _earlier(resume: Path | None, settings: Settings) -> Earlier | None:
    if resume is None:
        return None
    earlier = Earlier.of(resume)
    earlier.require_same(settings)
    return earlier


def _surveyed(recordings: Sequence[Recording], settings: Settings, earlier: Earlier | None) -> Survey:
    if earlier is None:
        return survey(recordings, settings)
    return survey(recordings, earlier.to_read_by, earlier.known)


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
    done = sum(min(max(now_ns, begin_ns), end_ns) - begin_ns for begin_ns, end_ns in plan.spans_ns.values())
    return done / max(1, sum(end_ns - begin_ns for begin_ns, end_ns in plan.spans_ns.values()))


def _summary(
    output: Path,
    settings: Settings,
    plan: Survey,
    observing: Observing,
    writing: Writing,
    resume: Path | None,
    seconds: float,
) -> ReplaySummary:
    read, dropped = observing.counts.read, observing.counts.dropped
    warnings = [*plan.selection.warnings, *plan.problems, *observing.damage, *observing.remarks]
    if observing.pause is not None:
        warnings.append(observing.pause.told(resume))
    too_many = _too_many_dropped(dropped, read, settings.input.max_dropped)
    return ReplaySummary(
        result=output,
        nodes=len(writing.nodes),
        levels=tuple(level.name for level in settings.levels),
        scans_read=read,
        scans_used=observing.used,
        dropped=dict(sorted(dropped.items())),
        seconds=seconds,
        warnings=(*warnings, *_profile_warnings(settings), *_other_warnings(observing, writing), *too_many),
        data_lost=bool(observing.damage or too_many),
    )


def _too_many_dropped(dropped: Mapping[str, int], read: int, allowed: float) -> tuple[str, ...]:
    """A warning where a larger share of the scans was lost than is allowed."""
    lost = {reason: count for reason, count in sorted(dropped.items()) if count and reason not in _NOT_LOST}
    wanted = read - sum(dropped.get(reason, 0) for reason in _NOT_LOST)
    if sum(lost.values()) <= allowed * wanted:
        return ()
    share = f"{100 * sum(lost.values()) / wanted:.3g} % of the scans were dropped"
    reasons = ", ".join(f"{reason} {count}" for reason, count in lost.items())
    return (f"{share} ({reasons}), more than input.max_dropped allows ({100 * allowed:.3g} %)",)


def _profile_warnings(settings: Settings) -> tuple[str, ...]:
    found = overridden(settings)
    return (
        (f"profile {settings.profile} with other numbers than its own: {', '.join(found)}",) if found else ()
    )


def _require_some_use(
    summary: ReplaySummary, plan: Survey, *, start: str | None, end: str | None, nodes: Path | None
) -> None:
    """UsageError where the options left no scan, TimemapError where none could be used."""
    if summary.scans_used:
        return
    reasons = ", ".join(f"{reason} {count}" for reason, count in summary.dropped.items()) or "there is none"
    message = f"no scan could be used: {reasons}"
    if summary.dropped.keys() == {"outside_time"}:
        cut = [f"{name} {time}" for name, time in (("--start", start), ("--end", end)) if time is not None]
        raise UsageError(f"{message} ({' '.join(cut)})", hint=_span_hint(plan))
    if nodes is not None and "no_node" in summary.dropped:
        frame = plan.selection.map_frame
        raise UsageError(
            f"{message} (--nodes {nodes}: none is near enough)",
            hint=f"nodes where the robot drives, in metres of the frame {frame!r}",
        )
    raise TimemapError(
        message, hint="; ".join(plan.problems) or "timemap info LOG... tells what the recordings hold"
    )


def _other_warnings(observing: Observing, writing: Writing) -> Iterator[str]:
    if observing.began_anew:
        yield "the stamps of a recording begin before those of the one before it end: do not ask for times in between"
    for level, shortfall in writing.shortfalls.items():
        if shortfall > 0.1:
            yield (
                f"level {level} forgets more slowly than its half-life says: its window is too long for it, "
                f"only {1 - shortfall:.0%} of the scans due came"
            )
    if lost := observing.counts.dropped.get("lost"):
        yield (
            f"{lost} scans contradict nearly all that their place has long been and were set aside: the robot was "
            "lost, or the place is another one now (to learn them at once: gate.max_contradiction: 1)"
        )
    dropped = observing.counts.dropped
    if doubtful := {reason: dropped[reason] for reason in (UNCERTAIN, JUMP) if dropped.get(reason)}:
        reasons = ", ".join(f"{reason} {count}" for reason, count in doubtful.items())
        yield (
            f"{sum(doubtful.values())} scans were set aside because their pose cannot be trusted ({reasons}); "
            "timemap info tells how uncertain the poses are, gate.max_position_std, max_yaw_std_deg and max_jump "
            "are the limits"
        )
    if len(observing.nodes) >= MOST_NODES and observing.counts.dropped.get("no_node"):
        yield f"the map has {MOST_NODES} nodes, the most there may be: scans far from all were dropped (no_node)"
    if unusable := observing.counts.transforms_dropped:
        yield f"{unusable} transforms or poses could not be used"
    if writing.span_ns > VIEWERS_SPAN_NS:
        yield f"the result spans {writing.span_ns / 86400e9:.0f} days; Foxglove and Lichtblick open up to 93"


def _shares(counts: BeamCounts) -> dict[str, float]:
    """Share of each kind of beam in the sample that was looked at before the replay."""
    return {kind: round(count / max(1, counts.total), 4) for kind, count in asdict(counts).items()}


def _metadata(
    settings: Settings, recordings: Sequence[Recording], summary: ReplaySummary, resume: Path | None
) -> dict[str, str]:
    """What the result's metadata record says of where it comes from."""
    earlier = {} if resume is None else {"resumed_from": json.dumps(_fingerprint(resume))}
    return {
        "inputs": json.dumps([_fingerprint(recording.path) for recording in recordings]),
        **earlier,
        "settings_sha256": settings_hash(settings),
        "seed": str(settings.seed),
        "scans_read": str(summary.scans_read),
        "scans_used": str(summary.scans_used),
        "scans_dropped": json.dumps(summary.dropped),
    }


def _fingerprint(path: Path) -> dict[str, str]:
    return {"name": path.name, "sha256": sha256(path)}


def _report(plan: Survey, summary: ReplaySummary) -> dict[str, Any]:
    """The summary as the result keeps it: nothing in it depends on where or how fast it was made."""
    return {
        "schema": "timemap.report/1",
        "nodes": summary.nodes,
        "levels": list(summary.levels),
        "scans": {"read": summary.scans_read, "used": summary.scans_used, "dropped": dict(summary.dropped)},
        "no_return": plan.no_return,
        "beams": {topic: _shares(counts) for topic, counts in sorted(plan.beam_counts.items())},
    }
