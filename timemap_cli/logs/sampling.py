"""A small sample of each recording, read in windows spread over its log time."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from timemap_cli.logs.batches import PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.drives import Drive, drives
from timemap_cli.logs.history import MAX_GAP_NS
from timemap_cli.logs.interleave import joined
from timemap_cli.logs.poses import transform_topics
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.selection import POSE_TYPES, SCAN_TYPE
from timemap_cli.logs.static_transforms import StaticTransforms, read_static_transforms

WINDOWS = 15  # of each recording, whatever others there are: a replay in parts finds what one in one go does
SCANS_OF_WINDOW = 20
# Scans come in so long a time, however they are bunched.
LEAST_WINDOW_NS = 3_000_000_000


Stretch = tuple[int, int]  # [start, end) of log time [ns]


@dataclass(frozen=True, slots=True)
class Sample:
    """What the windows of some recordings hold."""

    scans: Mapping[tuple[int, str], tuple[ScanBatch, ...]]  # (index of the recording, topic) -> scans
    transforms: tuple[tuple[TransformBatch, ...], ...]  # of each recording
    static: StaticTransforms  # of all recordings, whole
    poses: tuple[tuple[PoseBatch, ...], ...]  # of each recording
    drives: tuple[Drive, ...]  # recordings that share transforms and poses


def take_sample(recordings: Sequence[Recording], scan_topics: Collection[str]) -> Sample:
    """Read a few hundred scans, the transforms and poses they may need, and all static transforms.

    Poses are looked up between samples up to 10 s apart, and in all recordings of a drive: so far around the
    scans they are read, from each of them.
    """
    scans: dict[tuple[int, str], tuple[ScanBatch, ...]] = {}
    stretches: list[list[Stretch]] = []
    for index, recording in enumerate(recordings):
        batches, spans = _read_windows(recording, scan_topics)
        for topic in _present(recording, scan_topics):
            found = tuple(batch for batch in batches if batch.topic == topic)
            if not found:
                found = _first_scans(recording, topic)
                spans += [(int(one.log_ns.min()), int(one.log_ns.max()) + 1) for one in found]
            if found:
                scans[index, topic] = found
        stretches.append(spans)
    around: list[list[TransformBatch | PoseBatch]] = [[] for _ in recordings]
    for group in joined(recordings, MAX_GAP_NS):
        spans = widened([span for index in group for span in stretches[index]], MAX_GAP_NS)
        for index in group:
            around[index] = _read_around(recordings[index], spans)
    transforms = tuple(tuple(b for b in found if isinstance(b, TransformBatch)) for found in around)
    return Sample(
        scans,
        transforms,
        StaticTransforms.of((read_static_transforms(recording)[0] for recording in recordings), None),
        tuple(tuple(b for b in found if isinstance(b, PoseBatch)) for found in around),
        drives(recordings, transforms),
    )


def thinned(batch: ScanBatch, every: int) -> ScanBatch:
    """Every so many-th scan of a batch, the first among them."""
    return batch if every <= 1 else batch.chosen(slice(None, None, every))


def _read_windows(
    recording: Recording, scan_topics: Collection[str]
) -> tuple[list[ScanBatch], list[Stretch]]:
    """Scans in windows, and where those lie."""
    present = _present(recording, scan_topics)
    stretches = list(windows(recording, _densest(recording, present)))
    most = SCANS_OF_WINDOW * WINDOWS // len(stretches)
    found: list[ScanBatch] = []
    for start_ns, end_ns in stretches:
        parts = recording.batches(present, start_ns=start_ns, end_ns=end_ns)
        batches = [batch for part in parts for batch in part if isinstance(batch, ScanBatch)]
        found += _thin_scans(batches, most)
    return found, stretches


def _read_around(recording: Recording, stretches: Sequence[Stretch]) -> list[TransformBatch | PoseBatch]:
    """Moving transforms and poses in stretches of log time."""
    moving, _ = transform_topics(recording.topics)
    wanted = [*moving, *(topic.name for topic in recording.topics if topic.msgtype in POSE_TYPES)]
    found: list[TransformBatch | PoseBatch] = []
    for start_ns, end_ns in stretches:
        if wanted and start_ns <= recording.end_ns and end_ns > recording.start_ns:
            for part in recording.batches(wanted, start_ns=start_ns, end_ns=end_ns):
                found += [batch for batch in part if isinstance(batch, TransformBatch | PoseBatch)]
    return found


def widened(stretches: Sequence[Stretch], by_ns: int) -> list[Stretch]:
    """Stretches [start, end) that reach so much farther on both sides; those that then meet are one."""
    found: list[Stretch] = []
    for start_ns, end_ns in sorted(stretches):
        if found and start_ns - by_ns <= found[-1][1]:
            found[-1] = found[-1][0], max(found[-1][1], end_ns + by_ns)
        else:
            found.append((start_ns - by_ns, end_ns + by_ns))
    return found


def windows(recording: Recording, count: int) -> Iterator[Stretch]:
    """Stretches of log time [start, end) spread evenly over a recording with `count` scans.

    Where they would cover the recording it is one stretch.
    """
    duration = recording.end_ns - recording.start_ns + 1
    length = max(LEAST_WINDOW_NS, duration * SCANS_OF_WINDOW // max(1, count))
    if length * WINDOWS >= duration:
        yield recording.start_ns, recording.end_ns + 1
        return
    for index in range(WINDOWS):
        start_ns = recording.start_ns + (duration - length) * index // (WINDOWS - 1)
        yield start_ns, start_ns + length


def _thin_scans(batches: Sequence[ScanBatch], most: int) -> Iterator[ScanBatch]:
    """Leave about so many scans of each topic."""
    counts: defaultdict[str, int] = defaultdict(int)
    for batch in batches:
        counts[batch.topic] += len(batch.stamps_ns)
    for batch in batches:
        yield thinned(batch, round(counts[batch.topic] / most))


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
