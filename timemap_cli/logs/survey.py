"""What a replay needs to know before it starts, found out from a small sample of the recordings."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np

from timemap_cli.config import GateSettings, InputSettings, Settings
from timemap_cli.errors import UsageError
from timemap_cli.logs.batches import PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.beams import BeamCounts, Beams, settle
from timemap_cli.logs.drives import Drive
from timemap_cli.logs.frames import Frames
from timemap_cli.logs.missing_returns import MissingReturns, examine
from timemap_cli.logs.pose_quality import PoseLimits
from timemap_cli.logs.poses import PoseSource
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.sampled_poses import SampledPoses
from timemap_cli.logs.sampling import Sample, take_sample
from timemap_cli.logs.scan_window import WINDOW_NS
from timemap_cli.logs.selection import (
    POSE_TYPES,
    PoseTopic,
    Seen,
    Selection,
    gone_on_with,
    scan_candidates,
    select,
)
from timemap_cli.logs.shortcomings import carried, short_sighted, shortcomings
from timemap_cli.model.sweeps import Sweeps

DAY_NS = 86_400_000_000_000


@dataclass(frozen=True, slots=True)
class Survey:
    """What is read, and how the beams of each scanner are to be understood."""

    selection: Selection
    beams: Mapping[tuple[int, str], Beams]  # (index of the recording, scan topic); none where it has no scans
    beam_counts: Mapping[str, BeamCounts]  # scan topic -> kinds of its beams in the sample
    missing_returns: Mapping[tuple[int, str], MissingReturns]  # by the same; empty where not tested
    missing_so_far: Mapping[str, MissingReturns]  # by scan topic: over these recordings and all before them
    problems: tuple[str, ...]
    spans_ns: Mapping[
        int, tuple[int, int]
    ]  # index of the recording, if it has scans -> begin and end by their stamps
    drives: tuple[Drive, ...]  # recordings that are merged and share their transforms
    latest_ns: Mapping[int, int]  # index of the recording -> stamp beyond which no scan of it can be
    pose_limits: PoseLimits  # how good a scan's pose must be

    @property
    def span_ns(self) -> tuple[int, int]:
        """Begin of the first and end of the last recording, in time of the scans' stamps."""
        spans = self.spans_ns.values()
        return min(begin for begin, _ in spans), max(end for _, end in spans)

    def drives_within(self, start_ns: int | None, end_ns: int | None) -> tuple[Drive, ...]:
        """Drives without those that end well before a stamp, or begin at another or after it; all if none is left."""
        if start_ns is None and end_ns is None:
            return self.drives
        from_ns = -math.inf if start_ns is None else start_ns - WINDOW_NS
        until_ns = math.inf if end_ns is None else end_ns
        spans = {drive: [self.spans_ns[i] for i in drive if i in self.spans_ns] for drive in self.drives}
        within = (
            drive
            for drive, found in spans.items()
            if any(end >= from_ns and begin < until_ns for begin, end in found)
        )
        return tuple(within) or self.drives

    @property
    def no_return(self) -> str:
        """What a missing return counts as: "clear" or "ignore" (no evidence); "ignore" if in one recording."""
        return "clear" if all(beams.missing_is_clear for beams in self.beams.values()) else "ignore"

    @property
    def contradicted(self) -> float | None:
        """Share of missing returns that pass through something solid; of several recordings the worst."""
        shares = [found.contradicted for found in self.missing_returns.values()]
        return max((share for share in shares if share is not None), default=None)


@dataclass(frozen=True, slots=True)
class Known:
    """What was found out about earlier recordings; what these say themselves comes before it."""

    static_transforms: tuple[TransformBatch, ...] = ()  # those that hold, if these recordings have none
    missing_so_far: Mapping[str, MissingReturns] = field(default_factory=dict)  # as in Survey
    selection: Selection | None = None  # what was read of them, which not all of these recordings may hold


NOTHING_KNOWN = Known()


def survey(recordings: Sequence[Recording], settings: Settings, known: Known = NOTHING_KNOWN) -> Survey:
    """Look at a few hundred scans of the recordings and choose what to read and how.

    UsageError where there are no scans or no poses, or several and none named; it lists lines to paste.
    """
    topics = topics_of(recordings)
    try:
        candidates = scan_candidates(names_of(recordings), topics, _wanted(topics, settings, known))
        sample = take_sample(recordings, candidates)
        if not sample.scans:
            raise _no_scans(recordings, candidates)
        sample = replace(sample, static=replace(sample.static, earlier=known.static_transforms))
        return survey_sample(recordings, sample, candidates, settings, known)
    except UsageError as error:
        raise _with_damage(error, recordings) from error


def _wanted(topics: Mapping[str, str], settings: Settings, known: Known) -> tuple[str, ...]:
    """The scan topics to look at, if any are named; of those read before, a scanner may be silent now."""
    read_before = () if known.selection is None else known.selection.scan_topics
    return tuple(topic for topic in read_before if topic in topics) or settings.input.scan_topics


def _no_scans(recordings: Sequence[Recording], candidates: Sequence[str]) -> UsageError:
    reasons = sorted({why for one in recordings for topic, why in one.unusable if topic in candidates})
    are = f": they are {' or '.join(reasons)}" if reasons else ""
    return UsageError(f"no scan of {', '.join(candidates)} could be read{are}")


def survey_sample(
    recordings: Sequence[Recording],
    sample: Sample,
    candidates: Sequence[str],
    settings: Settings,
    known: Known = NOTHING_KNOWN,
) -> Survey:
    """The same, from a sample that was taken before."""
    seen = what_is_seen(recordings, sample, topics_of(recordings))
    poses = SampledPoses(sample)
    if known.selection is None:
        selection = select(seen, candidates, settings.input, poses.are_known_somewhere)
    else:
        selection = gone_on_with(known.selection, seen)
    chosen = {key: scans for key, scans in sample.scans.items() if key[1] in selection.scan_topics}
    beams = {key: settle(scans) for key, scans in chosen.items()}
    counts = _counts(chosen, beams)
    missing: dict[tuple[int, str], MissingReturns] = {}
    so_far = dict(known.missing_so_far)
    for index, topic in sorted(beams):
        if settings.input.no_return == "auto":
            found = _examined(
                sample, index, topic, beams[index, topic], poses, selection, settings.map.radius
            )
            missing[index, topic] = found
            # A part of a building may have little glass: what the recordings before this one found counts too. Those
            # after it do not, so that a replay in parts finds what one in one go does.
            so_far[topic] = so_far[topic] + found if topic in so_far else found
        if not _are_clear(so_far.get(topic), settings.input):
            beams[index, topic] = beams[index, topic].ignoring_missing()
    problems = (
        *shortcomings(recordings, sample, poses, selection),
        *carried(seen, sample, selection),
        *short_sighted(beams, settings),
    )
    spans_ns = _spans_ns(recordings, sample, selection)
    latest_ns = _latest_ns(len(recordings), sample, selection)
    limits = pose_limits(settings.gate)
    return Survey(
        selection, beams, counts, missing, so_far, problems, spans_ns, sample.drives, latest_ns, limits
    )


def pose_limits(gate: GateSettings) -> PoseLimits:
    """How good the settings want poses to be."""
    return PoseLimits(gate.max_position_std, math.radians(gate.max_yaw_std_deg), gate.max_jump)


def _with_damage(error: UsageError, recordings: Sequence[Recording]) -> UsageError:
    """The same error, and what is wrong with the recordings: that may be why."""
    damage = "; ".join(f"{recording.path}: {one}" for recording in recordings for one in recording.problems)
    return UsageError(f"{error.message} ({damage})", hint=error.hint) if damage else error


def topics_of(recordings: Sequence[Recording]) -> dict[str, str]:
    """Topics that hold messages, with their types, over all recordings."""
    return {t.name: t.msgtype for r in recordings for t in r.topics if t.count != 0}


def names_of(recordings: Sequence[Recording]) -> tuple[str, ...]:
    """The recordings as the user named them."""
    return tuple(str(recording.path) for recording in recordings)


def what_is_seen(recordings: Sequence[Recording], sample: Sample, topics: Mapping[str, str]) -> Seen:
    """Frames and poses of a sample."""
    transforms = chain(sample.static.all, *sample.transforms)
    edges = dict.fromkeys((batch.parent, batch.child) for batch in transforms)
    frames: dict[str, tuple[str, ...]] = {}
    for (_, topic), batches in sample.scans.items():
        found = (*frames.get(topic, ()), *(batch.frame_id for batch in batches))
        frames[topic] = tuple(dict.fromkeys(found))
    return Seen(names_of(recordings), topics, frames, Frames(edges), _pose_topics(recordings, sample, topics))


def _spans_ns(
    recordings: Sequence[Recording], sample: Sample, selection: Selection
) -> dict[int, tuple[int, int]]:
    """Log times of the recordings' ends as stamps: what was logged elsewhere may have been logged at another time."""
    found = {}
    for index, recording in enumerate(recordings):
        batches = [b for topic in selection.scan_topics for b in sample.scans.get((index, topic), ())]
        if batches:
            stamps_ns = np.concatenate([batch.stamps_ns for batch in batches])
            log_ns = np.concatenate([batch.log_ns for batch in batches])
            first, last = int(log_ns.argmin()), int(log_ns.argmax())
            begin_ns = recording.start_ns + int(stamps_ns[first] - log_ns[first])
            end_ns = recording.end_ns + int(stamps_ns[last] - log_ns[last])
            found[index] = begin_ns, max(begin_ns, end_ns)
    return found


def _latest_ns(count: int, sample: Sample, selection: Selection) -> dict[int, int]:
    """Stamps that no scan of a recording can have, going by nine tenths of the sampled ones.

    The others may go half as far again, and a day farther: a single stamp years ahead would make all that follow late.
    """
    found = {}
    for index in range(count):
        batches = [b for topic in selection.scan_topics for b in sample.scans.get((index, topic), ())]
        if batches:
            stamps_ns = np.sort(np.concatenate([batch.stamps_ns for batch in batches]))
            low, high = (int(stamps_ns[(len(stamps_ns) - 1) * tenths // 10]) for tenths in (1, 9))
            found[index] = high + (high - low) // 2 + DAY_NS
    return found


def _pose_topics(
    recordings: Sequence[Recording], sample: Sample, topics: Mapping[str, str]
) -> tuple[PoseTopic, ...]:
    found: dict[str, PoseBatch] = {}
    for batch in (batch for batches in sample.poses for batch in batches):
        found.setdefault(batch.topic, batch)
    counts = {name: sum(t.count for r in recordings for t in r.topics if t.name == name) for name in found}
    return tuple(
        PoseTopic(name, topics[name], found[name].frame_id, found[name].child_frame_id, counts[name])
        for name in sorted(found)
        if topics.get(name) in POSE_TYPES
    )


def _counts(
    scans: Mapping[tuple[int, str], Sequence[ScanBatch]], beams: Mapping[tuple[int, str], Beams]
) -> dict[str, BeamCounts]:
    """Kinds of the beams of each topic, over all recordings."""
    counts: dict[str, BeamCounts] = {}
    for (index, topic), batches in scans.items():
        for batch in batches:
            counted = beams[index, topic].count(batch.ranges, batch.range_max)
            counts[topic] = counts.get(topic, BeamCounts()) + counted
    return counts


def _are_clear(found: MissingReturns | None, wanted: InputSettings) -> bool:
    return wanted.no_return == "clear" if found is None else found.are_clear


def _examined(
    sample: Sample,
    index: int,
    topic: str,
    beams: Beams,
    poses: SampledPoses,
    selection: Selection,
    radius: float,
) -> MissingReturns:
    """What the test of missing returns finds for a topic of a recording.

    By the poses that the recording holds itself, if it holds any: those beside it do not change the outcome.
    """
    sweeps: list[Sweeps] = []
    for alone in (True, False):
        source = poses.source(index, selection.map_frame, selection.pose, alone=alone)
        sweeps = sweeps or [_placed(batch, beams, source) for batch in sample.scans[index, topic]]
        sweeps = [block for block in sweeps if len(block)]
    return examine(sweeps, radius)


def _placed(batch: ScanBatch, beams: Beams, source: PoseSource) -> Sweeps:
    """The scans of a batch that have a pose."""
    map_from_laser, known = source.lookup(batch.frame_id, batch.stamps_ns)
    layout = batch.layout
    return Sweeps(
        stamps_ns=batch.stamps_ns[known],
        ranges=beams.resolve(batch.ranges[known], batch.range_max[known]),
        bearings=layout.angle_min + layout.angle_increment * np.arange(layout.count, dtype=np.float64),
        clear_range=beams.clear_range,
        map_from_laser_first=map_from_laser[known],
        map_from_laser_last=map_from_laser[known],
    )
