"""The message types that are read, their standard layout, and the decoders of rosbags for every other one.

A recording carries the definitions of its own types. Where they say what everybody's say, whole blocks of
messages are decoded at once; where they differ, rosbags decodes message by message as the definition asks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from typing import Any, cast

from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Typesdict
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from timemap_cli.logs.raw import Connection


class Kind(Enum):
    """What a topic's messages are read as."""

    SCAN = "scan"
    TRANSFORMS = "transforms"
    POSE = "pose"


Fields = tuple[tuple[str, str], ...]  # (path, type), in the order they are serialised

_HEADER: Fields = (
    ("header.stamp.sec", "int32"),
    ("header.stamp.nanosec", "uint32"),
    ("header.frame_id", "string"),
)


def _vector(path: str, names: str = "xyz") -> Fields:
    return tuple((f"{path}.{name}", "float64") for name in names)


def _pose(path: str) -> Fields:
    return (*_vector(f"{path}.position"), *_vector(f"{path}.orientation", "xyzw"))


_SCAN: Fields = (
    *_HEADER,
    *((name, "float32") for name in ("angle_min", "angle_max", "angle_increment")),
    *((name, "float32") for name in ("time_increment", "scan_time", "range_min", "range_max")),
    ("ranges", "float32[]"),
    ("intensities", "float32[]"),
)
_TRANSFORM: Fields = (
    *_HEADER,
    ("child_frame_id", "string"),
    *_vector("transform.translation"),
    *_vector("transform.rotation", "xyzw"),
)
_POSE_STAMPED: Fields = (*_HEADER, *_pose("pose"))
_POSE_WITH_COVARIANCE: Fields = (*_HEADER, *_pose("pose.pose"), ("pose.covariance", "float64[36]"))
_ODOMETRY: Fields = (
    *_HEADER,
    ("child_frame_id", "string"),
    *_pose("pose.pose"),
    ("pose.covariance", "float64[36]"),
    *_vector("twist.twist.linear"),
    *_vector("twist.twist.angular"),
    ("twist.covariance", "float64[36]"),
)


@dataclass(frozen=True, slots=True)
class MessageType:
    """A message type we read: what it is read as, and its standard fields.

    ``fields`` are those of the message, or, if ``repeated``, of each element of the one sequence it
    consists of.
    """

    kind: Kind
    fields: Fields
    repeated: bool = False


MESSAGE_TYPES: dict[str, MessageType] = {
    "sensor_msgs/msg/LaserScan": MessageType(Kind.SCAN, _SCAN),
    "tf2_msgs/msg/TFMessage": MessageType(Kind.TRANSFORMS, _TRANSFORM, repeated=True),
    "tf/msg/tfMessage": MessageType(Kind.TRANSFORMS, _TRANSFORM, repeated=True),
    "geometry_msgs/msg/PoseStamped": MessageType(Kind.POSE, _POSE_STAMPED),
    "geometry_msgs/msg/PoseWithCovarianceStamped": MessageType(Kind.POSE, _POSE_WITH_COVARIANCE),
    "nav_msgs/msg/Odometry": MessageType(Kind.POSE, _ODOMETRY),
}
TRANSFORMS_DEFINITION = "geometry_msgs/TransformStamped[] transforms"
HEADER, OLDEST_HEADER = "std_msgs/msg/Header", "roslib/msg/Header"
DEFAULT_STORES = {"cdr": Stores.ROS2_HUMBLE, "ros1": Stores.ROS1_NOETIC}


def is_read(connection: Connection) -> bool:
    """Whether messages of this type are read, and in this encoding."""
    return connection.msgtype in MESSAGE_TYPES and connection.encoding in DEFAULT_STORES


class DecoderCache:
    """What is known about the types of one recording's connections, found out when first asked for."""

    def __init__(self) -> None:
        self._standard: dict[tuple[str, str, str], Fields | None] = {}

    def standard_fields(self, connection: Connection) -> Fields | None:
        """The type's fields as they are serialised, if they are the standard ones; else None."""
        key = _key(connection)
        if key not in self._standard:
            self._standard[key] = self._matching_fields(connection)
        return self._standard[key]

    def deserialiser(self, connection: Connection) -> Callable[[bytes], Any]:
        """Function from one message to rosbags' object; it raises what rosbags raises.

        ValueError where the encoding is neither CDR nor that of ROS 1.
        """
        store = self._store(connection)
        if connection.encoding == "cdr":
            return lambda raw: store.deserialize_cdr(raw, connection.msgtype)
        if connection.encoding == "ros1":
            return lambda raw: store.deserialize_ros1(raw, connection.msgtype)
        raise ValueError(f"messages in {connection.encoding!r} encoding cannot be read")

    def _store(self, connection: Connection) -> Typestore:
        return _make_store(*_key(connection), connection.definition_format)

    def _matching_fields(self, connection: Connection) -> Fields | None:
        message_type = MESSAGE_TYPES.get(connection.msgtype)
        if message_type is None or connection.encoding not in DEFAULT_STORES:
            return None
        fields = message_type.fields
        if connection.encoding == "ros1":
            fields = (("header.seq", "uint32"), *fields)
        prefix = "transforms[]." if message_type.repeated else ""
        expected = tuple((prefix + path, base) for path, base in fields)
        found = flattened(self._store(connection).fielddefs, connection.msgtype)
        return fields if found == expected else None


def _key(connection: Connection) -> tuple[str, str, str]:
    return connection.msgtype, connection.encoding, connection.definition


@lru_cache(maxsize=64)
def _make_store(msgtype: str, encoding: str, definition: str, definition_format: str) -> Typestore:
    """Types as the connection's own definition has them; the distribution's where it has none or an unreadable one."""
    try:
        if definition_format == "idl" and definition:
            types = _types_from_idl(definition)
        elif definition:
            types = get_types_from_msg(definition, msgtype)
        else:
            types = {}
        if OLDEST_HEADER in types:  # its place before ROS 1.2; it is referred to as "Header" all the same
            types.setdefault(HEADER, types[OLDEST_HEADER])
        if flattened(types, msgtype):
            store = get_typestore(Stores.EMPTY)
            store.register(types)
            return store
    except Exception:  # noqa: BLE001 - the parser meets foreign text, and says in many ways that it cannot
        pass
    store = get_typestore(DEFAULT_STORES.get(encoding, Stores.ROS2_HUMBLE))
    message_type = MESSAGE_TYPES.get(msgtype)
    if message_type and message_type.kind is Kind.TRANSFORMS and msgtype not in store.fielddefs:
        store.register(get_types_from_msg(TRANSFORMS_DEFINITION, msgtype))
    return store


def _types_from_idl(text: str) -> Typesdict:
    """Types of an IDL text; several files in one are divided by a line of 80 equals signs and named."""
    divider = "=" * 80 + "\n"
    types: Typesdict = {}
    if text.startswith(f"{divider}IDL: "):
        for part in text.split(divider)[1:]:
            types.update(get_types_from_idl(part.split("\n", 1)[1]))
    else:
        types.update(get_types_from_idl(text))
    return types


def flattened(types: Typesdict, name: str) -> Fields | None:
    """Base fields of a type in serialised order, ``[]`` behind sequences; None where a type is not known."""
    if name not in types:
        return None
    fields: list[tuple[str, str]] = []
    for field_name, description in types[name][1]:
        node, detail = cast("tuple[Nodetype, Any]", description)
        suffix = ""
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            (node, detail), size = detail
            suffix = f"[{size or ''}]"
        if node == Nodetype.BASE:
            fields.append((field_name, f"{detail[0]}{suffix}"))
            continue
        inner = flattened(types, detail)
        if inner is None:
            return None
        fields += [(f"{field_name}{suffix}.{path}", base) for path, base in inner]
    return tuple(fields)
