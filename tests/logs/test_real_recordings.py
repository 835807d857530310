"""Real recordings decode to what rosbags gives for every message of theirs."""

from __future__ import annotations

import pytest
from rosbags.highlevel import AnyReader

from tests.conftest import shared_data
from tests.logs import recorded
from timemap_cli.logs import decode
from timemap_cli.logs.message_types import MESSAGE_TYPES
from timemap_cli.logs.recordings import Recording

READ_BY_ROSBAGS = [
    "bham_pioneer/trace1.bag",
    "edge_cases/basic_localization_stage.bag",
    "edge_cases/csmfail.bag",
    "edge_cases/mylaserdata.bag",
    "edge_cases/mylaserdata2.bag",
    "edge_cases/mylaserdata3.bag",
    "edge_cases/mylaserdata4.bag",
    "edge_cases/nav2_turtlebot.mcap",
    "edge_cases/pegatron5F.bag",
    "edge_cases/pr2_mylaserdata.bag",
    "edge_cases/robotino_mylaserdata.bag",
    "edge_cases/scan_today_bag_0.db3",
    "edge_cases/test_bag_0.db3",
    "edge_cases/tf_example.bag",
    "edge_cases/tf_example.db3",
    "intel/intel.bag",
    "intel/intel.mcap",
    "intel/intel_db3",
    "olin_mac1",
    "wean/wean_run1.bag",
    "wean/wean_run1.mcap",
]


def read(path):
    with Recording(path) as recording:
        topics = [topic.name for topic in recording.topics if topic.msgtype in MESSAGE_TYPES]
        found = recorded.rows([batch for batches in recording.batches(topics) for batch in batches])
        assert recording.problems == ()
        assert {topic.name: topic.count for topic in recording.topics if topic.count}
        return found


def in_order_of_time(found):
    """The order of messages of one log time is not fixed where several connections share a topic."""
    return {key: sorted(rows) for key, rows in found.items()}


@pytest.mark.parametrize("name", READ_BY_ROSBAGS)
def test_content_is_what_rosbags_finds(name, monkeypatch):
    path = shared_data(name)

    def never(*_):
        raise AssertionError("a message was decoded on its own")

    monkeypatch.setattr(decode, "decode_singly", never)
    with AnyReader([path], default_typestore=recorded.ROS2) as reader:
        wanted = [one for one in reader.connections if one.msgtype in MESSAGE_TYPES]
        messages = [
            (one.topic, log_ns, reader.deserialize(raw, one.msgtype))
            for one, log_ns, raw in reader.messages(wanted)
        ]
    assert in_order_of_time(read(path)) == in_order_of_time(recorded.expected_rows(messages))


def test_bag_that_announces_another_length_of_its_index(monkeypatch):
    (scans,) = read(shared_data("edge_cases/laser_scan_matcher_demo.bag")).values()
    assert len(scans) == 360
    assert [row[0] for row in scans] == sorted(row[0] for row in scans)
