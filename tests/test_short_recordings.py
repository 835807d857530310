"""Header stamps, log times and the span of a result are those of its scans, however short the recording is."""

import math
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader

from tests.logs.recorded import (
    ROS1,
    ROS2,
    START_NS,
    Message,
    StoragePlugin,
    scan,
    transforms,
    write_bag,
    write_mcap,
    write_rosbag2,
)
from timemap_cli.config import load
from timemap_cli.replay import replay

PERIOD_NS = 100_000_000
DAY_NS = 86_400_000_000_000
BEARINGS = np.radians(np.arange(0.0, 360.0, 4.0))
STATE = "/timemap/state"
FORMATS = {
    "bag": lambda path, messages: write_bag(path, messages, chunk_bytes=20_000),
    "one_chunk.bag": write_bag,
    "mcap": write_mcap,
    "db3": lambda path, messages: write_rosbag2(path, messages, StoragePlugin.SQLITE3),
}


def rounds(store, n_scans, start_ns=START_NS, without_pose=0):
    """Ten scans a second in a round room of 5 m, while the robot drives round it; the first ones have no pose."""
    found = []
    shape = {"angle_min": 0.0, "angle_increment": math.radians(4.0), "time_increment": 0.0}
    for i in range(n_scans):
        now, turn = start_ns + i * PERIOD_NS, i * 0.02
        x, y = 2 * math.cos(turn), 2 * math.sin(turn)
        along = -(x * np.cos(BEARINGS) + y * np.sin(BEARINGS))
        ranges = along + np.sqrt(along**2 + 25 - x * x - y * y)
        if i >= without_pose:
            edge = now, "map", "laser", (x, y, 0.0, 0.0, 0.0, 0.0, 1.0)
            found.append(Message("/tf", now, transforms(store, edge)))
        found.append(Message("/scan", now, scan(store, now, ranges, **shape)))
    return found


def recorded(folder, form, *args, **more):
    store = ROS1 if form.endswith("bag") else ROS2
    name = f"{len(list(folder.iterdir()))}.{form}"
    return FORMATS[form](folder / name, rounds(store, *args, **more))


def mapped(log, every="30s", resume=None):
    wanted = load(None, None if resume else {"estimate": {"every": every}})
    return replay([log], log.parent / f"{log.name}.timemap.mcap", wanted, resume=resume).result


def written(result):
    """Topic, log time, header stamp (None where a message has none) and bytes of all messages, as they stand."""
    with result.open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages(log_time_order=False):
            seconds, rest = struct.unpack_from("<iI", message.data, 4)
            stamp_ns = (
                None
                if channel.topic in ("/tf_static", "/timemap/changes/markers")
                else seconds * 10**9 + rest
            )
            yield channel.topic, message.log_time, stamp_ns, message.data


def assert_times(result, first_ns, last_ns):
    found = list(written(result))
    logged = [log_ns for _, log_ns, _, _ in found]
    assert logged == sorted(logged)
    assert (logged[0], logged[-1]) == (first_ns, last_ns)
    assert [
        (topic, log_ns - stamp_ns) for topic, log_ns, stamp_ns, _ in found if stamp_ns not in (None, log_ns)
    ] == []


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("short")


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("n_scans", [1, 101, 228, 229, 300, 380, 450])
def test_a_recording_of_any_length_is_logged_at_its_own_times(folder, form, n_scans):
    result = mapped(recorded(folder, form, n_scans))
    assert_times(result, START_NS, START_NS + (n_scans - 1) * PERIOD_NS)


@settings(max_examples=12, deadline=None)
@given(
    st.integers(1, 460),
    st.sampled_from(["30s", "3s", "200obs"]),
    st.sampled_from([0, 1, 40, 150]),
    st.sampled_from(sorted(FORMATS)),
)
def test_the_times_do_not_depend_on_the_format(folder, n_scans, every, without_pose, form):
    n_scans += without_pose
    results = [
        mapped(recorded(folder, one, n_scans, without_pose=without_pose), every) for one in (form, "mcap")
    ]
    first_ns = START_NS + without_pose * PERIOD_NS
    for result in results:
        assert_times(result, first_ns, START_NS + (n_scans - 1) * PERIOD_NS)
    one, other = ([message for message in written(result) if message[0] != STATE] for result in results)
    assert one == other


@pytest.mark.parametrize("n_scans", [2, 120, 300, 380])
def test_a_short_recording_that_goes_on_is_logged_at_its_own_times(folder, n_scans):
    """Of the day before there are only the newest estimates, with the stamps that they had."""
    one = mapped(recorded(folder, "mcap", 400))
    start_ns = START_NS + DAY_NS
    two = mapped(recorded(folder, "mcap", n_scans, start_ns, without_pose=1), resume=one)
    found = list(written(two))
    logged = [log_ns for _, log_ns, _, _ in found]
    assert logged == sorted(logged)
    assert (logged[0], logged[-1]) == (start_ns + PERIOD_NS, start_ns + (n_scans - 1) * PERIOD_NS)
    stamps = [(log_ns, stamp_ns) for _, log_ns, stamp_ns, _ in found if stamp_ns is not None]
    assert all(
        log_ns == stamp_ns if stamp_ns >= start_ns else log_ns == logged[0] for log_ns, stamp_ns in stamps
    )
