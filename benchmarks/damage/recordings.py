"""Small undamaged recordings of one short drive, in every format that is read."""

import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import StoragePlugin

from sample_logs.laser import Mount, Scanner
from sample_logs.recorder import (
    TF,
    TF_STATIC,
    Event,
    ScanEvent,
    TransformEvent,
    planar,
    write_ros1_bag,
    write_ros2_folder,
)

SCANS = 60
PERIOD_NS = 100_000_000
START_NS = 1_700_000_000_000_000_000
SCANNER = Scanner(-120.0, 6.0, 41, 0.1, 0.05, 0.1, 12.0, Mount(0.1, 0.0, 0.2, 0.0))
ROOM = (3.0, 2.0)  # [m] half its length and width
CHUNK_BYTES = 4096  # a dozen chunks in each recording

Floats = np.ndarray[Any, np.dtype[np.float64]]


def drive() -> Iterator[Event]:
    """Scans of a robot that drives through an empty room for six seconds, and the transforms it needs."""
    yield TransformEvent(
        START_NS, TF_STATIC, [planar(START_NS, "base_link", "laser", np.array((0.1, 0.0, 0.0)))]
    )
    for number in range(-1, SCANS + 1):
        stamp_ns = START_NS + (number + 2) * PERIOD_NS
        pose = np.array((0.02 * number - 0.6, 0.1 * np.sin(0.1 * number), 0.02 * number))
        chain = [
            planar(stamp_ns, "map", "odom", np.zeros(3)),
            planar(stamp_ns, "odom", "base_link", pose),
        ]
        yield TransformEvent(stamp_ns, TF, chain)
        if 0 <= number < SCANS:
            yield ScanEvent(stamp_ns + 1_000_000, stamp_ns, "laser", SCANNER, _ranges(pose))


def _ranges(pose: Floats) -> np.ndarray[Any, np.dtype[np.float32]]:
    """Distances (beams,) [m] from a pose (x, y, yaw) of the robot to the walls of the room."""
    x, y, yaw = pose[0] + 0.1 * np.cos(pose[2]), pose[1] + 0.1 * np.sin(pose[2]), pose[2]
    bearings = SCANNER.bearings + yaw
    with np.errstate(divide="ignore"):
        to_x = (np.copysign(ROOM[0], np.cos(bearings)) - x) / np.cos(bearings)
        to_y = (np.copysign(ROOM[1], np.sin(bearings)) - y) / np.sin(bearings)
    ranges: np.ndarray[Any, np.dtype[np.float32]] = np.minimum(to_x, to_y).astype(np.float32)
    return ranges


def _bag(path: Path, compression: str) -> Path:
    write_ros1_bag(path.with_suffix(".bag"), drive(), compression, CHUNK_BYTES)
    return path.with_suffix(".bag")


def _folder(path: Path, storage: StoragePlugin) -> Path:
    write_ros2_folder(path, drive(), storage)
    return path


def _lone_database(path: Path) -> Path:
    folder = _folder(path.with_name("folder"), StoragePlugin.SQLITE3)
    (database,) = folder.glob("*.db3")
    database.rename(path.with_suffix(".db3"))
    shutil.rmtree(folder)
    return path.with_suffix(".db3")


def _mcap(path: Path, **options: Any) -> Path:
    """A lone MCAP; ``options`` are those of the mcap library's writer."""
    folder = _folder(path.with_name("folder"), StoragePlugin.MCAP)
    (file,) = folder.glob("*.mcap")
    _rewrite(file, path.with_suffix(".mcap"), **options)
    shutil.rmtree(folder)
    return path.with_suffix(".mcap")


def _mcap_folder(path: Path) -> Path:
    """A folder with an MCAP in several chunks and the metadata that belongs to it."""
    folder = _folder(path, StoragePlugin.MCAP)
    (file,) = folder.glob("*.mcap")
    rewritten = file.with_suffix(".new")
    _rewrite(file, rewritten, compression=CompressionType.ZSTD)
    rewritten.replace(file)
    return folder


def _rewrite(source: Path, target: Path, **options: Any) -> None:
    with source.open("rb") as read, target.open("wb") as written:
        writer = McapWriter(written, **({"chunk_size": CHUNK_BYTES} | options))
        writer.start(profile="ros2", library="benchmarks")
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(read).iter_messages():
            if channel.id not in channels:
                assert schema is not None
                schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, schema_id, channel.metadata
                )
            writer.add_message(
                channels[channel.id], message.log_time, message.data, message.publish_time, message.sequence
            )
        writer.finish()  # type: ignore[no-untyped-call]


_NO_SUMMARY: dict[str, Any] = {
    "index_types": IndexType.NONE,
    "use_statistics": False,
    "repeat_channels": False,
    "repeat_schemas": False,
    "use_summary_offsets": False,
}
FORMATS: dict[str, Callable[[Path], Path]] = {
    "bag": partial(_bag, compression="none"),
    "bag bz2": partial(_bag, compression="bz2"),
    "bag lz4": partial(_bag, compression="lz4"),
    "sqlite3 folder": partial(_folder, storage=StoragePlugin.SQLITE3),
    "sqlite3 file": _lone_database,
    "mcap": partial(_mcap, compression=CompressionType.NONE),
    "mcap zstd": partial(_mcap, compression=CompressionType.ZSTD),
    "mcap lz4": partial(_mcap, compression=CompressionType.LZ4),
    "mcap without chunks": partial(_mcap, use_chunking=False),
    "mcap without chunks, data checksum": partial(_mcap, use_chunking=False, enable_data_crcs=True),
    "mcap without summary": partial(_mcap, compression=CompressionType.ZSTD, **_NO_SUMMARY),
    "mcap folder": _mcap_folder,
}
