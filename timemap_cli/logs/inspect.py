"""A full look at some recordings: what is in them, and what a replay would use."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from timemap_cli.config import Settings
from timemap_cli.errors import UsageError
from timemap_cli.logs.batches import BadBatch, Batch, PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.beams import Beams, settle
from timemap_cli.logs.interleave import NEVER_NS, Recorded, RecordedTopic, interleaved
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.pose_quality import PoseLimits
from timemap_cli.logs.poses import TF, PoseSource, transform_topics
from timemap_cli.logs.recordings import Recording, open_recordings
from timemap_cli.logs.sampling import Sample, take_sample
from timemap_cli.logs.scan_statistics import ScanStatistics, ScanTopic
from timemap_cli.logs.selection import (
    POSE_TYPES,
    SCAN_TYPE,
    PoseChoice,
    Seen,
    Selection,
    choose_poses,
    scan_candidates,
)
from timemap_cli.logs.survey import (
    SampledPoses,
    Survey,
    names_of,
    pose_limits,
    survey_sample,
    topics_of,
    what_is_seen,
)

# Transforms that a scan needs may be recorded so long after it.
PATIENCE_NS = 20_000_000_000


@dataclass(frozen=True, slots=True)
class PoseInfo:
    """A topic that poses could come from: poses themselves, or transforms."""

    topic: str
    msgtype: str
    count: int
    frame_id: str | None  # None for transforms
    child_frame_id: str | None


@dataclass(frozen=True, slots=True)
class LogInfo:
    """What one recording holds."""

    path: str
    format: str
    start_ns: int  # log time
    end_ns: int
    scans: tuple[ScanTopic, ...]
    poses: tuple[PoseInfo, ...]
    other_topics: int
    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Inspection:
    """What some recordings hold, and what a replay of them together would use."""

    logs: tuple[LogInfo, ...]
    selection: Selection | None  # None: a replay would end with `trouble`
    trouble: UsageError | None
    span_ns: (
        tuple[int, int] | None
    )  # from the first scan to the last, by their stamps; None without a selection
    chains: tuple[tuple[str, ...], ...]  # frames from the map to each laser, where poses come from transforms
    missing_returns: dict[
        tuple[int, str], MissingReturns
    ]  # by log and selected topic; empty where not tested
    missing_are_clear: dict[tuple[int, str], bool]  # by the same: what is made of it
    no_return: str | None  # "clear" or "ignore" (in one log at least); None without a selection
    problems: tuple[str, ...]  # of the recordings together


def inspect(paths: Sequence[Path], settings: Settings) -> Inspection:
    """Read recordings whole and tell what is in them.

    That a replay would not know what to use is told in the outcome; a file that cannot be read is an error.
    """
    with ExitStack() as stack:
        recordings = open_recordings(paths)
        for recording in recordings:
            stack.callback(recording.close)
        return inspect_recordings(recordings, settings)


def inspect_recordings(recordings: Sequence[Recording], settings: Settings) -> Inspection:
    """The same for recordings that are open, in the order of their starts."""
    topics = topics_of(recordings)
    sample = take_sample(recordings, [name for name, msgtype in topics.items() if msgtype == SCAN_TYPE])
    seen = what_is_seen(recordings, sample, topics)
    plan: Survey | None = None
    trouble: UsageError | None = None
    try:
        candidates = scan_candidates(names_of(recordings), topics, settings.input.scan_topics)
        plan = survey_sample(recordings, sample, candidates, settings)
    except UsageError as error:
        trouble = error
    choices = {topic: _choice(seen, topic, sample, plan, settings) for topic in seen.scan_frames}
    logs = [
        _LogReader(index, recording, sample, plan, choices, pose_limits(settings.gate)).read(
            _beside(index, recordings, sample)
        )
        for index, recording in enumerate(recordings)
    ]
    return Inspection(
        logs=tuple(logs),
        selection=plan.selection if plan else None,
        trouble=trouble,
        span_ns=plan.span_ns if plan else None,
        chains=_chains(seen, plan),
        missing_returns=dict(plan.missing_returns) if plan else {},
        missing_are_clear={key: one.missing_is_clear for key, one in plan.beams.items()} if plan else {},
        no_return=plan.no_return if plan else None,
        problems=plan.problems if plan else (),
    )


def _choice(
    seen: Seen, topic: str, sample: Sample, plan: Survey | None, settings: Settings
) -> PoseChoice | None:
    """Where the poses for scans of a topic come from: as in the replay, or as if it were the only topic."""
    if plan is not None:
        selection = plan.selection
        return PoseChoice(selection.map_frame, selection.pose, covariances=selection.covariances)
    try:
        return choose_poses(seen, (topic,), settings.input, SampledPoses(sample).are_known_somewhere)
    except UsageError:
        return None


def _chains(seen: Seen, plan: Survey | None) -> tuple[tuple[str, ...], ...]:
    if plan is None or plan.selection.pose != TF:
        return ()
    lasers = (frame for topic in plan.selection.scan_topics for frame in seen.scan_frames.get(topic, ()))
    chains = (seen.frames.path(plan.selection.map_frame, laser) for laser in dict.fromkeys(lasers))
    return tuple(chain for chain in chains if chain)


@dataclass(frozen=True, slots=True)
class _Part:
    """What of a recording lies around the time of another one (a ``Recorded``)."""

    recording: Recording
    start_ns: int
    end_ns: int

    @property
    def topics(self) -> Sequence[RecordedTopic]:
        return self.recording.topics

    def batches(self, topics: Collection[str]) -> Iterator[list[Batch]]:
        return self.recording.batches(topics, start_ns=self.start_ns, end_ns=self.end_ns + 1)


def _beside(index: int, recordings: Sequence[Recording], sample: Sample) -> list[_Part]:
    """Parts of the other recordings of a recording's drive that its scans may need."""
    (drive,) = (drive for drive in sample.drives if index in drive)
    first_ns = recordings[index].start_ns - PATIENCE_NS
    last_ns = recordings[index].end_ns + PATIENCE_NS
    others = (recordings[other] for other in drive if other != index)
    parts = [_Part(one, max(first_ns, one.start_ns), min(last_ns, one.end_ns)) for one in others]
    return [part for part in parts if part.start_ns <= part.end_ns]


class _LogReader:
    """Reads one recording whole, a stretch at a time, and keeps the statistics of its scans."""

    def __init__(
        self,
        index: int,
        recording: Recording,
        sample: Sample,
        plan: Survey | None,
        choices: dict[str, PoseChoice | None],
        limits: PoseLimits,
    ) -> None:
        self._index = index
        self._recording = recording
        self._sample = sample
        self._rejected = 0  # transforms and poses of this recording that cannot be used
        self._bad: Counter[tuple[str, str]] = Counter()
        self._frames: dict[str, PoseBatch] = {}
        self._scans: dict[str, ScanStatistics] = {}
        self._sources: dict[PoseChoice, PoseSource] = {}
        for name, msgtype in ((topic.name, topic.msgtype) for topic in recording.topics):
            if msgtype == SCAN_TYPE:
                choice = choices.get(name)
                if choice is not None and choice not in self._sources:
                    self._sources[choice] = self._new_source(choice)
                beams = _beams(index, name, sample, plan)
                source = self._sources.get(choice) if choice else None
                self._scans[name] = ScanStatistics(name, beams, source, limits)

    def read(self, beside: Sequence[_Part]) -> LogInfo:
        recording = self._recording
        recorded: list[Recorded] = [recording, *beside]
        topics = {number: _pose_topics(one) for number, one in enumerate(recorded)}
        topics[0] = [*self._scans, *topics[0]]
        for number, batches, until_ns in interleaved(recorded, topics, range(len(recorded))):
            for batch in batches or ():
                self._take(batch, is_own=not number)
            if until_ns < NEVER_NS:
                self._look_up(until_ns)
        self._look_up(None)
        scans = tuple(statistics.outcome() for statistics in self._scans.values())
        poses_found = tuple(self._pose_infos())
        problems = [*recording.problems, *recording.remarks, *self._pose_topic_problems()]
        problems += [problem for statistics in self._scans.values() for problem in statistics.problems()]
        return LogInfo(
            path=str(recording.path),
            format=recording.format,
            start_ns=recording.start_ns,
            end_ns=recording.end_ns,
            scans=scans,
            poses=poses_found,
            other_topics=len(recording.topics) - len(scans) - len(poses_found),
            problems=tuple(problems),
        )

    def _new_source(self, choice: PoseChoice) -> PoseSource:
        source = PoseSource(choice.map_frame, choice.pose, choice.covariances)
        (drive,) = (drive for drive in self._sample.drives if self._index in drive)
        for batch in self._sample.static.of_drive(drive):
            source.add(batch)
        return source

    def _take(self, batch: Batch, *, is_own: bool) -> None:
        if isinstance(batch, ScanBatch):
            self._scans[batch.topic].add(batch)
        elif not isinstance(batch, BadBatch):
            self._take_poses(batch, is_own=is_own)
        elif is_own:
            self._bad[batch.topic, batch.reason] += batch.count

    def _take_poses(self, batch: TransformBatch | PoseBatch, *, is_own: bool) -> None:
        if isinstance(batch, PoseBatch) and is_own:
            self._frames.setdefault(batch.topic, batch)
        before = self._rejected_so_far()
        for source in self._sources.values():
            source.add(batch)
        if is_own:
            self._rejected += self._rejected_so_far() - before

    def _rejected_so_far(self) -> int:
        return max((source.rejected for source in self._sources.values()), default=0)

    def _look_up(self, log_ns: int | None) -> None:
        """Find the poses of the scans that have waited long enough; of all without a log time."""
        until_ns = None if log_ns is None else log_ns - PATIENCE_NS
        if until_ns is not None and not any(
            s.waits_since(until_ns - PATIENCE_NS) for s in self._scans.values()
        ):
            return
        for statistics in self._scans.values():
            statistics.look_up(until_ns)
        for source in self._sources.values():
            needed = [s.oldest_needed_ns for s in self._scans.values() if s.source is source]
            source.forget(min(needed) - PATIENCE_NS)

    def _pose_infos(self) -> Iterable[PoseInfo]:
        moving, static = transform_topics(self._recording.topics)
        for topic in self._recording.topics:
            if topic.name in (*moving, *static):
                yield PoseInfo(topic.name, topic.msgtype, topic.count, None, None)
            elif topic.name in self._frames:
                batch = self._frames[topic.name]
                yield PoseInfo(topic.name, topic.msgtype, topic.count, batch.frame_id, batch.child_frame_id)

    def _pose_topic_problems(self) -> list[str]:
        found = [
            f"{topic}: {count} {'message' if count == 1 else 'messages'} {reason}"
            for (topic, reason), count in sorted(self._bad.items())
        ]
        if self._rejected:
            found.append(
                f"{self._rejected} transforms or poses are unusable (rotation of length zero, NaN, off the earth)"
            )
        return found


def _beams(index: int, topic: str, sample: Sample, plan: Survey | None) -> Beams | None:
    if plan is not None and (index, topic) in plan.beams:
        return plan.beams[index, topic]
    scans = sample.scans.get((index, topic))
    return settle(scans) if scans else None


def _pose_topics(recorded: Recorded) -> list[str]:
    """Topics of moving transforms, and of poses."""
    moving, _ = transform_topics(recorded.topics)
    return [*moving, *(topic.name for topic in recorded.topics if topic.msgtype in POSE_TYPES)]
