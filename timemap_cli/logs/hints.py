"""Words for what is missing in recordings: what to record, and what they hold instead."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from timemap_cli.errors import as_word
from timemap_cli.logs.frames import Frames

CLOUD_TYPES = (
    "sensor_msgs/msg/PointCloud2",
    "sensor_msgs/msg/PointCloud",
    "sensor_msgs/msg/MultiEchoLaserScan",
)


def what_to_record(frames: Frames, frame: str) -> str:
    """What a frame needs to be placed in the map."""
    if frames and not frames.connected_to(frame) - {frame}:
        return f"record /tf_static too; it must say where {frame!r} sits on the robot"
    return "record the transforms from the map to the laser (/tf, /tf_static)"


def family(frames: Frames, frame: str) -> str:
    """What a frame is connected to, in words."""
    others = frames.connected_to(frame) - {frame}
    if others:
        return f"only to {_some(others)}"
    rest = frames.names() - {frame}
    if near := get_close_matches(frame, sorted(rest), 1):
        return f"no transform names it, but there is '{near[0]}'"
    return f"no transform names it; there are {_some(rest)}" if rest else "there are no transforms"


def _some(names: Iterable[str]) -> str:
    """A few of some frames, those first that one would look for."""

    def rank(name: str) -> tuple[bool, str]:
        return not any(word in name for word in ("map", "odom", "base_", "laser", "scan")), name

    ordered = sorted(names, key=rank)
    more = f" and {len(ordered) - 4} more" if len(ordered) > 4 else ""
    return ", ".join(f"'{name}'" for name in ordered[:4]) + more


def what_else(topics: Mapping[str, str], wanted: str) -> str:
    """The topics that there are instead of one of the wanted type."""
    names = sorted(topics)
    more = f" and {len(names) - 6} more" if len(names) > 6 else ""
    if not names:
        return "there are no messages"
    for name in names:
        if topics[name].startswith(f"{wanted} in "):
            return f"{name} holds {topics[name]}, which is not read"
    return f"no topic of type {wanted} among {', '.join(names[:6])}{more}"


def instead(topics: Mapping[str, str]) -> str:
    """What might be done where there are no laser scans."""
    for topic in sorted(topics):
        if topics[topic] in CLOUD_TYPES:
            return f"turn {as_word(topic)} into laser scans first (pointcloud_to_laserscan)"
    return "record the topic of the laser scanner together with /tf and /tf_static"
