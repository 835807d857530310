"""The layout in bytes of the two messages that a result holds by the thousand: a scan and its status.

With the number of angle bins and the length of the frame's name given, every field stands at a fixed place,
so a whole batch is one NumPy structured array: filled by column, and read back the same way.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from itertools import groupby

import numpy as np
import numpy.typing as npt

from timemap_cli.model.estimates import Estimate
from timemap_cli.results.bearings import scan_angles
from timemap_cli.results.cdr import ENCAPSULATION
from timemap_cli.results.frames import node_frame, node_of_frame

NS = 1_000_000_000
_Block = npt.NDArray[np.void]


@lru_cache(maxsize=64)
def scan_layout(angle_bins: int, frame_size: int) -> np.dtype[np.void]:
    """`sensor_msgs/LaserScan` for a frame name of `frame_size` bytes, its closing zero included."""
    return np.dtype(
        [
            *_header_layout(frame_size, align_to=4),
            ("geometry", "<f4", (7,)),
            ("ranges_count", "<u4"),
            ("ranges", "<f4", (angle_bins,)),
            ("intensities_count", "<u4"),
            ("intensities", "<f4", (angle_bins,)),
        ]
    )


@lru_cache(maxsize=64)
def status_layout(angle_bins: int, frame_size: int) -> np.dtype[np.void]:
    """`timemap_msgs/Status` for a frame name of `frame_size` bytes, its closing zero included."""
    return np.dtype(
        [
            *_header_layout(frame_size, align_to=4),
            ("samples_count", "<u4"),
            ("samples", "<u2", (angle_bins,)),
            ("samples_padding", f"V{-2 * angle_bins % 4}"),
            ("plausibility_count", "<u4"),
            ("plausibility", "<f4", (angle_bins,)),
            ("status_count", "<u4"),
            ("status", "u1", (angle_bins,)),
            ("status_padding", f"V{-angle_bins % 4}"),
            ("last_seen_count", "<u4"),
            ("last_seen", [("sec", "<i4"), ("nanosec", "<u4")], (angle_bins,)),
            ("known_count", "<u4"),
            ("known", "<f4", (angle_bins,)),
        ]
    )


def pack_scans(estimates: Sequence[Estimate], angle_bins: int, radius: np.float32) -> Iterator[bytes]:
    """One LaserScan per estimate, in order: clear +inf, unknown NaN, intensities the support.

    Raises ValueError where a finite range is not in 0..radius: viewers would not show it.
    """
    angle_min, angle_max, increment = scan_angles(angle_bins)

    def fill(block: _Block, rows: Sequence[Estimate]) -> None:
        block["geometry"] = (angle_min, angle_max, increment, 0, 0, 0, radius)
        block["ranges_count"] = block["intensities_count"] = angle_bins
        block["ranges"] = ranges = np.stack([e.ranges for e in rows])
        if np.any((ranges < 0) | ((ranges > radius) & (ranges < np.inf))):
            raise ValueError(f"a range is not in 0..{radius} m")
        block["intensities"] = [e.support for e in rows]

    return _pack(estimates, angle_bins, scan_layout, fill)


def pack_statuses(estimates: Sequence[Estimate], angle_bins: int) -> Iterator[bytes]:
    """One Status per estimate, in order."""

    def fill(block: _Block, rows: Sequence[Estimate]) -> None:
        for name in ("samples", "plausibility", "status", "last_seen", "known"):
            block[f"{name}_count"] = angle_bins
        block["samples"] = [e.samples for e in rows]
        block["plausibility"] = [e.plausibility for e in rows]
        block["status"] = [e.status for e in rows]
        last_seen = block["last_seen"]
        last_seen["sec"], last_seen["nanosec"] = np.divmod(np.stack([e.last_seen_ns for e in rows]), NS)
        block["known"] = [e.known for e in rows]

    return _pack(estimates, angle_bins, status_layout, fill)


def frame_of(message: bytes) -> str:
    """Frame of a message that begins with a header."""
    size = int.from_bytes(message[12:16], "little")
    return message[16 : 15 + size].decode()


def unpack_estimate(scan: bytes, status: bytes, level: str, angle_bins: int) -> Estimate:
    """The estimate that was written as these two messages, equal to the last bit.

    Raises ValueError if they are shorter than their type or were made for another number of angle bins.
    """
    frame = frame_of(scan)
    size = len(frame.encode()) + 1
    s = np.frombuffer(scan, scan_layout(angle_bins, size), count=1)[0]
    t = np.frombuffer(status, status_layout(angle_bins, size), count=1)[0]
    if not s["ranges_count"] == s["intensities_count"] == t["samples_count"] == angle_bins:
        raise ValueError(f"{frame}: not {angle_bins} angle bins")
    return Estimate(
        node=node_of_frame(frame),
        level=level,
        stamp_ns=int(s["sec"]) * NS + int(s["nanosec"]),
        ranges=s["ranges"].astype(np.float32),
        support=s["intensities"].astype(np.float32),
        known=t["known"].astype(np.float32),
        samples=t["samples"].astype(np.uint16),
        status=t["status"].astype(np.uint8),
        last_seen_ns=t["last_seen"]["sec"].astype(np.int64) * NS + t["last_seen"]["nanosec"],
    )


def _pack(
    estimates: Sequence[Estimate],
    angle_bins: int,
    layout: Callable[[int, int], np.dtype[np.void]],
    fill: Callable[[_Block, Sequence[Estimate]], None],
) -> Iterator[bytes]:
    frames = [node_frame(e.node).encode() + b"\x00" for e in estimates]
    for size, group in groupby(zip(frames, estimates, strict=True), key=lambda pair: len(pair[0])):
        names, rows = zip(*group, strict=True)
        dtype = layout(angle_bins, size)
        block = np.zeros(len(rows), dtype)
        block["encapsulation"] = np.void(ENCAPSULATION)
        block["sec"], block["nanosec"] = np.divmod(np.array([e.stamp_ns for e in rows], np.int64), NS)
        block["frame_size"] = size
        block["frame"] = np.frombuffer(b"".join(names), f"V{size}")
        fill(block, rows)
        raw = block.tobytes()
        for start in range(0, len(raw), dtype.itemsize):
            yield raw[start : start + dtype.itemsize]


def _header_layout(frame_size: int, align_to: int) -> list[tuple[str, str]]:
    return [
        ("encapsulation", f"V{len(ENCAPSULATION)}"),
        ("sec", "<i4"),
        ("nanosec", "<u4"),
        ("frame_size", "<u4"),
        ("frame", f"V{frame_size}"),
        ("frame_padding", f"V{-frame_size % align_to}"),
    ]
