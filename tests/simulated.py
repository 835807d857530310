"""Recordings of a robot that drives through the sample building: exact poses, ranges without noise.

Whatever two of them differ in is what a test made different.
"""

from collections.abc import Iterable

import numpy as np

from sample_logs.building import building
from sample_logs.laser import Mount, Scanner
from sample_logs.robot import compose, drive, invert
from tests.logs.recorded import ROS2, START_NS, Message, odometry, pose_with_covariance, scan, transforms

WORLD = building(0.0, ())
MOTION = drive([(1.2, 4.1), (3, 4.1), (3, 1.8), (4.6, 2.2), (3, 1.8), (3, 4.1), (6, 4.1)], 0.6, 1.0)
NODES = "1.2 4.1\n2.1 4.1\n3 4.1\n3 3\n3 2\n3.9 2\n4.6 2.2\n4 4.1\n5 4.1\n6 4.1\n"  # along the way
PERIOD, SWEEP = 0.1, 0.075  # [s] of scans, and from first to last beam
STILL = (0.0, 0.0, 0.0, 1.0)


MOUNT = Mount(0.1, 0.0, 0.2, 0.0)


def scanner(mount=MOUNT, first_deg=-180.0, step_deg=1.0, beams=360, **more):
    """One that measures exactly, to the millimetre, out to 12 m."""
    plain = {"period": PERIOD, "sweep_time": SWEEP, "range_min": 0.05, "range_max": 12.0}
    exact = {"noise": 0.0, "missing": 0.0}
    return Scanner(first_deg, step_deg, beams, mount=mount, **(plain | exact | more))


def stamp(seconds):
    return START_NS + round(seconds * 1e9)


def times(period, begin=0.0):
    return np.arange(begin, MOTION.duration, period)


def scans(made: Scanner, topic="/scan", frame="laser", begin=0.5, world=WORLD) -> Iterable[Message]:
    """Scans from a time [s] on, one every period."""
    starts = times(PERIOD, begin)
    starts = starts[starts < MOTION.duration - 0.6]
    ranges = made.scan(world, MOTION, starts, np.random.default_rng(0))
    first, step = np.deg2rad(made.first_deg), np.deg2rad(made.step_deg)
    shape = {"angle_min": first, "angle_increment": step, "angle_max": first + step * (made.beams - 1)}
    limits = {"range_min": made.range_min, "range_max": made.range_max, "time_increment": made.time_increment}
    for at, row in zip(starts.tolist(), ranges, strict=True):
        yield Message(topic, stamp(at + 0.08), scan(ROS2, stamp(at), row, frame, **shape, **limits))


def static(*scanners) -> Message:
    """The mounts of (scanner, frame)."""
    edges = [
        (START_NS, "base_link", frame, (one.mount.x, one.mount.y, one.mount.z, *one.mount.quaternion))
        for one, frame in scanners
    ]
    return Message("/tf_static", START_NS, transforms(ROS2, *edges))


def numbers(pose):
    """x, y, z and the quaternion of a planar pose (3,)."""
    return (
        float(pose[0]),
        float(pose[1]),
        0.0,
        0.0,
        0.0,
        float(np.sin(pose[2] / 2)),
        float(np.cos(pose[2] / 2)),
    )


def moving(period=0.05, begin=0.0, parent="map") -> Iterable[Message]:
    """Exact transforms of the robot."""
    for at in times(period, begin).tolist():
        edge = stamp(at), parent, "base_link", numbers(MOTION.at(np.array(at)))
        yield Message("/tf", stamp(at + 0.01), transforms(ROS2, edge))


def localised(period=0.1, begin=0.0, drift=(0.3, -0.2, 0.05)) -> Iterable[Message]:
    """The same as odometry every 0.05 s that drifts evenly by so much [m, m, rad], and its correction."""

    def map_from_odom(at):
        return np.array(drift) * at / MOTION.duration

    for at in times(0.05).tolist():
        odom_from_base = compose(invert(map_from_odom(at)), MOTION.at(np.array(at)))
        edge = stamp(at), "odom", "base_link", numbers(odom_from_base)
        yield Message("/tf", stamp(at + 0.01), transforms(ROS2, edge))
    for at in times(period, begin).tolist():
        edge = stamp(at), "map", "odom", numbers(map_from_odom(at))
        yield Message("/tf", stamp(at + 0.02), transforms(ROS2, edge))


def amcl(period=0.25, std=0.05) -> Iterable[Message]:
    """Poses with a covariance, no transforms."""
    covariance = np.diag([std**2, std**2, 0, 0, 0, std**2]).ravel()
    for at in times(period).tolist():
        content = pose_with_covariance(ROS2, stamp(at), numbers(MOTION.at(np.array(at))), covariance)
        yield Message("/amcl_pose", stamp(at + 0.03), content)


def odometry_topic(period=0.05, frame="odom") -> Iterable[Message]:
    """Odometry messages, no transforms."""
    for at in times(period).tolist():
        content = odometry(ROS2, stamp(at), numbers(MOTION.at(np.array(at))), np.zeros(36), frame)
        yield Message("/odom", stamp(at + 0.01), content)


def in_order(*parts) -> list[Message]:
    """All messages in log order."""
    return sorted((one for part in parts for one in part), key=lambda one: one.log_ns)
