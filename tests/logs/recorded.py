"""Recordings written by rosbags and by the mcap library, for the tests of reading."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as BagWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Rosbag2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from timemap_cli.logs.batches import BadBatch, Batch, PoseBatch, ScanBatch, TransformBatch

ROS1 = get_typestore(Stores.ROS1_NOETIC)
ROS2 = get_typestore(Stores.ROS2_HUMBLE)
for _name in ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"):  # rosbags' store has them for ROS 2 alone
    ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", _name))
START_NS = 1_700_000_000_000_000_000


@dataclass(frozen=True)
class Message:
    topic: str
    log_ns: int
    content: Any

    @property
    def msgtype(self) -> str:
        return self.content.__msgtype__


def make(store, msgtype: str, **values: Any) -> Any:
    return store.types[msgtype](**values)


def header(store, stamp_ns: int, frame: str) -> Any:
    stamp = make(store, "builtin_interfaces/msg/Time", sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    seq = {"seq": 7} if store is ROS1 else {}
    return make(store, "std_msgs/msg/Header", stamp=stamp, frame_id=frame, **seq)


def scan(store, stamp_ns: int, ranges: Sequence[float], frame: str = "laser", **values: Any) -> Any:
    given = {
        "angle_min": -1.0,
        "angle_increment": 0.5,
        "time_increment": 0.001,
        "scan_time": 0.1,
        "range_min": 0.1,
        "range_max": 30.0,
        "intensities": np.zeros(0, np.float32),
    } | values
    given.setdefault("angle_max", given["angle_min"] + given["angle_increment"] * (len(ranges) - 1))
    return make(
        store,
        "sensor_msgs/msg/LaserScan",
        header=header(store, stamp_ns, frame),
        ranges=np.array(ranges, np.float32),
        **given,
    )


def vector(store, values: Sequence[float], kind: str = "Vector3") -> Any:
    names = "xyzw"[: len(values)]
    return make(store, f"geometry_msgs/msg/{kind}", **dict(zip(names, map(float, values), strict=True)))


def transforms(store, *edges: tuple[int, str, str, Sequence[float]], msgtype="tf2_msgs/msg/TFMessage") -> Any:
    stamped = [
        make(
            store,
            "geometry_msgs/msg/TransformStamped",
            header=header(store, stamp_ns, parent),
            child_frame_id=child,
            transform=make(
                store,
                "geometry_msgs/msg/Transform",
                translation=vector(store, numbers[:3]),
                rotation=vector(store, numbers[3:], "Quaternion"),
            ),
        )
        for stamp_ns, parent, child, numbers in edges
    ]
    return make(store, msgtype, transforms=stamped)


def pose(store, numbers: Sequence[float]) -> Any:
    return make(
        store,
        "geometry_msgs/msg/Pose",
        position=vector(store, numbers[:3], "Point"),
        orientation=vector(store, numbers[3:], "Quaternion"),
    )


def pose_stamped(store, stamp_ns: int, numbers: Sequence[float], frame: str = "map") -> Any:
    return make(
        store,
        "geometry_msgs/msg/PoseStamped",
        header=header(store, stamp_ns, frame),
        pose=pose(store, numbers),
    )


def with_covariance(store, numbers: Sequence[float], covariance: Sequence[float]) -> Any:
    covariance = np.array(covariance, np.float64)
    return make(
        store, "geometry_msgs/msg/PoseWithCovariance", pose=pose(store, numbers), covariance=covariance
    )


def pose_with_covariance(store, stamp_ns, numbers, covariance, frame: str = "map") -> Any:
    return make(
        store,
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        header=header(store, stamp_ns, frame),
        pose=with_covariance(store, numbers, covariance),
    )


def odometry(store, stamp_ns, numbers, covariance, frame: str = "odom", child: str = "base_link") -> Any:
    zero = vector(store, (0, 0, 0))
    twist = make(store, "geometry_msgs/msg/Twist", linear=zero, angular=zero)
    return make(
        store,
        "nav_msgs/msg/Odometry",
        header=header(store, stamp_ns, frame),
        child_frame_id=child,
        pose=with_covariance(store, numbers, covariance),
        twist=make(store, "geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)),
    )


def drive(store, n_scans: int = 20) -> list[Message]:
    """A short recording of everything that is read; scan i has ranges i, i+1, ... and stamps 5 ms before logging."""
    found = [
        Message("/tf_static", START_NS, transforms(store, (START_NS, "base", "laser", (0, 0, 1, 0, 0, 0, 1))))
    ]
    for i in range(n_scans):
        log_ns = START_NS + i * 100_000_000
        stamp_ns = log_ns - 5_000_000
        numbers = (i, 0.5 * i, 0, 0, 0, 0, 1)
        edges = [(stamp_ns, "map", "odom", (9, 9, 9, 0, 0, 1, 0)), (stamp_ns, "odom", "base", numbers)]
        found += [
            Message("/tf", log_ns + 1, transforms(store, *(edges if i % 3 == 0 else edges[1:]))),
            Message(
                "/scan", log_ns + 2, scan(store, stamp_ns, [i + k for k in range(5)], time_increment=i * 1e-4)
            ),
            Message("/pose", log_ns + 3, pose_stamped(store, stamp_ns, numbers)),
            Message("/amcl_pose", log_ns + 4, pose_with_covariance(store, stamp_ns, numbers, range(36))),
            Message("/odom", log_ns + 5, odometry(store, stamp_ns, numbers, range(36))),
        ]
    return found


TOPICS = ("/tf_static", "/tf", "/scan", "/pose", "/amcl_pose", "/odom")


def write_bag(
    path: Path, messages: Sequence[Message], compression: str = "none", chunk_bytes=1 << 20
) -> Path:
    writer = BagWriter(path)
    writer.chunk_threshold = chunk_bytes
    if compression != "none":
        writer.set_compression(BagWriter.CompressionFormat[compression.upper()])
    with writer:
        connections = {}
        for one in messages:
            if one.topic not in connections:
                connections[one.topic] = writer.add_connection(one.topic, one.msgtype, typestore=ROS1)
            raw = ROS1.serialize_ros1(one.content, one.msgtype)
            writer.write(connections[one.topic], one.log_ns, bytes(raw))
    return path


def write_rosbag2(path: Path, messages: Sequence[Message], plugin: StoragePlugin, mode: str = "none") -> Path:
    writer = Rosbag2Writer(path, version=9, storage_plugin=plugin)
    if mode != "none":
        writer.set_compression(CompressionMode[mode.upper()], CompressionFormat.ZSTD)
    with writer:
        connections = {}
        for one in messages:
            if one.topic not in connections:
                connections[one.topic] = writer.add_connection(one.topic, one.msgtype, typestore=ROS2)
            raw = ROS2.serialize_cdr(one.content, one.msgtype, little_endian=True)
            writer.write(connections[one.topic], one.log_ns, bytes(raw))
    return path


def write_mcap(path: Path, messages: Sequence[Message], profile: str = "ros2", **options: Any) -> Path:
    """A plain MCAP; ``options`` are those of the mcap library's writer.

    ``metadata`` names a metadata record; of the messages in ``short`` only the first half is written.
    """
    store = ROS1 if profile == "ros1" else ROS2
    metadata, short = options.pop("metadata", None), options.pop("short", ())
    writer = McapWriter(str(path), **({"chunk_size": 4096} | options))
    writer.start(profile=profile, library="tests")
    channels: dict[str, int] = {}
    for one in messages:
        if one.topic not in channels:
            text, _ = store.generate_msgdef(one.msgtype, ros_version=1 if profile == "ros1" else 2)
            name = one.msgtype.replace("/msg/", "/") if profile == "ros1" else one.msgtype
            schema = writer.register_schema(
                name, "ros1msg" if profile == "ros1" else "ros2msg", text.encode()
            )
            encoding = "ros1" if profile == "ros1" else "cdr"
            channels[one.topic] = writer.register_channel(one.topic, encoding, schema)
        raw = serialised(store, one.content)
        raw = raw[: len(raw) // 2] if any(one is other for other in short) else raw
        writer.add_message(channels[one.topic], one.log_ns, raw, one.log_ns)
    if metadata:
        writer.add_metadata(metadata, {})
    writer.finish()
    return path


def serialised(store, content: Any, *, little_endian: bool = True) -> bytes:
    if store is ROS1:
        return bytes(ROS1.serialize_ros1(content, content.__msgtype__))
    return bytes(ROS2.serialize_cdr(content, content.__msgtype__, little_endian=little_endian))


def rows(batches: Sequence[Batch]) -> dict[Any, list[Any]]:
    """Every message's content in plain Python, by what it belongs to, in log-time order."""
    found = defaultdict(list)
    for batch in batches:
        if isinstance(batch, BadBatch):
            found["bad", batch.topic, batch.reason].append(batch.count)
            continue
        times = zip(batch.log_ns.tolist(), batch.stamps_ns.tolist(), strict=True)
        if isinstance(batch, ScanBatch):
            layout = batch.layout
            key: Any = ("scan", batch.topic, batch.frame_id)
            beams = (layout.angle_min, layout.angle_increment, layout.count, layout.range_min)
            columns = zip(batch.range_max, batch.time_increment, batch.ranges, strict=True)
            content = [(*beams, *_numbers(*row)) for row in columns]
        elif isinstance(batch, TransformBatch):
            key = ("transform", batch.static, batch.parent, batch.child)
            content = [_numbers(*both) for both in zip(batch.translation, batch.rotation, strict=True)]
        else:
            assert isinstance(batch, PoseBatch)
            key = ("pose", batch.topic, batch.frame_id, batch.child_frame_id)
            covariance = (
                batch.covariance if batch.covariance is not None else [np.zeros(0)] * len(batch.log_ns)
            )
            content = [
                _numbers(*all_of)
                for all_of in zip(batch.translation, batch.rotation, covariance, strict=True)
            ]
        found[key] += [(*time, *row) for time, row in zip(times, content, strict=True)]
        found[key].sort(key=lambda row: row[0])
    return dict(found)


def _numbers(*arrays: Any) -> tuple[bytes, ...]:
    """Bytes, so that NaN equals NaN."""
    return tuple(np.asarray(values, np.float64).tobytes() for values in arrays)


def expected_rows(messages: Sequence[tuple[str, int, Any]]) -> dict[Any, list[Any]]:
    """What ``rows`` should find in (topic, log time, rosbags' object) of messages, taken from the objects' fields."""
    found = defaultdict(list)
    for topic, log_ns, one in messages:
        name = one.__msgtype__
        if name in ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"):
            for edge in one.transforms:
                frames = edge.header.frame_id.lstrip("/"), edge.child_frame_id.lstrip("/")
                t, r = edge.transform.translation, edge.transform.rotation
                content = _numbers((t.x, t.y, t.z), (r.x, r.y, r.z, r.w))
                key = "transform", topic.endswith("tf_static"), *frames
                found[key].append((log_ns, _stamp(edge.header), *content))
            continue
        frame, stamp = one.header.frame_id.lstrip("/"), _stamp(one.header)
        if name == "sensor_msgs/msg/LaserScan":
            beams = *_single(one.angle_min, one.angle_increment), len(one.ranges), *_single(one.range_min)
            content = _numbers(*_single(one.range_max, one.time_increment), one.ranges)
            found["scan", topic, frame].append((log_ns, stamp, *beams, *content))
            continue
        child = one.child_frame_id.lstrip("/") if name == "nav_msgs/msg/Odometry" else None
        bare = name == "geometry_msgs/msg/PoseStamped"
        p = one.pose if bare else one.pose.pose
        q = p.orientation
        content = _numbers(
            (p.position.x, p.position.y, p.position.z),
            (q.x, q.y, q.z, q.w),
            () if bare else one.pose.covariance,
        )
        found["pose", topic, frame, child].append((log_ns, stamp, *content))
    return dict(found)


def _single(*values: float) -> list[float]:
    return np.array(values, np.float32).tolist()


def _stamp(head: Any) -> int:
    return head.stamp.sec * 10**9 + head.stamp.nanosec


def drive_rows(store, n_scans: int = 20) -> dict[Any, list[Any]]:
    return expected_rows([(one.topic, one.log_ns, one.content) for one in drive(store, n_scans)])


__all__ = ["CompressionType", "IndexType", "StoragePlugin"]
