"""Statistics of one scan topic over a whole recording."""

from dataclasses import dataclass

import numpy as np

from timemap_cli.logs.batches import BeamLayout, Float64s, Int64s, ScanBatch
from timemap_cli.logs.beams import BeamCounts, Beams
from timemap_cli.logs.irregularities import pose_problems, time_problems
from timemap_cli.logs.pose_quality import PoseLimits, PoseQuality, PoseReport, report
from timemap_cli.logs.poses import PoseSource
from timemap_cli.logs.scan_window import sweep_durations


@dataclass(frozen=True, slots=True)
class ScanTopic:
    """What one scan topic of a recording holds."""

    topic: str
    frame_id: str
    count: int
    rate_hz: float | None
    n_beams: int
    fov_deg: float
    range_min_m: float
    range_max_m: float  # how far the scanner sees, as the recording shows it
    beams: BeamCounts
    with_pose: int  # scans
    found: tuple[str, ...]  # about its beams, in words
    pose_report: PoseReport | None  # None: no scan has a pose


class ScanStatistics:
    """Takes in the scans of a topic and looks up their poses as soon as the transforms around them are there."""

    def __init__(
        self, topic: str, beams: Beams | None, source: PoseSource | None, limits: PoseLimits
    ) -> None:
        self.source = source
        self._limits = limits
        self._topic = topic
        self._beams = beams
        self._counts = BeamCounts()
        self._layouts: dict[BeamLayout, int] = {}
        self._frames: dict[str, int] = {}
        self._stamps: list[Int64s] = []
        self._log: list[Int64s] = []
        self._waiting: list[tuple[str, Int64s, Int64s, Int64s]] = []  # frame, stamps, log times, sweeps
        self._posed: list[tuple[Int64s, Float64s]] = []
        self._quality: list[PoseQuality] = []
        self.oldest_needed_ns = 0

    def add(self, batch: ScanBatch) -> None:
        """Take in scans in the order of recording."""
        count = len(batch.stamps_ns)
        self._layouts[batch.layout] = self._layouts.get(batch.layout, 0) + count
        self._frames[batch.frame_id] = self._frames.get(batch.frame_id, 0) + count
        self._stamps.append(batch.stamps_ns)
        self._log.append(batch.log_ns)
        self._waiting.append((batch.frame_id, batch.stamps_ns, batch.log_ns, sweep_durations(batch)))
        if self._beams is not None:
            self._counts += self._beams.count(batch.ranges, batch.range_max)

    def waits_since(self, log_ns: int) -> bool:
        """Whether a scan recorded before a log time waits for its pose."""
        return any(bool((log < log_ns).any()) for _, _, log, _ in self._waiting)

    def look_up(self, until_ns: int | None) -> None:
        """Find the poses of scans recorded before a log time, of all if it is None."""
        waiting, self._waiting = self._waiting, []
        for frame, stamps, log, sweeps in waiting:
            due = np.ones(len(log), dtype=bool) if until_ns is None else log < until_ns
            if due.any() and self.source is not None:
                map_from_laser, known = self.source.lookup(frame, stamps[due])
                self._posed.append((stamps[due][known], map_from_laser[known]))
                self._quality.append(self.source.quality(frame, stamps[due], sweeps[due]).rows(known))
            if not due.all():
                self._waiting.append((frame, stamps[~due], log[~due], sweeps[~due]))
            self.oldest_needed_ns = max(self.oldest_needed_ns, int(stamps[due].max(initial=0)))
        pending = [int(stamps.min()) for _, stamps, _, _ in self._waiting]
        self.oldest_needed_ns = min([self.oldest_needed_ns, *pending])

    def outcome(self) -> ScanTopic:
        """The statistics of all scans taken in."""
        stamps = self._all_stamps()
        layout = max(self._layouts, key=lambda key: self._layouts[key], default=BeamLayout(0.0, 0.0, 0, 0.0))
        steps = np.diff(np.unique(stamps)) / 1e9
        return ScanTopic(
            topic=self._topic,
            frame_id=max(self._frames, key=lambda key: self._frames[key], default=""),
            count=len(stamps),
            rate_hz=1 / float(np.median(steps)) if steps.size else None,
            n_beams=layout.count,
            fov_deg=min(360.0, float(np.degrees(abs(layout.angle_increment) * max(0, layout.count - 1)))),
            range_min_m=self._beams.range_min if self._beams else 0.0,
            range_max_m=self._beams.clear_range if self._beams else 0.0,
            beams=self._counts,
            with_pose=sum(len(known) for known, _ in self._posed),
            found=self._beams.found if self._beams else (),
            pose_report=self._pose_report(),
        )

    def problems(self) -> list[str]:
        """Sentences about what is odd about the scans, their times and their poses."""
        stamps = self._all_stamps()
        found = time_problems(self._topic, stamps, np.concatenate([*self._log, np.empty(0, np.int64)]))
        bearings = {(layout.angle_min, layout.angle_increment, layout.count) for layout in self._layouts}
        if len(bearings) > 1:
            found.append(f"{self._topic}: the beams are laid out in {len(bearings)} ways")
        if len(self._frames) > 1:
            found.append(
                f"{self._topic}: scans in {len(self._frames)} frames: {', '.join(sorted(self._frames))}"
            )
        if self.source is not None:
            known = np.concatenate([*(part for part, _ in self._posed), np.empty(0, np.int64)])
            poses = np.concatenate([*(part for _, part in self._posed), np.empty((0, 3, 4))])
            found += self._unposed(stamps, known)
            found += pose_problems(self._topic, known, poses)
        return found

    def _pose_report(self) -> PoseReport | None:
        stamps = np.concatenate([*(known for known, _ in self._posed), np.empty(0, np.int64)])
        if self.source is None or not len(stamps):
            return None
        return report(stamps, PoseQuality.joined(self._quality), self._limits, self.source.covariances)

    def _unposed(self, stamps: Int64s, known: Int64s) -> list[str]:
        missing = len(stamps) - len(known)
        if missing <= 0.01 * len(stamps) or not len(known):
            return []
        before = int(np.count_nonzero(stamps < known.min()))
        after = int(np.count_nonzero(stamps > known.max()))
        where = f"{before} before the first pose, {after} after the last, {missing - before - after} between"
        return [f"{self._topic}: {missing} of {len(stamps)} scans have no pose ({where})"]

    def _all_stamps(self) -> Int64s:
        return np.concatenate([*self._stamps, np.empty(0, np.int64)])
