"""Batches written out by hand, for the tests of what is made of them."""

from dataclasses import dataclass, field

import numpy as np

from timemap_cli.logs.batches import BadBatch, BeamLayout, PoseBatch, ScanBatch, TransformBatch

SECOND = 1_000_000_000


def ns(seconds):
    return np.rint(np.atleast_1d(np.asarray(seconds, float)) * SECOND).astype(np.int64)


def yaw(degrees):
    """Quaternions (n, 4) of turns to the left."""
    half = np.radians(np.atleast_1d(np.asarray(degrees, float))) / 2
    return np.stack([0 * half, 0 * half, np.sin(half), np.cos(half)], axis=1)


def tf(parent, child, seconds, xyz, rotation=None, *, static=False, log=None):
    stamps = ns(seconds)
    translation = np.broadcast_to(np.asarray(xyz, float), (len(stamps), 3))
    rotation = np.broadcast_to(yaw(0) if rotation is None else np.asarray(rotation, float), (len(stamps), 4))
    return TransformBatch(
        parent, child, static, stamps, stamps if log is None else ns(log), translation, rotation
    )


def poses(topic, frame, seconds, xyz, rotation=None, *, child=None):
    made = tf(frame, "x", seconds, xyz, rotation)
    return PoseBatch(topic, frame, child, made.stamps_ns, made.log_ns, made.translation, made.rotation, None)


def scans(seconds, *, topic="/scan", frame="laser", log=None, count=3, increment=0.0, first=None):
    """Scans whose first beam tells them apart: its range is ``first``, else the stamp in seconds."""
    stamps = ns(seconds)
    ranges = np.full((len(stamps), count), 2.0, np.float32)
    ranges[:, :1] = np.reshape(stamps / SECOND if first is None else first, (-1, 1))
    logged = stamps if log is None else ns(log)
    layout = BeamLayout(-0.5, 0.25, count, 0.1)
    full = np.full(len(stamps), 30.0, np.float32)
    steps = np.full(len(stamps), increment, np.float32)
    return ScanBatch(topic, frame, layout, stamps, logged, ranges, full, steps)


@dataclass
class Topic:
    name: str
    msgtype: str


@dataclass
class FakeRecording:
    """Batches that come in the lists they were put in; each list covers the next stretch of log time."""

    lists: list = field(default_factory=list)

    def _times(self):
        held = [b.log_ns for some in self.lists for b in some if not isinstance(b, BadBatch)]
        return np.concatenate(held) if held else np.zeros(1, np.int64)

    @property
    def start_ns(self):
        return int(self._times().min())

    @property
    def end_ns(self):
        return int(self._times().max())

    @property
    def topics(self):
        return tuple(
            Topic(name, kind) for name, kind in dict.fromkeys(self._named(b) for s in self.lists for b in s)
        )

    def _named(self, batch):
        if isinstance(batch, TransformBatch):
            return ("/tf_static" if batch.static else "/tf"), "tf2_msgs/msg/TFMessage"
        if isinstance(batch, PoseBatch):
            return batch.topic, "geometry_msgs/msg/PoseStamped"
        return batch.topic, "sensor_msgs/msg/LaserScan"

    def batches(self, topics):
        for some in self.lists:
            chosen = [batch for batch in some if self._named(batch)[0] in topics]
            if chosen:
                yield chosen
