import pytest

from tests.logs import recorded
from tests.logs.recorded import ROS2, TOPICS, StoragePlugin
from timemap_cli.logs.announced_counts import announced_counts


def test_the_counts_of_a_bag_that_rosbags_wrote(tmp_path):
    folder = recorded.write_rosbag2(tmp_path / "run", recorded.drive(ROS2, 20), StoragePlugin.SQLITE3)
    assert announced_counts(folder / "metadata.yaml") == {
        topic: 1 if topic == "/tf_static" else 20 for topic in TOPICS
    }


@pytest.mark.parametrize(
    "text",
    [
        "",
        "17",
        "rosbag2_bagfile_information: [",
        "rosbag2_bagfile_information: {topics_with_message_count: 5}",
        "rosbag2_bagfile_information: {topics_with_message_count: [{message_count: 7}]}",
        "rosbag2_bagfile_information: {topics_with_message_count: [{topic_metadata: {name: /a}, message_count: many}]}",
        "[" * 5000,
    ],
)
def test_what_cannot_be_understood_announces_nothing(tmp_path, text):
    path = tmp_path / "metadata.yaml"
    path.write_text(text)
    assert announced_counts(path) == {}
