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
CHANGE = "timemap_msgs/msg/Change"
STATE = "timemap_msgs/msg/State"
MARKERS = "visualization_msgs/msg/MarkerArray"

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
    "builtin_interfaces/msg/Duration": "int32 sec\nuint32 nanosec\n",
    "std_msgs/msg/ColorRGBA": "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n",
    "sensor_msgs/msg/CompressedImage": "std_msgs/Header header\nstring format\nuint8[] data\n",
    "visualization_msgs/msg/UVCoordinate": "float32 u\nfloat32 v\n",
    "visualization_msgs/msg/MeshFile": "string filename\nuint8[] data\n",
    "visualization_msgs/msg/Marker": (
        "int32 ARROW=0\n"
        "int32 CUBE=1\n"
        "int32 SPHERE=2\n"
        "int32 CYLINDER=3\n"
        "int32 LINE_STRIP=4\n"
        "int32 LINE_LIST=5\n"
        "int32 CUBE_LIST=6\n"
        "int32 SPHERE_LIST=7\n"
        "int32 POINTS=8\n"
        "int32 TEXT_VIEW_FACING=9\n"
        "int32 MESH_RESOURCE=10\n"
        "int32 TRIANGLE_LIST=11\n"
        "int32 ADD=0\n"
        "int32 MODIFY=0\n"
        "int32 DELETE=2\n"
        "int32 DELETEALL=3\n"
        "std_msgs/Header header\n"
        "string ns\n"
        "int32 id\n"
        "int32 type\n"
        "int32 action\n"
        "geometry_msgs/Pose pose\n"
        "geometry_msgs/Vector3 scale\n"
        "std_msgs/ColorRGBA color\n"
        "builtin_interfaces/Duration lifetime\n"
        "bool frame_locked\n"
        "geometry_msgs/Point[] points\n"
        "std_msgs/ColorRGBA[] colors\n"
        "string texture_resource\n"
        "sensor_msgs/CompressedImage texture\n"
        "visualization_msgs/UVCoordinate[] uv_coordinates\n"
        "string text\n"
        "string mesh_resource\n"
        "visualization_msgs/MeshFile mesh_file\n"
        "bool mesh_use_embedded_materials\n"
    ),
    MARKERS: "visualization_msgs/Marker[] markers\n",
    CHANGE: (
        "# Something that was found out about a change event; the stamp says when. All times are of scans.\n"
        "std_msgs/Header header\n"
        "uint32 id                                  # of the event, the same for all its messages\n"
        "string turn                                # seen, adopted, closed, reopened, dropped\n"
        "string level                               # the one that adopted it, else empty\n"
        "string kind                                # appeared, vanished, moved\n"
        "geometry_msgs/Point[] outline              # of where it stands, or stood\n"
        "geometry_msgs/Point[] moved_from           # one point where it moved, else none\n"
        "float32 support                            # 0..1\n"
        "builtin_interfaces/Time first_seen\n"
        "builtin_interfaces/Time last_seen\n"
        "builtin_interfaces/Time looked             # newest scan that could tell\n"
        "string[] adopted_levels                    # levels that have adopted it ...\n"
        "builtin_interfaces/Time[] adopted          # ... and when\n"
        "uint32[] nodes                             # that show it\n"
        "uint32[] against                           # that show it undone\n"
        "builtin_interfaces/Time[] since            # of each episode\n"
        "builtin_interfaces/Time[] until            # one less than since while it holds\n"
        "float32 share_held                         # of the looks, 0..1\n"
    ),
    "timemap_msgs/msg/StateArray": (
        "string name\n"
        "string dtype     # as NumPy has it, little endian: <u2, <f8, ...\n"
        "uint32[] shape\n"
        "uint8[] data     # row by row\n"
    ),
    STATE: (
        "# What a later replay needs to go on where this one stopped: `timemap replay --resume`. Its names are no\n"
        "# promise: another timemap may keep other things.\n"
        "std_msgs/Header header\n"
        "string part      # reading, learning, node, changes\n"
        "uint32 node      # its number\n"
        "string plain     # JSON: numbers and texts by name\n"
        "timemap_msgs/StateArray[] arrays\n"
    ),
    STATUS: (
        "# What a level knows about each angle bin, beside the scan of the same node and stamp.\n"
        "# What the scan's intensities hold is support: the share of what is known that agrees with it.\n"
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
        "float32[] known         # share of the window that is known, 0..1\n"
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
