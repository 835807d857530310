"""The scans of recordings that belong together, on their way from log order to stamp order and into the map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from timemap_cli.logs.batches import (
    BadBatch,
    Batch,
    BeamLayout,
    Float64s,
    ScanBatch,
)
from timemap_cli.logs.beams import Beams, settle
from timemap_cli.logs.coming import EndOfRecording, ScanCounts
from timemap_cli.logs.history import Bools
from timemap_cli.logs.interleave import NEVER_NS, Recorded, interleaved
from timemap_cli.logs.pose_quality import NO_LIMITS, PoseLimits
from timemap_cli.logs.poses import PoseSource, transform_topics
from timemap_cli.logs.scan_window import (
    BEGINNING_NS,
    MAX_SWEEP_NS,
    Entries,
    Kind,
    ScanWindow,
    repeats,
)
from timemap_cli.logs.selection import Selection
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.sweeps import Sweeps

# Blocks of this many scans keep the cost per block small; more only cost memory.
LEAST_SCANS = 128
MOST_SCANS = 512
MOST_BYTES = 16_000_000
# Without a scan for so long, what waits is let out and only the newest transforms are kept.
SILENCE_NS = 60_000_000_000
_EARLIER = -1  # stands for the recordings of an earlier replay


class DriveStream:
    """Recordings that belong together, on their way through the window."""

    def __init__(
        self,
        recordings: Sequence[Recorded],
        selection: Selection,
        beams: Mapping[tuple[int, str], Beams],
        counts: ScanCounts,
        span_ns: tuple[int, int],
        latest_ns: Mapping[int, int],
        limits: PoseLimits,
        poses: PoseSource,
        earlier: State | None = None,
    ) -> None:
        self._recordings = recordings
        self._rank = {topic: rank for rank, topic in enumerate(selection.scan_topics)}
        self._pose_topics = selection.pose_topics
        self._beams = dict(beams)
        self._counts = counts
        self._end_ns = span_ns[1]
        self._latest_ns = latest_ns
        self._poses = poses
        self._limits = limits
        self._window = ScanWindow(span_ns)
        self._frame_codes: dict[str, int] = {}
        self._newest_ns: dict[int, int] = {}  # recording -> largest stamp of its scans
        self._ends: list[tuple[int, int]] = []  # (stamp after which it is over, recording), not yet told
        self._ended: set[int] = set()
        self._group: Sequence[int] = ()
        self._scan_log_ns = self._log_end_ns = BEGINNING_NS
        self._goes_on = earlier is not None
        if earlier is not None:
            self._restore(earlier)

    def blocks(self, group: Sequence[int]) -> Iterator[Sweeps | EndOfRecording]:
        """Yield the blocks of the recordings and their ends, but for what waits until all of them have been read."""
        self._group = group
        if self._scan_log_ns == BEGINNING_NS:
            self._scan_log_ns = self._recordings[group[0]].start_ns
        self._log_end_ns = max(self._log_end_ns, *(self._recordings[index].end_ns for index in group))
        if self._goes_on:  # as where the next recording's turn comes, before anything of it is read
            yield from self._let_out(self._recordings[group[0]].start_ns)
        topics = {index: self._topics(index) for index in group}
        for index, batches, until_ns in interleaved(self._recordings, topics, group):
            if batches is None:
                self._end(index)
            else:
                self._take(index, batches)
            if until_ns == NEVER_NS:  # all have been read
                break
            self._arrive(until_ns)
            yield from self._let_out(until_ns)
            if self._window.ready_before_ns >= self._end_ns:
                break

    def what_is_left(self) -> Iterator[Sweeps | EndOfRecording]:
        """Yield what waits, and the ends of the recordings that have not been told."""
        self._arrive(NEVER_NS)
        for index in self._group or ((_EARLIER,) if not self._ends else ()):
            self._end(index)
        yield from self._placed(self._window.take_all(), NEVER_NS)

    def kept(self) -> State:
        """What waits, and what it needs to come out, for another drive that goes on."""
        return {
            "frames": list(self._frame_codes),
            # One that goes on behind the span is read once more.
            "ends_ns": [over_ns for over_ns, _ in self._ends if over_ns < self._end_ns],
            "scan_log_ns": self._scan_log_ns,
            "log_end_ns": self._log_end_ns,
            **prefixed("window", self._window.kept()),
            **prefixed("poses", self._poses.kept()),
        }

    def _restore(self, state: State) -> None:
        self._frame_codes = {frame: code for code, frame in enumerate(state["frames"])}
        self._ends = [(over_ns, _EARLIER) for over_ns in state["ends_ns"]]
        self._scan_log_ns, self._log_end_ns = state["scan_log_ns"], state["log_end_ns"]
        self._counts.read += self._window.restore(without_prefix("window", state))
        self._newest_ns[_EARLIER] = self._window.clock_ns

    def _topics(self, index: int) -> tuple[str, ...]:
        moving, _ = transform_topics(self._recordings[index].topics)
        return (*self._rank, *self._pose_topics, *moving)

    def _take(self, index: int, batches: Sequence[Batch]) -> None:
        for batch in batches:
            if isinstance(batch, ScanBatch):
                self._take_scans(index, batch)
            elif not isinstance(batch, BadBatch):
                self._poses.add(batch)
            elif batch.topic in self._rank:
                self._counts.read += batch.count
                self._counts.drop(batch.reason, batch.count)
            else:
                self._counts.transforms_dropped += batch.count

    def _take_scans(self, index: int, batch: ScanBatch) -> None:
        ahead = batch.stamps_ns > self._latest_ns.get(index, NEVER_NS)
        if ahead.any():
            self._counts.read += int(np.count_nonzero(ahead))
            self._counts.drop("ahead", int(np.count_nonzero(ahead)))
            batch = batch.chosen(~ahead)
        if not len(batch.stamps_ns):
            return
        if not _has_bearings(batch.layout):
            self._counts.read += len(batch.stamps_ns)
            self._counts.drop("malformed", len(batch.stamps_ns))
            return
        layout, frame, rank = batch.layout, batch.frame_id.lstrip("/"), self._rank[batch.topic]
        reading = self._reading(index, batch)
        self._window.add(
            batch,
            reading.resolve(batch.ranges, batch.range_max),
            Kind(rank, layout.angle_min, layout.angle_increment, layout.count, reading.clear_range),
            recording=index,
            frame=self._frame_codes.setdefault(frame, len(self._frame_codes)),
        )
        self._newest_ns[index] = max(self._newest_ns.get(index, BEGINNING_NS), int(batch.stamps_ns.max()))
        self._scan_log_ns = max(self._scan_log_ns, int(batch.log_ns.max()))

    def _reading(self, index: int, batch: ScanBatch) -> Beams:
        """What the beams mean; for a recording whose scans no sample met, as in another one."""
        key = (index, batch.topic)
        if key not in self._beams:
            others = [beams for (_, topic), beams in self._beams.items() if topic == batch.topic]
            self._beams[key] = others[0] if others else settle([batch]).ignoring_missing()
        return self._beams[key]

    def _end(self, index: int) -> None:
        """Note a recording read to its end: it is over after its newest scan, or after what is out."""
        if index not in self._ended:
            self._ended.add(index)
            newest_ns = self._newest_ns.get(index, BEGINNING_NS)
            self._ends.append((max(newest_ns, self._window.ready_before_ns), index))

    def _arrive(self, until_ns: int) -> None:
        arrived = self._window.arrive(until_ns)
        self._counts.read += arrived.read
        self._counts.drop("malformed", arrived.malformed)
        self._counts.drop("late", arrived.late)
        self._counts.drop("outside_time", arrived.outside)

    def _let_out(self, until_ns: int) -> Iterator[Sweeps | EndOfRecording]:
        """Yield what is ready if it is worth a block, or everything after a long silence of the scanner."""
        window = self._window
        if (
            window.count_ready() >= LEAST_SCANS
            or window.nbytes > MOST_BYTES
            or window.clock_ns - window.oldest_ns > SILENCE_NS
        ):
            yield from self._placed(window.take_ready(), window.ready_before_ns)
            self._poses.forget(window.oldest_ns - MAX_SWEEP_NS)
        if until_ns > self._scan_log_ns + SILENCE_NS:
            yield from self._placed(window.take_all(), window.ready_before_ns)
            self._poses.forget_all_but(SILENCE_NS)

    def _placed(self, entries: Entries, limit_ns: int) -> Iterator[Sweeps | EndOfRecording]:
        """Yield scans in stamp order as blocks; in between, recordings that are over before the limit."""
        again = repeats(entries)
        copies = self._window.are_copies(entries, np.flatnonzero(again))
        self._counts.drop("duplicate", int(np.count_nonzero(copies)))
        self._counts.drop("same_stamp", int(np.count_nonzero(~copies)))
        entries = entries[~again]
        first, last, known = self._look_up(entries)
        self._counts.drop("no_pose", len(known) - int(np.count_nonzero(known)))
        entries, first, last = entries[known], first[known], last[known]
        good = self._good(entries)
        entries, first, last = entries[good], first[good], last[good]
        over = sorted(end for end in self._ends if end[0] < limit_ns)
        self._ends = [end for end in self._ends if end[0] >= limit_ns]
        begin = 0
        for over_ns, recording in over:
            stop = int(np.searchsorted(entries["stamp"], over_ns, side="right"))
            yield from self._cut(entries[begin:stop], first[begin:stop], last[begin:stop])
            yield EndOfRecording(recording)
            begin = stop
        yield from self._cut(entries[begin:], first[begin:], last[begin:])
        self._window.release()

    def _look_up(self, entries: Entries) -> tuple[Float64s, Float64s, Bools]:
        """Poses (n, 3, 4) at the first and the last beams, and where (n,) they are known."""
        first, last = np.empty((len(entries), 3, 4)), np.empty((len(entries), 3, 4))
        known = np.zeros(len(entries), dtype=bool)
        for frame, code in self._frame_codes.items():
            rows = np.flatnonzero(entries["frame"] == code)
            stamps_ns, durations_ns = entries["stamp"][rows], entries["sweep"][rows]
            if len(rows):
                first[rows], last[rows], known[rows] = self._poses.sweep(frame, stamps_ns, durations_ns)
        return first, last, known

    def _good(self, entries: Entries) -> Bools:
        """Which scans (n,), whose poses are known, have poses within the limits; the others are counted."""
        good = np.ones(len(entries), dtype=bool)
        for frame, code in self._frame_codes.items():
            rows = np.flatnonzero(entries["frame"] == code)
            if len(rows) and self._limits != NO_LIMITS:
                quality = self._poses.quality(frame, entries["stamp"][rows], entries["sweep"][rows])
                for reason, worse in self._limits.set_aside(quality).items():
                    self._counts.drop(reason, int(np.count_nonzero(worse)))
                    good[rows[worse]] = False
        return good

    def _cut(self, entries: Entries, first: Float64s, last: Float64s) -> Iterator[Sweeps]:
        for kind, run in self._window.cut(entries, MOST_SCANS, MOST_BYTES):
            yield Sweeps(
                stamps_ns=entries["stamp"][run].copy(),
                ranges=self._window.gather(entries[run]),
                bearings=kind.bearings(),
                clear_range=kind.clear_range,
                map_from_laser_first=first[run],
                map_from_laser_last=last[run],
                scanner=kind.scanner,
            )


def _has_bearings(layout: BeamLayout) -> bool:
    finite = np.isfinite(layout.angle_min) and np.isfinite(layout.angle_increment)
    return bool(finite) and layout.count > 0 and (layout.angle_increment != 0 or layout.count == 1)
