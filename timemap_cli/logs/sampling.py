"""A small sample of each recording, read in windows spread over its log time."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from timemap_cli.logs.batches import Batch, PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.poses import transform_topics
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.selection import POSE_TYPES, SCAN_TYPE

WINDOWS = 30  # over all recordings
LEAST_WINDOWS = 4  # of each recording
SCANS_OF_WINDOW = 20
# Transforms sent about once a second still stand on both sides of a scan.
LEAST_WINDOW_NS = 3_000_000_000


@dataclass(frozen=True, slots=True)
class Sample:
    """What the windows of some recordings hold."""

    scans: Mapping[tuple[int, str], tuple[ScanBatch, ...]]  # (index of the recording, topic) -> scans
    transforms: tuple[tuple[TransformBatch, ...], ...]  # of each recording
    static_transforms: tuple[TransformBatch, ...]  # of all recordings, whole
    poses: tuple[tuple[PoseBatch, ...], ...]  # of each recording

    def of_topic(self, topic: str) -> list[tuple[int, ScanBatch]]:
        """Scans of a topic with the index of their recording."""
        found = [(index, batches) for (index, name), batches in self.scans.items() if name == topic]
        return [(index, batch) for index, batches in found for batch in batches]


def take_sample(recordings: Sequence[Recording], scan_topics: Collection[str]) -> Sample:
    """Read a few hundred scans, the transforms and poses around them, and all static transforms."""
    n_windows = max(LEAST_WINDOWS, WINDOWS // max(1, len(recordings)))
    scans: dict[tuple[int, str], tuple[ScanBatch, ...]] = {}
    static: list[TransformBatch] = []
    transforms, poses = [], []
    for index, recording in enumerate(recordings):
        batches = _read_windows(recording, scan_topics, n_windows)
        static += _static_transforms(recording)
        transforms.append(tuple(batch for batch in batches if isinstance(batch, TransformBatch)))
        poses.append(tuple(batch for batch in batches if isinstance(batch, PoseBatch)))
        for topic in _present(recording, scan_topics):
            found = tuple(batch for batch in batches if isinstance(batch, ScanBatch) and batch.topic == topic)
            found = found or _first_scans(recording, topic)
            if found:
                scans[index, topic] = found
    return Sample(scans, tuple(transforms), tuple(static), tuple(poses))


def thinned(batch: ScanBatch, every: int) -> ScanBatch:
    """Every so many-th scan of a batch, the first among them."""
    if every <= 1:
        return batch
    return ScanBatch(
        batch.topic,
        batch.frame_id,
        batch.layout,
        batch.stamps_ns[::every],
        batch.log_ns[::every],
        batch.ranges[::every],
        batch.range_max[::every],
        batch.time_increment[::every],
    )


def _read_windows(recording: Recording, scan_topics: Collection[str], n_windows: int) -> list[Batch]:
    present = _present(recording, scan_topics)
    moving, _ = transform_topics(recording.topics)
    others = [topic.name for topic in recording.topics if topic.msgtype in POSE_TYPES]
    wanted = [*present, *moving, *others]
    found: list[Batch] = []
    stretches = tuple(windows(recording, _densest(recording, present), n_windows))
    most = SCANS_OF_WINDOW * n_windows // len(stretches)
    for start_ns, end_ns in stretches:
        parts = recording.batches(wanted, start_ns=start_ns, end_ns=end_ns)
        found += _thin_scans([batch for part in parts for batch in part], most)
    return found


def windows(recording: Recording, count: int, n_windows: int) -> Iterator[tuple[int, int]]:
    """Stretches of log time [start, end) spread evenly over a recording with `count` scans.

    Where they would cover the recording it is one stretch.
    """
    duration = recording.end_ns - recording.start_ns + 1
    length = max(LEAST_WINDOW_NS, duration * SCANS_OF_WINDOW // max(1, count))
    if length * n_windows >= duration:
        yield recording.start_ns, recording.end_ns + 1
        return
    for index in range(n_windows):
        start_ns = recording.start_ns + (duration - length) * index // (n_windows - 1)
        yield start_ns, start_ns + length


def _thin_scans(batches: Sequence[Batch], most: int) -> Iterator[Batch]:
    """Leave about so many scans of each topic."""
    counts: defaultdict[str, int] = defaultdict(int)
    for batch in batches:
        if isinstance(batch, ScanBatch):
            counts[batch.topic] += len(batch.stamps_ns)
    for batch in batches:
        if isinstance(batch, ScanBatch):
            yield thinned(batch, round(counts[batch.topic] / most))
        else:
            yield batch


def _static_transforms(recording: Recording) -> list[TransformBatch]:
    _, static = transform_topics(recording.topics)
    parts = [batch for part in recording.batches(static) for batch in part] if static else []
    return [batch for batch in parts if isinstance(batch, TransformBatch)]


def _first_scans(recording: Recording, topic: str) -> tuple[ScanBatch, ...]:
    """Scans of a topic that no window met, from where it begins."""
    for part in recording.batches([topic]):
        if found := tuple(batch for batch in part if isinstance(batch, ScanBatch)):
            return tuple(thinned(batch, len(batch.stamps_ns) // SCANS_OF_WINDOW) for batch in found)
    return ()


def _present(recording: Recording, scan_topics: Collection[str]) -> list[str]:
    return [t.name for t in recording.topics if t.name in scan_topics and t.msgtype == SCAN_TYPE]


def _densest(recording: Recording, topics: Collection[str]) -> int:
    return max((topic.count for topic in recording.topics if topic.name in topics), default=0)
