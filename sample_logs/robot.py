"""How the robot moves: its true path, its odometry that drifts, its localisation that jumps a little."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sample_logs.rays import Floats

_STEP_S = 0.02
_SMOOTH_OVER = 21


@dataclass(frozen=True, slots=True)
class Motion:
    """Poses (k, 3) x [m], y [m], yaw [rad, unwrapped] at rising times (k,) [s]."""

    times: Floats
    poses: Floats

    def at(self, times: Floats) -> Floats:
        """Poses (..., 3) at `times`, interpolated; the first and last pose hold outside."""
        return np.stack([np.interp(times, self.times, self.poses[:, i]) for i in range(3)], axis=-1)

    @property
    def duration(self) -> float:
        """Length in time [s]."""
        return float(self.times[-1] - self.times[0])


def drive(
    route: Sequence[tuple[float, float]], speed: float, turn_rate: float, pause_s: float = 0.5
) -> Motion:
    """Follow a route from point to point [m/s], turning on the spot [rad/s], after a pause at time 0."""
    points = np.array(route, dtype=float)
    legs = np.diff(points, axis=0)
    headings = np.unwrap(np.arctan2(legs[:, 1], legs[:, 0]))
    times, poses = [0.0, pause_s], [(*points[0], headings[0])] * 2
    for i, (leg, heading) in enumerate(zip(legs, headings, strict=True)):
        turn = abs(heading - poses[-1][2])
        times += [times[-1] + turn / turn_rate, times[-1] + turn / turn_rate + float(np.hypot(*leg)) / speed]
        poses += [(*points[i], heading), (*points[i + 1], heading)]
    return _smoothed(np.array(times), np.array(poses))


def _smoothed(times: Floats, poses: Floats) -> Motion:
    """No robot starts, stops or turns at once: the path is averaged over 0.4 s."""
    even = np.arange(times[0], times[-1] + 0.5, _STEP_S)
    columns = [_moving_average(np.interp(even, times, poses[:, i])) for i in range(3)]
    return Motion(even, np.stack(columns, axis=1))


def _moving_average(values: Floats) -> Floats:
    """Averages (n,) over 21 values (n,), the first and the last held outside.

    Summed in one order, on every processor: np.convolve leaves it to a matrix library, and the last bits to that.
    Any order would do; this is the one in which the recordings beside this file were made.
    """
    padded = np.pad(values, _SMOOTH_OVER // 2, mode="edge")
    shares = np.lib.stride_tricks.sliding_window_view(padded, _SMOOTH_OVER).T * (1 / _SMOOTH_OVER)
    total: Floats = shares[:16].reshape(2, 2, 2, 2, -1)
    for axis in (2, 1, 0, 0):
        total = np.add(total.take(0, axis), total.take(1, axis))
    for share in shares[16:]:
        total = np.add(total, share)
    return total


def drifting_odometry(motion: Motion, times: Floats, rng: np.random.Generator) -> Floats:
    """Poses (n, 3) in the odom frame as wheels count them: a scale error, and a heading that walks away."""
    true = motion.at(times)
    moved = np.diff(true, axis=0)
    way = np.hypot(moved[:, 0], moved[:, 1])
    turn = moved[:, 2] * 1.006 + rng.normal(0.0, 1.0, len(way)) * 0.004 * np.sqrt(way)
    yaw = np.concatenate([[0.0], np.cumsum(turn)])
    middle = (yaw[1:] + yaw[:-1]) / 2
    steps = 1.008 * way[:, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    return np.column_stack([np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), yaw])


def localisation_errors(true: Floats, rng: np.random.Generator, metres: float, radians: float) -> Floats:
    """Errors (n, 3) of a particle filter along true poses (n, 3), renewed every 0.25 m or 0.2 rad."""
    errors = np.empty_like(true)
    scale = np.array([metres, metres, radians])
    error, at = rng.normal(size=3) * scale, true[0]
    for i, pose in enumerate(true):
        if np.hypot(pose[0] - at[0], pose[1] - at[1]) > 0.25 or abs(pose[2] - at[2]) > 0.2:
            error, at = 0.7 * error + np.sqrt(1 - 0.7**2) * rng.normal(size=3) * scale, pose
        errors[i] = error
    return errors


def compose(a: Floats, b: Floats) -> Floats:
    """Planar transforms (n, 3): a_from_c from a_from_b and b_from_c."""
    cos, sin = np.cos(a[..., 2]), np.sin(a[..., 2])
    x = a[..., 0] + cos * b[..., 0] - sin * b[..., 1]
    y = a[..., 1] + sin * b[..., 0] + cos * b[..., 1]
    return np.stack([x, y, a[..., 2] + b[..., 2]], axis=-1)


def invert(a: Floats) -> Floats:
    """Planar transforms (n, 3): b_from_a from a_from_b."""
    cos, sin = np.cos(a[..., 2]), np.sin(a[..., 2])
    x = -cos * a[..., 0] - sin * a[..., 1]
    y = sin * a[..., 0] - cos * a[..., 1]
    return np.stack([x, y, -a[..., 2]], axis=-1)
