"""The simulated robot's path, odometry and localisation."""

import os
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

from sample_logs.robot import compose, drifting_odometry, drive, invert, localisation_errors
from tests.conftest import ROOT

ROUTE = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0)]


def rng():
    return np.random.Generator(np.random.PCG64(5))


def test_the_robot_drives_leg_by_leg_and_turns_on_the_spot():
    motion = drive(ROUTE, speed=0.5, turn_rate=1.0, pause_s=1.0)
    corner = 1.0 + 3.0 / 0.5
    np.testing.assert_allclose(motion.at(np.array([4.0])), [[1.5, 0.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(motion.at(np.array([corner + np.pi / 4])), [[3.0, 0.0, np.pi / 4]], atol=1e-2)
    np.testing.assert_allclose(motion.poses[-1], [3.0, 2.0, np.pi / 2], atol=1e-9)
    assert motion.duration == pytest.approx(corner + np.pi / 2 + 2.0 / 0.5 + 0.5, abs=0.05)


def test_the_path_is_averaged_over_21_steps():
    motion = drive([(0.0, 0.0), (0.1, 0.0)], speed=0.5, turn_rate=1.0, pause_s=1.0)
    steps = np.arange(len(motion.times)) - np.arange(-10, 11)[:, None]
    held = np.clip(0.5 * (0.02 * steps - 1.0), 0.0, 0.1)  # [m] at a speed of 0.5 m/s after 1 s
    exact = [float(sum(map(Fraction, column)) / 21) for column in held.T]
    np.testing.assert_allclose(motion.poses[:, 0], exact, rtol=0, atol=1e-15)


@pytest.mark.parametrize("kernel", ["Haswell", "Prescott", "Zen"])
def test_the_path_is_the_same_whichever_kernel_a_matrix_library_chooses(kernel):
    program = (
        "import sys; from sample_logs.robot import drive;"
        f"sys.stdout.buffer.write(drive({ROUTE}, 0.45, 0.9).poses.tobytes())"
    )
    made = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"OPENBLAS_CORETYPE": kernel},
        cwd=ROOT,
        capture_output=True,
        check=True,
    )
    assert made.stdout == drive(ROUTE, 0.45, 0.9).poses.tobytes()


def test_the_robot_never_jumps():
    motion = drive(ROUTE, speed=0.5, turn_rate=1.0)
    steps = np.abs(np.diff(motion.poses, axis=0)) / np.diff(motion.times)[:, None]
    assert (steps.max(axis=0) <= [0.5 + 1e-6, 0.5 + 1e-6, 1.0 + 1e-6]).all()


def test_composing_with_the_inverse_gives_nothing():
    poses = rng().uniform(-3, 3, (50, 3))
    np.testing.assert_allclose(compose(poses, invert(poses)), 0.0, atol=1e-12)


def test_composing_turns_the_second_pose():
    np.testing.assert_allclose(
        compose(np.array([1.0, 2.0, np.pi / 2]), np.array([3.0, 0.5, 0.1])), [0.5, 5.0, np.pi / 2 + 0.1]
    )


def test_odometry_is_smooth_and_drifts():
    there_and_back = [(0.0, 0.0), (20.0, 0.0)] * 6
    motion = drive(there_and_back, speed=0.6, turn_rate=1.0)
    times = np.arange(0, motion.duration, 0.05)
    true, counted = motion.at(times), drifting_odometry(motion, times, rng())
    per_step = np.hypot(*np.diff(counted[:, :2], axis=0).T) - np.hypot(*np.diff(true[:, :2], axis=0).T)
    assert np.abs(per_step).max() < 0.001
    assert np.hypot(*(counted[-1, :2] - true[-1, :2])) > 0.3


def test_localisation_errors_are_held_and_have_the_stated_size():
    motion = drive([(0.0, 0.0), (300.0, 0.0)], speed=0.6, turn_rate=1.0)
    true = motion.at(np.arange(0, motion.duration, 0.1))
    errors = localisation_errors(true, rng(), 0.012, 0.003)
    np.testing.assert_allclose(errors.std(axis=0), [0.012, 0.012, 0.003], rtol=0.25)
    renewed = (np.diff(errors, axis=0) != 0).any(axis=1).sum()
    assert renewed == pytest.approx(300 / 0.3, rel=0.02)  # the first step of 0.06 m beyond 0.25 m
