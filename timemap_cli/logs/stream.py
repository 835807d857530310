"""Recordings to scans with poses: one stream in stamp order, in blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from timemap_cli.logs.beams import Beams
from timemap_cli.logs.coming import Coming, Resumed, ScanCounts, Waiting
from timemap_cli.logs.drive_stream import DriveStream
from timemap_cli.logs.interleave import NEVER_NS, Recorded, joined
from timemap_cli.logs.pose_quality import NO_LIMITS, PoseLimits
from timemap_cli.logs.poses import PoseSource
from timemap_cli.logs.scan_window import (
    BEGINNING_NS,
    WINDOW_NS,
)
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.static_transforms import StaticTransforms, read_static_transforms
from timemap_cli.model.state import State, prefixed, without_prefix


def sweeps(
    recordings: Sequence[Recorded],
    selection: Selection,
    beams: Mapping[tuple[int, str], Beams],
    counts: ScanCounts,
    *,
    start_ns: int | None = None,
    end_ns: int | None = None,
    drives: Sequence[Sequence[int]] | None = None,
    latest_ns: Mapping[int, int] | None = None,
    limits: PoseLimits = NO_LIMITS,
    earlier: State | None = None,
) -> Iterator[Coming]:
    """Yield the scans of the selection in blocks, placed in the map frame; ``counts`` grows with them.

    ``recordings`` are in the order of their starts; ``beams`` is by (index, topic).
    Recordings of one of the ``drives`` are merged, with common transforms: where not given, those that
    overlap or follow within 10 s. Scans stamped later than ``latest_ns`` of their recording are dropped. Within a
    drive the scans come in stamp order; one drive follows the other. ``start_ns`` (closed) and ``end_ns``
    (open) cut by the scans' stamps; static transforms count wherever they stand. Scans whose pose is worse than
    the ``limits`` are left out. Which scans share a block has no bearing on any value.

    ``earlier`` is what an earlier replay of the same selection left `Waiting`: the scans go on as if its recordings
    stood before these.
    """
    span_ns = (BEGINNING_NS if start_ns is None else start_ns, NEVER_NS if end_ns is None else end_ns)
    groups = drives or joined(recordings, WINDOW_NS)
    static = _static_transforms(recordings, counts, earlier)
    begin = partial(DriveStream, recordings, selection, beams, counts, span_ns, latest_ns or {}, limits)
    goes_on = earlier is not None and recordings[groups[0][0]].start_ns <= earlier["log_end_ns"] + WINDOW_NS
    if earlier is not None:
        if not goes_on:
            yield from begin(_poses(selection, static, (), earlier), earlier).what_is_left()
        yield Resumed()
    for number, group in enumerate(groups):
        before = earlier if goes_on and not number else None
        poses = _poses(selection, static, group, before)
        rejected = poses.rejected if number else 0
        drive = begin(poses, before)
        yield from drive.blocks(group)
        if number == len(groups) - 1:
            kept = static.kept(group, goes_on=before is not None)
            yield Waiting(prefixed("static", kept) | drive.kept())
        yield from drive.what_is_left()
        counts.transforms_dropped += poses.rejected - rejected


def _static_transforms(
    recordings: Sequence[Recorded], counts: ScanCounts, earlier: State | None
) -> StaticTransforms:
    found = []
    for recording in recordings:
        transforms, bad = read_static_transforms(recording)
        found.append(transforms)
        counts.transforms_dropped += bad
    return StaticTransforms.of(found, None if earlier is None else without_prefix("static", earlier))


def _poses(
    selection: Selection, static: StaticTransforms, group: Sequence[int], earlier: State | None
) -> PoseSource:
    """The poses of a drive so far: the static transforms, and what an earlier replay kept of it."""
    poses = PoseSource(selection.map_frame, selection.pose, selection.covariances)
    for batch in static.of_drive(group, goes_on=earlier is not None):
        poses.add(batch)
    if earlier is not None:
        poses.restore(without_prefix("poses", earlier))
    return poses
