"""The undamaged recordings that the zoo's animals are made of, and what an animal is."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from tests.logs.recorded import ROS1, ROS2, START_NS, Message, scan, transforms, write_bag, write_mcap

SCANS = 60
PERIOD_NS = 100_000_000
BEARINGS = np.linspace(-2.4, 2.4, 61)
STILL = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Animal:
    """A bad or odd input.

    ``make`` writes it into a folder; ``good_tool`` is one sentence on what a good tool does with it. ``code`` is the
    exit code of a replay, ``said`` a pattern that its output holds, ``used`` the scans that are used of 60 (None where
    there is no result), ``dropped`` the others by reason.
    """

    name: str
    make: Callable[[Path], Path]
    good_tool: str
    code: int
    said: str = ""
    used: int | range | None = None
    dropped: dict[str, int] = field(default_factory=dict)


def room(bearings: np.ndarray) -> np.ndarray:
    """Ranges (n,) from the middle of a square room of 4 m to its walls."""
    return 2.0 / np.maximum(np.abs(np.cos(bearings)), np.abs(np.sin(bearings)))


def drive(
    store: Any,
    of_scan: Callable[[int], dict[str, Any]] = lambda _: {},
    of_pose: Callable[[int], dict[str, Any]] = lambda _: {},
    mount: tuple[float, ...] = (0.0, 0.0, 0.0, *STILL),
) -> list[Message]:
    """Six seconds of a robot that stands in the room; what is odd is said for each scan and pose by its number.

    Of a scan: "stamp_ns", "ranges", "frame", and the message's own fields. Of a pose: "numbers", "stamp_ns",
    "frame", "child".
    """
    found = [Message("/tf_static", START_NS, transforms(store, (START_NS, "base_link", "laser", mount)))]
    plain = {"angle_min": float(BEARINGS[0]), "angle_increment": 0.08}
    for i in range(-1, SCANS + 1):
        now = START_NS + (i + 2) * PERIOD_NS
        pose = {"stamp_ns": now, "frame": "map", "child": "base_link", "numbers": (0.0, 0.0, 0.0, *STILL)} | (
            of_pose(i)
        )
        edge = pose["stamp_ns"], pose["frame"], pose["child"], pose["numbers"]
        found.append(Message("/tf", now, transforms(store, edge)))
        if 0 <= i < SCANS:
            values = plain | of_scan(i)
            stamp_ns, ranges = values.pop("stamp_ns", now), values.pop("ranges", room(BEARINGS))
            frame = values.pop("frame", "laser")
            found.append(Message("/scan", now + 1, scan(store, stamp_ns, ranges, frame, **values)))
    return found


def mcap(folder: Path, messages: list[Message] | None = None, **options: Any) -> Path:
    """The drive as an MCAP of a dozen chunks."""
    path = folder / "run.mcap"
    if messages is not None:
        return write_mcap(path, messages, **options)
    return _once(path, repr(options), lambda: write_mcap(path, drive(ROS2), **options))


def bag(folder: Path, compression: str = "none", messages: list[Message] | None = None) -> Path:
    """The drive as a ROS 1 bag of a few chunks."""
    path = folder / "run.bag"
    if messages is not None:
        return write_bag(path, messages, compression, chunk_bytes=4000)
    return _once(path, compression, lambda: write_bag(path, drive(ROS1), compression, chunk_bytes=4000))


_written: dict[str, bytes] = {}


def _once(path: Path, key: str, write: Callable[[], Path]) -> Path:
    """Write the undamaged recording; most animals begin with it, and its bytes are made only once."""
    if key not in _written:
        _written[key] = write().read_bytes()
    else:
        path.write_bytes(_written[key])
    return path


def changed(path: Path, change: Callable[[bytearray], bytes | bytearray | None]) -> Path:
    """The file with a change in its bytes: made in place, or returned."""
    content = bytearray(path.read_bytes())
    path.write_bytes(change(content) or content)
    return path


def cut(path: Path, share: float) -> Path:
    """The file up to a share of its length."""
    return changed(path, lambda content: content[: int(len(content) * share)])


def overwritten(path: Path, at: int, new: bytes) -> Path:
    """The file with some of its bytes replaced."""

    def change(content: bytearray) -> None:
        content[at : at + len(new)] = new

    return changed(path, change)


def uint32(value: int) -> bytes:
    """As recordings have it."""
    return struct.pack("<I", value)


def uint64(value: int) -> bytes:
    """As recordings have it."""
    return struct.pack("<Q", value)
