"""Mistakes that a driver, a calibration or a recorder makes, as changes of the messages of a recording."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.mutations.rewriting import Change

_SECOND_NS = 10**9


def laser_turned(degrees: float) -> Change:
    """The laser is told to be turned so far against what it is, about its own axis."""
    sine, cosine = np.sin(np.deg2rad(degrees) / 2), np.cos(np.deg2rad(degrees) / 2)

    def turned(transform: Any) -> Any:
        q = transform.rotation
        rotation = replace(
            q,
            x=q.x * cosine + q.y * sine,
            y=q.y * cosine - q.x * sine,
            z=q.z * cosine + q.w * sine,
            w=q.w * cosine - q.z * sine,
        )
        return replace(transform, rotation=rotation)

    return _of_laser(turned)


def laser_shifted(x: float, y: float) -> Change:
    """The laser is told to sit so far [m] from where it is, in the axes of the robot."""

    def shifted(transform: Any) -> Any:
        place = transform.translation
        return replace(transform, translation=replace(place, x=place.x + x, y=place.y + y))

    return _of_laser(shifted)


def minute_missing(from_s: float) -> Change:
    """Nothing was recorded for a minute."""

    def change(message: Any, since_ns: int) -> Any:
        return None if from_s <= since_ns / _SECOND_NS < from_s + 60 else message

    return change


def scans_stamped_late(seconds: float) -> Change:
    """The scans' stamps are late by so much; those of the transforms are right."""

    def late(scan: Any, _: int) -> Any:
        stamp = scan.header.stamp
        ns = stamp.sec * _SECOND_NS + stamp.nanosec + round(seconds * _SECOND_NS)
        second, rest = divmod(ns, _SECOND_NS)
        return replace(scan, header=replace(scan.header, stamp=replace(stamp, sec=second, nanosec=rest)))

    return _of_scans(late)


def every_scan_missing(nth: int) -> Change:
    """Every so many-th scan was not recorded."""

    def thinned(scan: Any, number: int) -> Any:
        return None if number % nth == nth - 1 else scan

    return _of_scans(thinned)


def missing_returns_as(code: float) -> Change:
    """The driver writes this number [m] for a missing return."""

    def coded(scan: Any, _: int) -> Any:
        missing = ~(scan.ranges < min(scan.range_max, 81.0))  # 81.83 m is a code of some scanners
        return replace(scan, ranges=np.where(missing, np.float32(code), scan.ranges).astype(np.float32))

    return _of_scans(coded)


def noise(metres: float, seed: int) -> Change:
    """Ranges with so much noise (one sigma) on top of what they have."""
    random = np.random.Generator(np.random.PCG64(seed))

    def noisy(scan: Any, _: int) -> Any:
        added = random.normal(0, metres, len(scan.ranges))
        hit = scan.ranges < min(scan.range_max, 81.0)
        return replace(scan, ranges=np.where(hit, scan.ranges + added, scan.ranges).astype(np.float32))

    return _of_scans(noisy)


def _of_scans(change: Callable[[Any, int], Any]) -> Change:
    """A change of scans alone; it is told the number of each, from 0."""
    numbers = iter(range(10**9))

    def changed(message: Any, _: int) -> Any:
        return change(message, next(numbers)) if hasattr(message, "ranges") else message

    return changed


def _of_laser(change: Callable[[Any], Any]) -> Change:
    """A change of the transform from the robot to the laser."""

    def changed(message: Any, _: int) -> Any:
        if not hasattr(message, "transforms"):
            return message
        transforms = [
            replace(one, transform=change(one.transform)) if one.child_frame_id.strip("/") == "laser" else one
            for one in message.transforms
        ]
        return replace(message, transforms=transforms)

    return changed


def mistakes(minute_from_s: float) -> Mapping[str, Change]:
    """All of them by name."""
    return {
        "laser yaw off by 1 deg": laser_turned(1.0),
        "laser 5 cm further ahead": laser_shifted(0.05, 0.0),
        "laser 5 cm further left": laser_shifted(0.0, 0.05),
        "a minute missing": minute_missing(minute_from_s),
        "scans stamped 100 ms late": scans_stamped_late(0.1),
        "scans stamped 100 ms early": scans_stamped_late(-0.1),
        "every tenth scan missing": every_scan_missing(10),
        "missing returns written as 0": missing_returns_as(0.0),
        "missing returns written as 9.5 m": missing_returns_as(9.5),
    }
