"""Scans and transforms as messages, written as ROS 1 bag, ROS 2 folder or MCAP."""

import heapq
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from sample_logs.laser import Scanner
from sample_logs.rays import Floats

SCAN, TF, TF_STATIC = "/scan", "/tf", "/tf_static"
_TYPES = {
    SCAN: "sensor_msgs/msg/LaserScan",
    TF: "tf2_msgs/msg/TFMessage",
    TF_STATIC: "tf2_msgs/msg/TFMessage",
}


@dataclass(frozen=True, slots=True)
class Transform:
    """parent_from_child at a time: translation [m] and quaternion x, y, z, w."""

    stamp_ns: int
    parent: str
    child: str
    translation: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class TransformEvent:
    """One message on /tf or /tf_static, received at `log_ns`."""

    log_ns: int
    topic: str
    transforms: Sequence[Transform]


@dataclass(frozen=True, slots=True)
class ScanEvent:
    """One message on /scan, received at `log_ns`; ranges (beams,) [m]."""

    log_ns: int
    stamp_ns: int
    frame: str
    scanner: Scanner
    ranges: npt.NDArray[np.float32]


Event = TransformEvent | ScanEvent


def planar(stamp_ns: int, parent: str, child: str, pose: Floats) -> Transform:
    """Transform of a planar pose (3,): x [m], y [m], yaw [rad]."""
    half = float(pose[2]) / 2
    rotation = (0.0, 0.0, float(np.sin(half)), float(np.cos(half)))
    return Transform(stamp_ns, parent, child, (float(pose[0]), float(pose[1]), 0.0), rotation)


def in_log_order(*streams: Iterable[Event]) -> Iterator[Event]:
    """Merge streams that are each in log order."""
    return heapq.merge(*streams, key=attrgetter("log_ns"))


def write_ros1_bag(
    path: Path, events: Iterable[Event], compression: str = "bz2", chunk_bytes: int = 1 << 20
) -> None:
    """Write a ROS 1 bag whose chunks are compressed by "bz2", "lz4" or not at all ("none")."""
    messages = _Messages(Stores.ROS1_NOETIC)
    writer = Ros1Writer(path)
    writer.chunk_threshold = chunk_bytes
    if compression != "none":
        writer.set_compression(Ros1Writer.CompressionFormat[compression.upper()])
    with writer:
        latched = {TF_STATIC: 1}
        connections = {
            topic: writer.add_connection(
                topic,
                name,
                typestore=messages.store,
                latching=latched.get(topic),
                callerid=f"/{topic[1:]}_publisher",
            )
            for topic, name in _TYPES.items()
        }
        for event in events:
            topic, message = messages.build(event)
            raw = messages.store.serialize_ros1(message, _TYPES[topic])
            writer.write(connections[topic], event.log_ns, raw)


def write_ros2_folder(
    path: Path, events: Iterable[Event], storage: StoragePlugin, *, compressed: bool = False
) -> None:
    """Write a ROS 2 recording: a folder with metadata.yaml; `compressed` (MCAP) means zstd chunks."""
    messages = _Messages(Stores.ROS2_HUMBLE)
    writer = Ros2Writer(path, version=8, storage_plugin=storage)
    if compressed:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(
                topic, name, typestore=messages.store, offered_qos_profiles=_qos(topic == TF_STATIC)
            )
            for topic, name in _TYPES.items()
        }
        for event in events:
            topic, message = messages.build(event)
            raw = messages.store.serialize_cdr(message, _TYPES[topic])
            writer.write(connections[topic], event.log_ns, raw)


def _qos(latched: bool) -> list[Qos]:
    durability = QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE
    endless = QosTime(9223372036, 854775807)
    return [
        Qos(
            QosHistory.UNKNOWN, 0, QosReliability.RELIABLE, durability, endless, endless,
            QosLiveliness.AUTOMATIC, endless, False,
        )
    ]  # fmt: skip


class _Messages:
    """Builds the messages of one ROS generation."""

    def __init__(self, store: Stores) -> None:
        self.store = get_typestore(store)
        if _TYPES[TF] not in self.store.types:
            self.store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", _TYPES[TF]))
        self._sequence = {TF: 0, SCAN: 0} if store == Stores.ROS1_NOETIC else None
        types = self.store.types
        self._header, self._time = types["std_msgs/msg/Header"], types["builtin_interfaces/msg/Time"]
        self._scan, self._tf = types[_TYPES[SCAN]], types[_TYPES[TF]]
        self._stamped = types["geometry_msgs/msg/TransformStamped"]
        self._transform = types["geometry_msgs/msg/Transform"]
        self._vector, self._rotation = (
            types["geometry_msgs/msg/Vector3"],
            types["geometry_msgs/msg/Quaternion"],
        )

    def build(self, event: Event) -> tuple[str, Any]:
        """Topic and message of an event."""
        if isinstance(event, ScanEvent):
            return SCAN, self._scan_message(event)
        return event.topic, self._tf([self._stamped_transform(t) for t in event.transforms])

    def _head(self, stamp_ns: int, frame: str, counter: str) -> Any:
        stamp = self._time(*divmod(stamp_ns, 1_000_000_000))
        if self._sequence is None:
            return self._header(stamp, frame)
        self._sequence[counter] += 1
        return self._header(self._sequence[counter], stamp, frame)

    def _scan_message(self, event: ScanEvent) -> Any:
        scanner = event.scanner
        first, step = np.deg2rad(scanner.first_deg), np.deg2rad(scanner.step_deg)
        return self._scan(
            self._head(event.stamp_ns, event.frame, SCAN),
            float(first), float(first + step * (scanner.beams - 1)), float(step),
            scanner.time_increment, scanner.period, scanner.range_min, scanner.range_max,
            event.ranges, np.zeros(0, dtype=np.float32),
        )  # fmt: skip

    def _stamped_transform(self, t: Transform) -> Any:
        transform = self._transform(self._vector(*t.translation), self._rotation(*t.rotation))
        return self._stamped(self._head(t.stamp_ns, t.parent, TF), t.child, transform)
