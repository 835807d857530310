"""Decoding of messages one by one with rosbags, for what is not laid out as usual."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from timemap_cli.logs.batches import BadBatch, Batch, BeamLayout, PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.block_decoding import (
    MALFORMED,
    MISMATCHED,
    NO_STAMP_NS,
    SECOND_NS,
    UNDECODABLE,
    fits_angles,
    frame_name,
    has_beams,
    is_static,
)
from timemap_cli.logs.message_types import MESSAGE_TYPES, Kind
from timemap_cli.logs.raw import RawMessages


def decode_singly(messages: RawMessages, deserialise: Callable[[bytes], Any]) -> list[Batch]:
    """Batches of one message each; what cannot be deserialised or read is counted as undecodable."""
    read = _READERS[MESSAGE_TYPES[messages.connection.msgtype].kind]
    batches: list[Batch] = []
    n_bad = 0
    for index in range(len(messages)):
        try:
            message = deserialise(messages.message(index))
            batches += read(message, messages.connection.topic, int(messages.log_ns[index]))
        except Exception:  # noqa: BLE001 - damaged bytes make generated decoders fail in any way there is
            n_bad += 1
    if n_bad:
        batches.append(BadBatch(messages.connection.topic, UNDECODABLE, n_bad))
    return batches


def _scans(message: Any, topic: str, log_ns: int) -> Iterator[Batch]:
    ranges = np.array(message.ranges, np.float32)[None]
    numbers = np.array([message.angle_min, message.angle_increment, message.range_min], np.float32)
    layout = BeamLayout(float(numbers[0]), float(numbers[1]), ranges.shape[1], float(numbers[2]))
    if not has_beams(layout):
        yield BadBatch(topic, MALFORMED, 1)
        return
    if not fits_angles(layout, np.array([message.angle_max], np.float32)).all():
        yield BadBatch(topic, MISMATCHED, 1)
        return
    yield ScanBatch(
        topic=topic,
        frame_id=frame_name(message.header.frame_id),
        layout=layout,
        stamps_ns=_stamp(message.header),
        log_ns=np.array([log_ns], np.int64),
        ranges=ranges,
        range_max=np.array([message.range_max], np.float32),
        time_increment=np.array([message.time_increment], np.float32),
    )


def _transforms(message: Any, topic: str, log_ns: int) -> Iterator[Batch]:
    for stamped in message.transforms:
        yield TransformBatch(
            parent=frame_name(stamped.header.frame_id),
            child=frame_name(stamped.child_frame_id),
            static=is_static(topic),
            stamps_ns=_stamp(stamped.header),
            log_ns=np.array([log_ns], np.int64),
            translation=_row(stamped.transform.translation, "xyz"),
            rotation=_row(stamped.transform.rotation, "xyzw"),
        )


def _poses(message: Any, topic: str, log_ns: int) -> Iterator[Batch]:
    covariance = getattr(message.pose, "covariance", None)
    pose = message.pose if covariance is None else message.pose.pose
    child = getattr(message, "child_frame_id", None)
    yield PoseBatch(
        topic=topic,
        frame_id=frame_name(message.header.frame_id),
        child_frame_id=None if child is None else frame_name(child),
        stamps_ns=_stamp(message.header),
        log_ns=np.array([log_ns], np.int64),
        translation=_row(pose.position, "xyz"),
        rotation=_row(pose.orientation, "xyzw"),
        covariance=None if covariance is None else np.array(covariance, np.float64).reshape(1, 6, 6),
    )


_READERS: dict[Kind, Callable[[Any, str, int], Iterator[Batch]]] = {
    Kind.SCAN: _scans,
    Kind.TRANSFORMS: _transforms,
    Kind.POSE: _poses,
}


def _stamp(header: Any) -> np.ndarray[Any, np.dtype[np.int64]]:
    is_stamp = header.stamp.nanosec < SECOND_NS
    return np.array(
        [header.stamp.sec * SECOND_NS + header.stamp.nanosec if is_stamp else NO_STAMP_NS], np.int64
    )


def _row(vector: Any, names: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array([[getattr(vector, name) for name in names]], np.float64)
