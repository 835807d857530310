"""Recorded drives, and what their scans would be if the robot believed itself elsewhere."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from timemap_cli.config import Settings
from timemap_cli.logs.coming import ScanCounts
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.stream import sweeps
from timemap_cli.logs.survey import survey
from timemap_cli.model.sweeps import Sweeps

Floats = npt.NDArray[np.float64]
Wrong = Callable[[int, np.random.Generator], Floats]
"""By how much n poses in a row are wrong (n, 3): x, y [m, map frame] and yaw [rad]."""

Drive = list[Sweeps]


def recorded(log: Path, settings: Settings) -> Drive:
    """The scans of a recording, as a replay with these settings places them."""
    with ExitStack() as stack:
        recordings = [stack.enter_context(recording) for recording in open_recordings([log])]
        plan = survey(recordings, settings)
        found = sweeps(recordings, plan.selection, plan.beams, ScanCounts(), limits=plan.pose_limits)
        return [block for block in found if isinstance(block, Sweeps)]


def believed(drive: Drive, wrong: Wrong, seed: int, later_ns: int = 0) -> Drive:
    """A drive whose poses are wrong, so much later."""
    rng = np.random.default_rng(seed)
    errors = wrong(sum(map(len, drive)), rng)
    borders = np.cumsum([len(block) for block in drive])[:-1]
    return [
        replace(
            block,
            stamps_ns=block.stamps_ns + later_ns,
            map_from_laser_first=_moved(block.map_from_laser_first, error),
            map_from_laser_last=_moved(block.map_from_laser_last, error),
        )
        for block, error in zip(drive, np.split(errors, borders), strict=True)
    ]


def _moved(pose: Floats, error: Floats) -> Floats:
    """map_from_laser (n, 3, 4), shifted, and turned on the spot."""
    cos, sin = np.cos(error[:, 2, None]), np.sin(error[:, 2, None])
    moved = pose.copy()
    moved[:, 0, :3] = cos * pose[:, 0, :3] - sin * pose[:, 1, :3]
    moved[:, 1, :3] = sin * pose[:, 0, :3] + cos * pose[:, 1, :3]
    moved[:, :2, 3] += error[:, :2]
    return moved


def shaken(metres: float, degrees: float) -> Wrong:
    """Another error for each scan, of so many standard deviations."""
    size = np.array([metres, metres, np.radians(degrees)])
    return lambda n, rng: rng.normal(size=(n, 3)) * size


def shifted(metres: float, towards_deg: float, degrees: float = 0.0) -> Wrong:
    """The same shift and turn all the time, beside the trembling of a localiser that tracks."""
    towards = np.radians(towards_deg)
    offset = np.array([metres * np.cos(towards), metres * np.sin(towards), np.radians(degrees)])
    return added(shaken(*TRACKING), lambda n, _: np.broadcast_to(offset, (n, 3)))


def another_each(metres: float, degrees: float) -> Wrong:
    """A shift of this length in any direction, and a turn to either side, anew for each scan."""
    return lambda n, rng: _any_way(metres, degrees, rng.uniform(0, 2 * np.pi, n), rng.choice((-1, 1), n))


def straying(metres: float, degrees: float, scans: int = 50) -> Wrong:
    """A shift of this length whose direction, and a turn whose side, drift away within so many scans."""

    def wrong(n: int, rng: np.random.Generator) -> Floats:
        bearing = rng.uniform(0, 2 * np.pi) + np.cumsum(rng.normal(size=n)) * (np.pi / 2 / np.sqrt(scans))
        phase = rng.uniform(0, 2 * np.pi) + np.cumsum(rng.normal(size=n)) * (np.pi / 2 / np.sqrt(scans))
        return _any_way(metres, degrees, bearing, np.sin(phase))

    return wrong


def _any_way(metres: float, degrees: float, bearing: Floats, side: Floats) -> Floats:
    return np.stack((metres * np.cos(bearing), metres * np.sin(bearing), np.radians(degrees) * side), axis=1)


def added(one: Wrong, other: Wrong) -> Wrong:
    """Both errors together."""
    return lambda n, rng: one(n, rng) + other(n, rng)


TRACKING = 0.03, 0.5  # [m, degrees] how a localiser that tracks trembles


def in_turn(drives: Sequence[Drive], times: int) -> list[Drive]:
    """All drives, so many times."""
    return [drive for _ in range(times) for drive in drives]
