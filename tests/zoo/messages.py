"""Whole recordings of messages that say something wrong, and of those that are only unusual."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from tests.logs.recorded import ROS2, START_NS, Message, transforms, write_mcap
from tests.zoo.making import BEARINGS, PERIOD_NS, STILL, Animal, bag, drive, mcap, room

THREE = (20, 30, 40)  # scans, or poses
YEAR_NS = 365 * 86400 * 10**9


def _stamp(i: int) -> int:
    return START_NS + (i + 2) * PERIOD_NS


def _scans(of: Callable[[int], dict[str, Any]]) -> Callable[[Path], Path]:
    return lambda folder: mcap(folder, drive(ROS2, of))


def _three(**values: Any) -> Callable[[Path], Path]:
    """Three scans are so."""
    return _scans(lambda i: values if i in THREE else {})


def _all(**values: Any) -> Callable[[Path], Path]:
    return _scans(lambda _: values)


def _three_stamped(change: Callable[[int], int]) -> Callable[[Path], Path]:
    return _scans(lambda i: {"stamp_ns": change(_stamp(i))} if i in THREE else {})


def _poses(of: Callable[[int], dict[str, Any]], **values: Any) -> Callable[[Path], Path]:
    return lambda folder: mcap(folder, drive(ROS2, of_pose=of, **values))


def _three_poses(*numbers: float) -> Callable[[Path], Path]:
    return _poses(lambda i: {"numbers": numbers} if i in THREE else {})


def _with_edges(*edges: tuple[str, str, tuple[float, ...]]) -> Callable[[Path], Path]:
    """More transforms, sent with every pose."""

    def make(folder: Path) -> Path:
        messages = drive(ROS2)
        for i in range(-1, 61):
            given = [(_stamp(i), parent, child, numbers) for parent, child, numbers in edges]
            messages.append(Message("/tf", _stamp(i) + 2, transforms(ROS2, *given)))
        return mcap(folder, sorted(messages, key=lambda one: one.log_ns))

    return make


def _cut_short(folder: Path) -> Path:
    """Three scans and a message of transforms lack their second half."""
    messages = drive(ROS2)
    short = [one for one in messages if one.topic == "/scan"][10:13]
    short += [one for one in messages if one.topic == "/tf"][20:21]
    return write_mcap(folder / "run.mcap", messages, short=short)


def _bad_nanoseconds(folder: Path) -> Path:
    """The nanoseconds of three stamps are four thousand million."""
    messages = drive(ROS2)
    for one in [one for one in messages if one.topic == "/scan"][20:23]:
        one.content.header.stamp.nanosec = 4_000_000_000
    return mcap(folder, messages)


def _long_scan(folder: Path) -> Path:
    """A scan of ten million beams among the others."""
    beams = np.ones(10_000_000, np.float32)
    values = {"ranges": beams, "angle_increment": 4.8e-7}
    return mcap(folder, drive(ROS2, lambda i: values if i == 30 else {}))


def _clockwise(i: int) -> dict[str, Any]:
    return {"angle_min": 2.4, "angle_increment": -0.08}


NAN, INF = float("nan"), float("inf")
HALF_TURN = (1.0, 0.0, 0.0, 0.0)  # about the x axis: upside down
WHOLE = 60
THREE_MALFORMED = {"malformed": 3}
MESSAGES = (
    Animal("scans_with_twice_the_beams_that_their_angles_ask_for", _all(angle_min=-2.4, angle_max=0.0), "does not guess where the beams look", 2, "they are mismatched"),
    Animal("scans_some_of_which_have_other_beams_than_their_angles", _three(angle_max=0.0), "leaves those out and counts them", 0, "", 57, {"mismatched": 3}),
    Animal("scans_without_beams", _three(ranges=[]), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_an_increment_of_zero", _three(angle_increment=0.0, angle_max=0.0), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_an_increment_of_nan", _three(angle_increment=NAN), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_an_infinite_increment", _three(angle_increment=INF), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_an_angle_of_1e30", _three(angle_min=1e30), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_an_increment_of_1e30", _three(angle_increment=1e30), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_with_angles_in_degrees", _all(angle_min=-137.5, angle_increment=4.58), "does not take degrees for radians", 2, "they are malformed"),
    Animal("scans_with_an_angle_of_nan", _three(angle_min=NAN), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_all_with_an_increment_of_zero", _all(angle_increment=0.0, angle_max=0.0), "says why none can be used", 1, "malformed 60"),
    Animal("scans_with_a_time_increment_of_nan", _all(time_increment=NAN), "takes all beams at once", 0, "", WHOLE),
    Animal("scans_without_a_stamp", _three_stamped(lambda _: 0), "leaves those out and counts them", 0, "", 57, {"late": 3}),
    Animal("scans_stamped_before_1970", _three_stamped(lambda _: -5_000_000_000), "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_stamped_years_ahead", _three_stamped(lambda now: now + 10 * YEAR_NS), "leaves those out, counts them and reads the others", 0, "", 57, {"ahead": 3}),
    Animal("scans_with_too_many_nanoseconds", _bad_nanoseconds, "leaves those out and counts them", 0, "", 57, THREE_MALFORMED),
    Animal("scans_whose_stamps_step_back", _three_stamped(lambda now: now - 450_000_000), "puts them in order", 0, "", WHOLE),
    Animal("scans_with_equal_stamps", _three_stamped(lambda now: now - PERIOD_NS), "uses the first of two and counts the other", 0, "", 57, {"duplicate": 3}),
    Animal("messages_cut_short", _cut_short, "leaves those out and says that data is lost", 3, "3 messages of /scan are damaged", 57, {"undecodable": 3}),
    Animal("scans_of_ten_million_beams", _long_scan, "takes that for no scanner", 0, "", 59, {"malformed": 1}),
    Animal("scans_without_a_frame", _all(frame=""), "says that they name no frame", 2, "no frame"),
    Animal("scans_in_an_unknown_frame", _all(frame="lidar"), "names the frame and those there are", 2, "'lidar' is not connected"),
    Animal("scans_some_of_which_are_in_an_unknown_frame", _three(frame="lidar"), "leaves those out and counts them", 0, "", 57, {"no_pose": 3}),
    Animal("scans_without_any_range", _all(ranges=np.full(61, NAN)), "says that no scan could be used", 1, "node_not_seen 60"),
    Animal("scans_with_negative_and_huge_ranges", _all(ranges=[-1.0, 3e38, NAN, -INF, INF, 0.0, *room(BEARINGS[6:])]), "uses the other beams", 0, "", WHOLE),
    Animal("scans_with_a_range_min_of_nan", _all(range_min=NAN), "uses the beams", 0, "", WHOLE),
    Animal("transforms_in_a_loop", _poses(lambda i: {"frame": "laser", "child": "base_link"}), "says that there is no pose", 2, "is not connected to"),
    Animal("transforms_with_a_loop_beside", _with_edges(("a", "b", (0, 0, 0, *STILL)), ("b", "c", (0, 0, 0, *STILL)), ("c", "a", (0, 0, 0, *STILL))), "does not care", 0, "", WHOLE),
    Animal("transforms_of_a_frame_to_itself", _with_edges(("map", "map", (0, 0, 0, *STILL))), "leaves them out and says so", 0, "62 transforms or poses could not be used", WHOLE),
    Animal("transforms_without_names", _with_edges(("", "", (0, 0, 0, *STILL))), "leaves them out and says so", 0, "62 transforms or poses could not be used", WHOLE),
    Animal("transforms_with_a_rotation_of_zero", _three_poses(0, 0, 0, 0, 0, 0, 0), "leaves those out and says so", 0, "3 transforms or poses could not be used", WHOLE),
    Animal("transforms_all_with_a_rotation_of_zero", _poses(lambda _: {"numbers": (0,) * 7}), "says that there is no pose", 2, "no pose for /scan"),
    Animal("transforms_with_nan", _three_poses(NAN, 0, 0, *STILL), "leaves those out and says so", 0, "3 transforms or poses could not be used", WHOLE),
    Animal("transforms_with_infinity", _three_poses(0, INF, 0, *STILL), "leaves those out and says so", 0, "3 transforms or poses could not be used", WHOLE),
    Animal("transforms_off_the_earth", _three_poses(1e300, 0, 0, *STILL), "leaves those out and says so", 0, "3 transforms or poses could not be used", WHOLE),
    Animal("transforms_with_a_rotation_beyond_all_numbers", _three_poses(0, 0, 0, 0, 0, 1e200, 1), "leaves those out and says so", 0, "3 transforms or poses could not be used", WHOLE),
    Animal("transforms_stamped_years_ahead", _poses(lambda i: {"stamp_ns": _stamp(i) + YEAR_NS} if i in THREE else {}), "goes by the others", 0, "", WHOLE),
    Animal("transforms_without_a_stamp", _poses(lambda i: {"stamp_ns": 0} if i in THREE else {}), "goes by the others", 0, "", WHOLE),
)  # fmt: skip


# Unusual and legal: each gives the same map as the plain drive.
LEGAL = (
    Animal("scans_clockwise", _scans(_clockwise), "reads the bearings as they are", 0, "", WHOLE),
    Animal("scans_upside_down", lambda f: mcap(f, drive(ROS2, mount=(0, 0, 0, *HALF_TURN))), "turns the scanner about", 0, "", WHOLE),
    Animal("transforms_with_quaternions_of_length_2", _poses(lambda _: {"numbers": (0, 0, 0, 0, 0, 0, 2)}), "takes the direction alone", 0, "", WHOLE),
    Animal("transforms_with_quaternions_of_length_1e-3", _poses(lambda _: {"numbers": (0, 0, 0, 0, 0, 0, 1e-3)}), "takes the direction alone", 0, "", WHOLE),
    Animal("transforms_with_the_opposite_quaternion", _poses(lambda i: {"numbers": (0, 0, 0, 0, 0, 0, 1 - 2 * (i % 2))}), "knows that q and -q are one rotation", 0, "", WHOLE),
    Animal("frames_with_a_leading_slash", lambda f: mcap(f, drive(ROS2, lambda _: {"frame": "/laser"}, lambda _: {"frame": "/map"})), "takes the slash away", 0, "", WHOLE),
    Animal("bag_of_ros1", bag, "reads it like any other", 0, "", WHOLE),
    Animal("scans_whose_angle_max_was_never_set", _all(angle_max=-2.4), "goes by increment and number of beams", 0, "", WHOLE),
)  # fmt: skip
