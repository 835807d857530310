"""The topics of a result: their names, types and how a subscriber should be served."""

from enum import Enum

from timemap_cli.results import definitions

TF_STATIC = "/tf_static"
METADATA = "timemap"
CONFIG = "timemap/config.yaml"
REPORT = "timemap/report.json"
CHANGES = "timemap/changes.json"
CHANGE_TOPIC = "/timemap/changes"
MARKER_TOPIC = "/timemap/changes/markers"
STATE_TOPIC = "/timemap/state"
FORMAT = "timemap.result/2"


class LevelTopic(Enum):
    """What is written for every level."""

    SCAN = "scan"
    STATUS = "status"
    POINTS = "points"
    MAP = "map"

    def of(self, level: str) -> str:
        """Name of the topic, like `/timemap/long/scan`."""
        return f"/timemap/{level}/{self.value}"


MSGTYPES = {
    LevelTopic.SCAN: definitions.LASER_SCAN,
    LevelTopic.STATUS: definitions.STATUS,
    LevelTopic.POINTS: definitions.POINT_CLOUD,
    LevelTopic.MAP: definitions.OCCUPANCY_GRID,
}
LATCHED = {LevelTopic.POINTS, LevelTopic.MAP}

_FOREVER = "{sec: 9223372036, nsec: 854775807}"  # RMW_DURATION_INFINITE
_QOS = """- history: 1
  depth: {depth}
  reliability: 1
  durability: {durability}
  deadline: {forever}
  lifespan: {forever}
  liveliness: 1
  liveliness_lease_duration: {forever}
  avoid_ros_namespace_conventions: false
"""


def offered_qos_profiles(*, latched: bool) -> str:
    """Quality of service as rosbag2 (Humble) records it: reliable, and if latched kept for late comers."""
    return _QOS.format(depth=1 if latched else 10, durability=1 if latched else 2, forever=_FOREVER)
