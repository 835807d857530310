"""The message types of a result file, as ROS 2 Humble defines them, and our own.

A reader decodes with the definitions that the file brings, so they are written here to the letter instead of
taken from an installed library. Fields of our own types are only ever added at the end: a program made for a
shorter type then still finds every field that it knows.
"""

LASER_SCAN = "sensor_msgs/msg/LaserScan"
POINT_CLOUD = "sensor_msgs/msg/PointCloud2"
OCCUPANCY_GRID = "nav_msgs/msg/OccupancyGrid"
TF_MESSAGE = "tf2_msgs/msg/TFMessage"
STATUS = "timemap_msgs/msg/Status"

_SEPARATOR = "=" * 80

_FIELDS = {
    "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec\n",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "geometry_msgs/msg/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/msg/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/msg/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    "geometry_msgs/msg/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
    "geometry_msgs/msg/Transform": "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
    "geometry_msgs/msg/TransformStamped": (
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"
    ),
    TF_MESSAGE: "geometry_msgs/TransformStamped[] transforms\n",
    LASER_SCAN: (
        "std_msgs/Header header\n"
        "float32 angle_min\n"
        "float32 angle_max\n"
        "float32 angle_increment\n"
        "float32 time_increment\n"
        "float32 scan_time\n"
        "float32 range_min\n"
        "float32 range_max\n"
        "float32[] ranges\n"
        "float32[] intensities\n"
    ),
    "sensor_msgs/msg/PointField": (
        "uint8 INT8=1\n"
        "uint8 UINT8=2\n"
        "uint8 INT16=3\n"
        "uint8 UINT16=4\n"
        "uint8 INT32=5\n"
        "uint8 UINT32=6\n"
        "uint8 FLOAT32=7\n"
        "uint8 FLOAT64=8\n"
        "string name\n"
        "uint32 offset\n"
        "uint8 datatype\n"
        "uint32 count\n"
    ),
    POINT_CLOUD: (
        "std_msgs/Header header\n"
        "uint32 height\n"
        "uint32 width\n"
        "sensor_msgs/PointField[] fields\n"
        "bool is_bigendian\n"
        "uint32 point_step\n"
        "uint32 row_step\n"
        "uint8[] data\n"
        "bool is_dense\n"
    ),
    "nav_msgs/msg/MapMetaData": (
        "builtin_interfaces/Time map_load_time\n"
        "float32 resolution\n"
        "uint32 width\n"
        "uint32 height\n"
        "geometry_msgs/Pose origin\n"
    ),
    OCCUPANCY_GRID: "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n",
    STATUS: (
        "# What a level knows about each angle bin, beside the scan of the same node and stamp.\n"
        "# The share of the level's window that is known: support + 1 - plausibility.\n"
        "std_msgs/Header header\n"
        "uint16[] samples        # remembered ranges\n"
        "float32[] plausibility  # share of the window that does not contradict the scan, 0..1\n"
        "uint8 UNKNOWN=0         # never observed\n"
        "uint8 MEASURED=1        # observed like that lately, and most of what is known says so\n"
        "uint8 CONCLUDED=2       # not observed like that lately, or against its own majority\n"
        "uint8 CONTESTED=3       # observed lately, but another state is about as likely\n"
        "uint8[] status\n"
        "# Stamp of the newest scan, of those that the level took, that saw the angle bin; zero: none.\n"
        "builtin_interfaces/Time[] last_seen\n"
    ),
}


def definition(msgtype: str) -> str:
    """Full `ros2msg` text of a type: its own fields, then every type it needs, each once.

    Raises KeyError for a type that no result holds.
    """
    needed = _types_within(msgtype, [])
    parts = [f"MSG: {_short(name)}\n{_FIELDS[name]}" for name in needed]
    return f"{_SEPARATOR}\n".join([_FIELDS[msgtype], *parts])


def _types_within(msgtype: str, found: list[str]) -> list[str]:
    """Types that a type is made of, however deep, in order of appearance, added to those found before."""
    for line in _FIELDS[msgtype].splitlines():
        package, slash, name = line.split(" ")[0].removesuffix("[]").partition("/")
        inner = f"{package}/msg/{name}"
        if slash and not line.startswith("#") and inner not in found:
            found.append(inner)
            _types_within(inner, found)
    return found


def _short(msgtype: str) -> str:
    return msgtype.replace("/msg/", "/")
