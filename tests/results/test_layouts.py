"""The packed bytes against rosbags, which decodes by the definitions alone."""

from dataclasses import replace

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.results.rooms import T0, estimate
from timemap_cli.model.estimates import Estimate
from timemap_cli.results import definitions
from timemap_cli.results.layouts import pack_scans, pack_statuses, unpack_estimate

STORE = get_typestore(Stores.ROS2_HUMBLE)
STORE.register(get_types_from_msg(definitions.definition(definitions.STATUS), definitions.STATUS))
FIVE = np.float32(5.0)


def with_node(node: int, bins: int = 360) -> Estimate:
    one = estimate(0, "mid", T0, bins)
    return replace(one, node=node, stamp_ns=T0 + node)


@pytest.mark.parametrize("bins", [359, 360, 361, 362])
@pytest.mark.parametrize("node", [7, 9999, 10000, 123456])
def test_scan_is_what_a_ros_client_reads(node, bins):
    one = with_node(node, bins)
    (raw,) = pack_scans([one], bins, FIVE)
    scan = STORE.deserialize_cdr(raw, definitions.LASER_SCAN)
    assert STORE.serialize_cdr(scan, definitions.LASER_SCAN) == raw
    assert scan.header.frame_id == f"timemap/node_{node:04d}"
    assert scan.header.stamp.sec * 10**9 + scan.header.stamp.nanosec == T0 + node
    assert (scan.range_min, scan.range_max, scan.time_increment, scan.scan_time) == (0.0, 5.0, 0.0, 0.0)
    np.testing.assert_array_equal(scan.ranges, one.ranges)
    np.testing.assert_array_equal(scan.intensities, one.support)


@pytest.mark.parametrize("bins", [358, 359, 360, 361])
@pytest.mark.parametrize("node", [7, 10000])
def test_status_is_what_a_ros_client_reads(node, bins):
    one = with_node(node, bins)
    (raw,) = pack_statuses([one], bins)
    status = STORE.deserialize_cdr(raw, definitions.STATUS)
    assert bytes(STORE.serialize_cdr(status, definitions.STATUS)) == raw
    assert status.header.frame_id == f"timemap/node_{node:04d}"
    np.testing.assert_array_equal(status.samples, one.samples)
    np.testing.assert_array_equal(status.plausibility, one.plausibility)
    np.testing.assert_array_equal(status.status, one.status)
    np.testing.assert_array_equal(status.known, one.known)
    assert [time.sec * 10**9 + time.nanosec for time in status.last_seen] == one.last_seen_ns.tolist()


def test_an_angle_bin_that_was_never_seen_has_a_time_of_zero():
    one = with_node(0)
    one.last_seen_ns[3] = 0
    (raw,) = pack_statuses([one], 360)
    never = STORE.deserialize_cdr(raw, definitions.STATUS).last_seen[3]
    assert (never.sec, never.nanosec) == (0, 0)


def test_a_batch_with_frame_names_of_several_lengths_keeps_its_order():
    batch = [with_node(node) for node in (3, 10000, 4, 10001, 5)]
    frames = [
        STORE.deserialize_cdr(raw, definitions.LASER_SCAN).header.frame_id
        for raw in pack_scans(batch, 360, FIVE)
    ]
    assert [int(frame.rsplit("_")[-1]) for frame in frames] == [3, 10000, 4, 10001, 5]


@pytest.mark.parametrize("bad", [5.001, -0.001, -np.inf])
def test_a_range_that_viewers_would_not_show_is_refused(bad):
    one = with_node(0)
    one.ranges[17] = bad
    with pytest.raises(ValueError, match=r"a range is not in 0\.\.5\.0 m"):
        list(pack_scans([one], 360, FIVE))


def test_unpacking_a_message_with_another_number_of_bins_is_an_error():
    one = with_node(0, 180)
    (scan,), (status,) = pack_scans([one], 180, FIVE), pack_statuses([one], 180)
    with pytest.raises(ValueError, match=r"buffer|angle bins"):
        unpack_estimate(scan, status, "mid", 360)
