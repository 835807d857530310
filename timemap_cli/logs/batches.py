"""What a recording yields once decoded: arrays over many messages of one kind, exactly as they were recorded."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Float32s = NDArray[np.float32]
Float64s = NDArray[np.float64]
Int64s = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class BeamLayout:
    """The bearings of one scanner's beams: beam i looks along ``angle_min + i * angle_increment``.

    Angles in rad, in the scan's own frame; ranges in m. The time from beam to beam is not part of it: many
    drivers measure it anew for every scan.
    """

    angle_min: float
    angle_increment: float
    count: int
    range_min: float


@dataclass(frozen=True, slots=True)
class ScanBatch:
    """Laser scans of one topic, frame and beam layout, in the order they were recorded.

    ``ranges`` are as recorded (inf, NaN and the driver's own codes included), and so is ``range_max``,
    which some drivers change with every scan. ``stamps_ns`` are the header's stamps (first beam),
    ``log_ns`` the times of recording.
    """

    topic: str
    frame_id: str
    layout: BeamLayout
    stamps_ns: Int64s  # (n,) [ns]
    log_ns: Int64s  # (n,) [ns]
    ranges: Float32s  # (n, layout.count) [m]
    range_max: Float32s  # (n,) [m]
    time_increment: Float32s  # (n,) [s] from one beam to the next

    def chosen(self, rows: slice | NDArray[np.bool_]) -> ScanBatch:
        """The chosen scans alone."""
        return replace(
            self,
            stamps_ns=self.stamps_ns[rows],
            log_ns=self.log_ns[rows],
            ranges=self.ranges[rows],
            range_max=self.range_max[rows],
            time_increment=self.time_increment[rows],
        )


@dataclass(frozen=True, slots=True)
class TransformBatch:
    """Transforms ``parent_from_child`` of one pair of frames, in the order they were recorded.

    Frame names have no leading slash. Rotations are quaternions (x, y, z, w) as recorded: neither checked
    nor normalised.
    """

    parent: str
    child: str
    static: bool
    stamps_ns: Int64s  # (n,) [ns]
    log_ns: Int64s  # (n,) [ns]
    translation: Float64s  # (n, 3) [m]
    rotation: Float64s  # (n, 4) xyzw


@dataclass(frozen=True, slots=True)
class PoseBatch:
    """Poses of one topic in the frame ``frame_id``, in the order they were recorded.

    ``child_frame_id`` is what the pose is of, where the message says so (Odometry). Rotations are
    quaternions (x, y, z, w) as recorded. ``covariance`` is over (x, y, z, roll, pitch, yaw), where the
    message has one.
    """

    topic: str
    frame_id: str
    child_frame_id: str | None
    stamps_ns: Int64s  # (n,) [ns]
    log_ns: Int64s  # (n,) [ns]
    translation: Float64s  # (n, 3) [m]
    rotation: Float64s  # (n, 4) xyzw
    covariance: Float64s | None  # (n, 6, 6) [m^2, m rad, rad^2]


@dataclass(frozen=True, slots=True)
class BadBatch:
    """Messages of one topic that could not be decoded, counted."""

    topic: str
    reason: str
    count: int


Batch = ScanBatch | TransformBatch | PoseBatch | BadBatch
