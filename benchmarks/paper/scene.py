"""The simulated world of the experiments: a robot that turns about on a node, its laser 0.2 m off its centre.

Distances are rounded to whole millimetres, as scanners do, so that a last bit of a sine decides nothing.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from sample_logs.rays import Floats, cast
from sample_logs.robot import compose
from sample_logs.world import disc, outline_segments
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.model.virtual_scan import Ranges, virtual_scans

ANGLE_BINS = 360
RADIUS = 10.0  # [m] how far a node looks
PERIOD_NS = 200_000_000  # from scan to scan

ROUND_ROOM = outline_segments(disc(0.0, 0.0, 1.5, corners=90))  # 3 m across, round

_RAYS_PER_BIN = 9


@dataclass(frozen=True, slots=True)
class Scanner:
    """A laser of 360 degrees on a robot; lengths in metres."""

    beams: int = 720
    off_centre: float = 0.2
    noise: float = 0.01
    reach: float = 30.0  # what is farther returns nothing
    field_deg: float = 360.0  # the middle of it looks ahead

    @property
    def bearings(self) -> Floats:
        """(beams,) [rad] in the laser frame."""
        step = np.deg2rad(self.field_deg) / self.beams
        return np.asarray((np.arange(self.beams) - (self.beams - 1) / 2) * step)


LASER = Scanner()


@dataclass(frozen=True, slots=True)
class Scans:
    """Scans of one node before they become virtual ones: ranges and poses as the robot has them."""

    ranges: npt.NDArray[np.float32]  # (n, beams) [m]; +inf nothing returned, NaN no evidence
    ends: Floats  # (n, beams) [rad] true bearing of each beam's end as seen from the node
    poses: Floats  # (n, 3) robot's pose in the map as it believes it: x, y [m], yaw [rad]
    scanner: Scanner

    def virtual(self) -> Ranges:
        """What the node learns of them (n, ANGLE_BINS) [mm]; every scan must be able to judge the node."""
        centres, ways_free = np.zeros((len(self.ranges), 2)), np.ones(len(self.ranges), np.bool_)
        ranges, judged = virtual_scans(self.sweeps(), centres, ways_free, ANGLE_BINS, RADIUS)
        if not judged.all():
            raise ValueError(f"{int((~judged).sum())} of {len(judged)} simulated scans do not see their node")
        return ranges

    def sweeps(self, first: int = 0) -> Sweeps:
        """The scans as the model takes them in, the first at a time of so many periods."""
        laser = laser_poses(self.poses, self.scanner)
        cos, sin = np.cos(laser[:, 2]), np.sin(laser[:, 2])
        map_from_laser = np.zeros((len(laser), 3, 4))
        map_from_laser[:, 0, 0], map_from_laser[:, 0, 1], map_from_laser[:, 0, 3] = cos, -sin, laser[:, 0]
        map_from_laser[:, 1, 0], map_from_laser[:, 1, 1], map_from_laser[:, 1, 3] = sin, cos, laser[:, 1]
        map_from_laser[:, 2, 2] = 1.0
        stamps = (first + np.arange(len(laser), dtype=np.int64)) * PERIOD_NS
        bearings = self.scanner.bearings
        return Sweeps(stamps, self.ranges, bearings, self.scanner.reach, map_from_laser, map_from_laser)

    def hiding(self, hidden: npt.NDArray[np.bool_]) -> "Scans":
        """The same without evidence where beams end in hidden angle bins, (ANGLE_BINS,) or (n, ANGLE_BINS)."""
        bins = (self.ends * (ANGLE_BINS / (2 * np.pi))).astype(np.int64) % ANGLE_BINS
        gone = np.take_along_axis(np.broadcast_to(hidden, (len(bins), ANGLE_BINS)), bins, axis=1)
        return Scans(np.where(gone, np.float32(np.nan), self.ranges), self.ends, self.poses, self.scanner)

    def misplaced(self, wrong: npt.NDArray[np.bool_], error: tuple[float, float, float]) -> "Scans":
        """The same, but where `wrong` (n,) the robot believes itself off by an error: x, y [m], yaw [rad]."""
        turned = self.poses + np.where(wrong[:, None], error, 0.0)
        return Scans(self.ranges, self.ends, turned, self.scanner)


def laser_poses(poses: Floats, scanner: Scanner) -> Floats:
    """Poses (n, 3) of the laser from those of the robot."""
    return np.asarray(compose(poses, np.array([scanner.off_centre, 0.0, 0.0])))


def poses(n: int, random: np.random.Generator, wander: float = 0.03) -> Floats:
    """Where a robot stands that turns about on the node: (n, 3), its centre within `wander` [m, one sigma]."""
    return np.column_stack((random.normal(0, wander, (n, 2)), random.uniform(-np.pi, np.pi, n)))


def look(
    segments: Floats, n: int, random: np.random.Generator, scanner: Scanner = LASER, at: Floats | None = None
) -> Scans:
    """N scans of a still world of segments (m, 4); `at` gives the poses (n, 3), else it turns about."""
    places = poses(n, random) if at is None else at
    laser = laser_poses(places, scanner)
    bearings = laser[:, 2:] + scanner.bearings
    origins = np.broadcast_to(laser[:, None, :2], (*bearings.shape, 2))
    true = np.round(cast(segments, np.ascontiguousarray(origins), bearings, scanner.reach)[0], 6)
    return measured(true, laser, places, random, scanner)


def measured(
    true: Floats, laser: Floats, places: Floats, random: np.random.Generator, scanner: Scanner = LASER
) -> Scans:
    """Scans from true distances (n, beams) [m, inf for none] along the beams of a laser at poses (n, 3)."""
    bearings = laser[:, 2:] + scanner.bearings
    noisy = np.round(np.maximum(true + random.normal(0, scanner.noise, true.shape), 0.03), 3)
    length = np.where(np.isfinite(true), true, scanner.reach)
    x, y = laser[:, :1] + length * np.cos(bearings), laser[:, 1:2] + length * np.sin(bearings)
    ranges = np.where(np.isfinite(true), noisy, np.inf).astype(np.float32)
    return Scans(ranges, np.arctan2(y, x) % (2 * np.pi), places, scanner)


def truth(segments: Floats, node: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """What the node would see, without noise: (ANGLE_BINS,) [m] the nearest in each angle bin; inf clear."""
    nearest: Floats = rays(segments, node).min(axis=1)
    return nearest


def rays(segments: Floats, node: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """True distances (ANGLE_BINS, rays) [m] along rays spread over each angle bin; inf beyond the radius."""
    share = (np.arange(_RAYS_PER_BIN) + 0.5) / _RAYS_PER_BIN
    bearings = (np.arange(ANGLE_BINS)[:, None] + share).reshape(1, -1) * (2 * np.pi / ANGLE_BINS)
    origins = np.broadcast_to(np.array(node), (1, bearings.shape[1], 2))
    found = cast(segments, np.ascontiguousarray(origins), bearings, RADIUS)[0]
    return np.asarray(found.reshape(ANGLE_BINS, _RAYS_PER_BIN))
