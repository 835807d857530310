"""A 2-D laser scanner on a moving robot: beams one after the other, noise, missing returns."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sample_logs.rays import Floats
from sample_logs.robot import Motion
from sample_logs.world import World


@dataclass(frozen=True, slots=True)
class Mount:
    """Where the laser sits on the robot: metres, yaw in degrees; upside down means rolled by 180 degrees."""

    x: float
    y: float
    z: float
    yaw_deg: float
    upside_down: bool = False

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """x, y, z, w of base_from_laser: the roll first, then the yaw."""
        half = np.deg2rad(self.yaw_deg) / 2
        if self.upside_down:
            return float(np.cos(half)), float(np.sin(half)), 0.0, 0.0
        return 0.0, 0.0, float(np.sin(half)), float(np.cos(half))


@dataclass(frozen=True, slots=True)
class Scanner:
    """One scanner: angles in degrees, lengths in metres, times in seconds."""

    first_deg: float
    step_deg: float
    beams: int
    period: float
    sweep_time: float
    range_min: float
    range_max: float
    mount: Mount
    noise: float = 0.01
    missing: float = 0.02
    resolution: float = 0.001
    no_return: float = np.inf

    @property
    def time_increment(self) -> float:
        """Time from beam to beam [s]."""
        return self.sweep_time / self.beams

    @property
    def bearings(self) -> Floats:
        """(beams,) [rad] in the laser frame."""
        return np.deg2rad(self.first_deg + self.step_deg * np.arange(self.beams, dtype=np.float64))

    def scan(
        self, world: World, motion: Motion, starts: Floats, rng: np.random.Generator
    ) -> npt.NDArray[np.float32]:
        """Ranges (n, beams) [m] as a driver gives them, of sweeps begun at `starts` (n,) [s]."""
        times = starts[:, None] + np.arange(self.beams) * self.time_increment
        origins, bearings = self.rays(motion.at(times))
        true = world.ranges(starts, origins, bearings, self.range_max)
        return self.measured(true, rng)

    def rays(self, poses: Floats) -> tuple[Floats, Floats]:
        """Origins (n, beams, 2) and bearings (n, beams) in the map, from the robot's poses (n, beams, 3)."""
        cos, sin = np.cos(poses[..., 2]), np.sin(poses[..., 2])
        x = poses[..., 0] + cos * self.mount.x - sin * self.mount.y
        y = poses[..., 1] + sin * self.mount.x + cos * self.mount.y
        side = -1.0 if self.mount.upside_down else 1.0
        return np.stack([x, y], axis=-1), poses[..., 2] + np.deg2rad(
            self.mount.yaw_deg
        ) + side * self.bearings

    def measured(self, true: Floats, rng: np.random.Generator) -> npt.NDArray[np.float32]:
        """What the scanner reports for true distances: noise, rounding, returns that are missing."""
        noisy = true + self.noise * rng.standard_normal(true.shape, dtype=np.float32)
        lost = rng.random(true.shape, dtype=np.float32) < self.missing
        rounded = np.round(noisy / self.resolution) * self.resolution
        in_range = np.isfinite(true) & (rounded >= self.range_min) & (rounded <= self.range_max) & ~lost
        return np.where(in_range, rounded, self.no_return).astype(np.float32)
