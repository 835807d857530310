"""The layouts for viewers name what results hold."""

import json
import re
from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader
from ruamel.yaml import YAML

from tests.results.events import write_changing_room
from tests.results.rooms import write_room
from timemap_cli.results.definitions import CHANGE, STATE, STATUS

VIEWERS = Path(__file__).parents[1] / "docs" / "viewers"
RVIZ = ["timemap.rviz", "timemap_rviz2.rviz"]
TYPES = {
    "Map": "nav_msgs/msg/OccupancyGrid",
    "PointCloud2": "sensor_msgs/msg/PointCloud2",
    "MarkerArray": "visualization_msgs/msg/MarkerArray",
}
SHOWN = {
    "/timemap/long/map": TYPES["Map"],
    "/timemap/long/points": TYPES["PointCloud2"],
    "/timemap/mid/points": TYPES["PointCloud2"],
    "/timemap/changes/markers": TYPES["MarkerArray"],
}


@pytest.fixture(scope="module")
def topics(tmp_path_factory):
    """Connections of a result with maps and of one with changes, by topic."""
    found = {}
    for write in (write_room, write_changing_room):
        path = tmp_path_factory.mktemp("room") / "room.timemap.mcap"
        write(path)
        with AnyReader([path]) as reader:
            found |= {connection.topic: connection for connection in reader.connections}
    return found


@pytest.fixture(scope="module")
def layout():
    return json.loads((VIEWERS / "foxglove_layout.json").read_text())


def panel(layout, kind):
    (found,) = [config for name, config in layout["configById"].items() if name.startswith(f"{kind}!")]
    return found


def panels_within(place):
    """Names of the panels in a layout's tree."""
    if isinstance(place, str):
        return [place]
    return panels_within(place["first"]) + panels_within(place["second"])


def manager(name):
    return YAML(typ="safe").load(VIEWERS / name)["Visualization Manager"]


def topic_of(display):
    """RViz 2 keeps the topic with how it is subscribed to, RViz 1 by itself."""
    topic = display.get("Topic") or display.get("Marker Topic")
    return topic["Value"] if isinstance(topic, dict) else topic


def test_what_is_shown_is_in_a_result(topics):
    assert SHOWN.items() <= {topic: c.msgtype for topic, c in topics.items()}.items()


@pytest.mark.parametrize("name", RVIZ)
def test_rviz_shows_each_topic_with_a_display_of_its_type(name):
    kinds = {topic_of(d): d["Class"].partition("/")[2] for d in manager(name)["Displays"]}
    assert {topic: TYPES[kind] for topic, kind in kinds.items() if topic} == SHOWN
    assert kinds[None] == "TF"


@pytest.mark.parametrize("name", RVIZ)
def test_rviz_shows_in_the_map_frame_all_that_is_switched_on(name):
    assert manager(name)["Global Options"]["Fixed Frame"] == "map"
    assert all(display["Enabled"] for display in manager(name)["Displays"])


def test_rviz_2_subscribes_as_results_offer(topics):
    for display in manager("timemap_rviz2.rviz")["Displays"]:
        if topic := topic_of(display):
            (offered,) = topics[topic].ext.offered_qos_profiles
            wanted = (display["Topic"]["Reliability Policy"], display["Topic"]["Durability Policy"])
            names = (offered.reliability.name, offered.durability.name)
            assert names == tuple(policy.upper().replace(" ", "_") for policy in wanted)


def test_foxglove_shows_the_same_topics_in_the_map_frame(layout):
    config = panel(layout, "3D")
    assert config["followTf"] == "map"
    assert config["topics"].keys() == SHOWN.keys()
    assert all(topic["visible"] for topic in config["topics"].values())


def test_foxglove_places_every_panel_that_is_set_up(layout):
    assert sorted(panels_within(layout["layout"])) == sorted(layout["configById"])


def test_foxglove_panels_read_fields_of_changes(layout, topics):
    assert panel(layout, "RawMessages")["topicPath"] in topics
    definition = topics["/timemap/changes"].msgdef.data
    for path in panel(layout, "StateTransitions")["paths"]:
        topic, _, field = path["value"].partition(".")
        assert topic == "/timemap/changes"
        assert f"string {field} " in definition


def test_the_types_that_no_ros_knows_are_named():
    told = (VIEWERS / "README.md").read_text()
    assert set(re.findall(r"timemap_msgs/msg/\w+", told)) == {STATUS, CHANGE, STATE}
    assert "leaves out the three types it does not know" in told
