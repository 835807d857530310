"""Decoding of many messages of one layout at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.batches import (
    BadBatch,
    Batch,
    BeamLayout,
    Float32s,
    Int64s,
    PoseBatch,
    ScanBatch,
    TransformBatch,
)
from timemap_cli.logs.message_types import MESSAGE_TYPES, Kind
from timemap_cli.logs.raw import RawMessages
from timemap_cli.logs.tracing import Element, Trace

# Why a message gives nothing: its bytes are not what its type asks for, or what it says cannot be used.
UNDECODABLE, MALFORMED, MISMATCHED = "undecodable", "malformed", "mismatched"
MOST_BEAMS = 100_000  # of a scan; the finest scanners have some ten thousand
MOST_ANGLE = 4 * np.pi  # [rad] for the first bearing, and for what a scan spans: degrees are no radians
SPARE_BEAMS, SPARE_SHARE = 2, 0.05  # by which the beams may differ from what the angles say
SECOND_NS = 1_000_000_000
NO_STAMP_NS = -SECOND_NS  # stands for a stamp that is none
POSE_BYTES = 7 * 8
COVARIANCE_BYTES = 36 * 8
SCAN_NUMBERS = 7  # angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max
LAYOUT_NUMBERS = [0, 2, 5]  # angle_min, angle_increment, range_min


def decode_block(messages: RawMessages, trace: Trace) -> Iterator[Batch]:
    """Batches of messages that all have this layout."""
    return _READERS[MESSAGE_TYPES[messages.connection.msgtype].kind](messages, trace)


def _scans(messages: RawMessages, trace: Trace) -> Iterator[Batch]:
    """Scans, divided where the beams lie differently; those without usable beams are counted as malformed."""
    (element,) = trace.elements
    topic, count = messages.connection.topic, element.lengths["ranges"]
    numbers = messages.columns(element.offsets["angle_min"], 4 * SCAN_NUMBERS).view("<f4")
    keys = np.ascontiguousarray(numbers[:, LAYOUT_NUMBERS]).view("<u4")
    for key, alike in _same_rows(keys):
        angle_min, angle_increment, range_min = key.view("<f4").tolist()
        layout = BeamLayout(angle_min, angle_increment, count, range_min)
        if not has_beams(layout):
            yield BadBatch(topic, MALFORMED, len(alike))
            continue
        fits = fits_angles(layout, numbers[alike, 1])
        if not fits.all():
            yield BadBatch(topic, MISMATCHED, int(np.count_nonzero(~fits)))
            if not fits.any():
                continue
        chosen = alike[fits]
        part = messages[chosen]
        yield ScanBatch(
            topic=topic,
            frame_id=frame_name(element.texts["header.frame_id"]),
            layout=layout,
            stamps_ns=_stamps(part, element),
            log_ns=part.log_ns,
            ranges=part.columns(element.offsets["ranges"], 4 * count).view("<f4"),
            range_max=numbers[chosen, 6],
            time_increment=numbers[chosen, 3],
        )


def _transforms(messages: RawMessages, trace: Trace) -> Iterator[Batch]:
    for element in trace.elements:
        numbers = messages.columns(element.offsets["transform.translation.x"], POSE_BYTES).view("<f8")
        yield TransformBatch(
            parent=frame_name(element.texts["header.frame_id"]),
            child=frame_name(element.texts["child_frame_id"]),
            static=is_static(messages.connection.topic),
            stamps_ns=_stamps(messages, element),
            log_ns=messages.log_ns,
            translation=numbers[:, :3],
            rotation=numbers[:, 3:],
        )


def _poses(messages: RawMessages, trace: Trace) -> Iterator[Batch]:
    (element,) = trace.elements
    has_covariance = "pose.covariance" in element.offsets
    numbers = messages.columns(
        element.offsets["pose.pose.position.x" if has_covariance else "pose.position.x"], POSE_BYTES
    ).view("<f8")
    child = element.texts.get("child_frame_id")
    covariance = None
    if has_covariance:
        covariance = messages.columns(element.offsets["pose.covariance"], COVARIANCE_BYTES).view("<f8")
    yield PoseBatch(
        topic=messages.connection.topic,
        frame_id=frame_name(element.texts["header.frame_id"]),
        child_frame_id=None if child is None else frame_name(child),
        stamps_ns=_stamps(messages, element),
        log_ns=messages.log_ns,
        translation=numbers[:, :3],
        rotation=numbers[:, 3:],
        covariance=None if covariance is None else covariance.reshape(-1, 6, 6),
    )


_READERS: dict[Kind, Callable[[RawMessages, Trace], Iterator[Batch]]] = {
    Kind.SCAN: _scans,
    Kind.TRANSFORMS: _transforms,
    Kind.POSE: _poses,
}


def _stamps(messages: RawMessages, element: Element) -> Int64s:
    """Header stamps (n,) [ns]; where nanoseconds are a second or more, one before all times."""
    words = messages.columns(element.offsets["header.stamp.sec"], 8)
    seconds = words[:, :4].view("<i4")[:, 0].astype(np.int64)
    nanoseconds = words[:, 4:].view("<u4")[:, 0].astype(np.int64)
    return np.where(nanoseconds < SECOND_NS, seconds * SECOND_NS + nanoseconds, NO_STAMP_NS)


def _same_rows(rows: NDArray[np.uint32]) -> Iterator[tuple[NDArray[np.uint32], NDArray[np.int64]]]:
    """Each different row and the indices (ascending) where it stands, in order of first appearance."""
    if (rows == rows[0]).all():
        yield rows[0], np.arange(len(rows))
        return
    unique, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    for index in np.argsort(first):
        yield unique[index], np.flatnonzero(inverse.reshape(-1) == index)


def has_beams(layout: BeamLayout) -> bool:
    """Whether there are beams, not more than a scanner has, and it is known where they look."""
    span = abs(layout.angle_increment) * (layout.count - 1)
    return 0 < layout.count <= MOST_BEAMS and abs(layout.angle_min) <= MOST_ANGLE and span <= MOST_ANGLE


def fits_angles(layout: BeamLayout, angle_max: Float32s) -> NDArray[np.bool_]:
    """Whether there are as many beams as the angles ask for, by each ``angle_max`` (n,); drivers are off by one or two.

    An ``angle_max`` that was never set, or lies on the other side, says nothing.
    """
    with np.errstate(all="ignore"):
        span = angle_max.astype(np.float64) - layout.angle_min
        wanted = span / layout.angle_increment + 1
        says_something = np.isfinite(wanted) & (span * layout.angle_increment > 0)
        fits = np.abs(wanted - layout.count) <= max(SPARE_BEAMS, SPARE_SHARE * layout.count)
    result: NDArray[np.bool_] = fits | ~says_something
    return result


def frame_name(recorded: str) -> str:
    """A frame's name without the leading slash of old ROS."""
    return recorded.lstrip("/")


def is_static(topic: str) -> bool:
    """Whether transforms on this topic hold for all times."""
    return topic.rsplit("/", 1)[-1] == "tf_static"
