"""A drive through a world: the scans and transforms a robot's computer records on the way."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sample_logs.laser import Scanner
from sample_logs.rays import Floats
from sample_logs.recorder import (
    TF,
    TF_STATIC,
    Event,
    ScanEvent,
    Transform,
    TransformEvent,
    in_log_order,
    planar,
)
from sample_logs.robot import Motion, compose, drifting_odometry, invert, localisation_errors
from sample_logs.world import World

_SCANS_PER_BLOCK = 64
_WHEEL_BASE, _WHEEL_RADIUS = 0.42, 0.08


@dataclass(frozen=True, slots=True)
class Rates:
    """How often each transform is sent [1/s], 0 for never, and how far amcl stamps `ahead` [s]."""

    odometry: float
    localisation: float
    wheels: float = 0.0
    ahead: float = 0.0


@dataclass(frozen=True, slots=True)
class Drive:
    """One recording: from `start_ns`, along `motion`, with what went wrong decided by `seed`."""

    world: World
    motion: Motion
    scanner: Scanner
    rates: Rates
    start_ns: int
    seed: int
    laser_frame: str = "laser"
    error_m: float = 0.012
    error_rad: float = 0.003
    map_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)  # [m, m, rad] by which all poses are wrong

    def events(self) -> Iterator[Event]:
        """All messages in log order."""
        static = TransformEvent(self.start_ns, TF_STATIC, [self._mount()])
        streams = [iter([static]), self._scans(), self._odometry(), self._localisation()]
        if self.rates.wheels:
            streams.append(self._wheels())
        return in_log_order(*streams)

    def _random(self, stream: int) -> np.random.Generator:
        return np.random.Generator(np.random.PCG64([self.seed, stream]))

    def _ns(self, seconds: float) -> int:
        return self.start_ns + round(seconds * 1e9)

    def _mount(self) -> Transform:
        mount = self.scanner.mount
        place = (mount.x, mount.y, mount.z)
        return Transform(self.start_ns, "base_link", self.laser_frame, place, mount.quaternion)

    def _times(self, rate: float, rng: np.random.Generator, jitter: float) -> Floats:
        times = np.arange(0.0, self.motion.duration, 1 / rate)
        return times + rng.uniform(0, jitter, len(times))

    def _scans(self) -> Iterator[Event]:
        rng = self._random(0)
        starts = self._times(1 / self.scanner.period, rng, 0.001) + 0.3
        starts = starts[starts < self.motion.duration - 0.3]
        for first in range(0, len(starts), _SCANS_PER_BLOCK):
            block = starts[first : first + _SCANS_PER_BLOCK]
            ranges = self.scanner.scan(self.world, self.motion, block, rng)
            for start, row in zip(block.tolist(), ranges, strict=True):
                received = self._ns(start + self.scanner.sweep_time + 0.004)
                yield ScanEvent(received, self._ns(start), self.laser_frame, self.scanner, row)

    def _odometry(self) -> Iterator[Event]:
        times, poses = self._counted()
        for time, pose in zip(times.tolist(), poses, strict=True):
            transform = planar(self._ns(time), "odom", "base_link", pose)
            yield TransformEvent(self._ns(time + 0.002), TF, [transform])

    def _counted(self) -> tuple[Floats, Floats]:
        rng = self._random(1)
        times = self._times(self.rates.odometry, rng, 0.0005)
        return times, drifting_odometry(self.motion, times, rng)

    def _localisation(self) -> Iterator[Event]:
        rng = self._random(2)
        times = self._times(self.rates.localisation, rng, 0.002)
        true = self.motion.at(times)
        believed = compose(true, localisation_errors(true, rng, self.error_m, self.error_rad))
        believed = compose(np.array(self.map_offset), believed)
        counted_times, counted = self._counted()
        map_from_odom = compose(believed, invert(Motion(counted_times, counted).at(times)))
        for time, pose in zip(times.tolist(), map_from_odom, strict=True):
            transform = planar(self._ns(time + self.rates.ahead), "map", "odom", pose)
            yield TransformEvent(self._ns(time + 0.03), TF, [transform])

    def _wheels(self) -> Iterator[Event]:
        times = self._times(self.rates.wheels, self._random(3), 0.001)
        way = self.motion.at(times)
        moved = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way[:, :2], axis=0).T))])
        for time, distance, yaw in zip(times.tolist(), moved.tolist(), way[:, 2].tolist(), strict=True):
            sides = (("left", _WHEEL_BASE / 2, -yaw), ("right", -_WHEEL_BASE / 2, yaw))
            transforms = [
                self._wheel(time, name, offset, (distance + turned * _WHEEL_BASE / 2) / _WHEEL_RADIUS)
                for name, offset, turned in sides
            ]
            yield TransformEvent(self._ns(time + 0.003), TF, transforms)

    def _wheel(self, time: float, side: str, offset: float, angle: float) -> Transform:
        spin = (0.0, float(np.sin(angle / 2)), 0.0, float(np.cos(angle / 2)))
        place = (0.0, offset, _WHEEL_RADIUS)
        return Transform(self._ns(time), "base_link", f"{side}_wheel", place, spin)
