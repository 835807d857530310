"""The messages of a result that are written now and then: frames, points and grids."""

import numpy as np
import numpy.typing as npt

from timemap_cli.model.level_map import OccupancyGrid
from timemap_cli.model.nodes import Node
from timemap_cli.results.cdr import CdrBuilder, CdrParser
from timemap_cli.results.frames import node_frame, node_of_frame

_FLOAT32 = 7  # sensor_msgs/PointField
_NS = 1_000_000_000


def pack_points(points: npt.NDArray[np.float32], stamp_ns: int, frame_id: str) -> bytes:
    """`sensor_msgs/PointCloud2` of (k, 3) points x [m], y [m], support; z is 0, `intensity` the support."""
    rows = np.zeros((len(points), 4), "<f4")
    rows[:, (0, 1, 3)] = points
    cdr = CdrBuilder()
    cdr.header(stamp_ns, frame_id)
    cdr.pack("I", 1, len(rows), 4)  # height, width, number of fields
    for place, name in enumerate(("x", "y", "z", "intensity")):
        cdr.string(name)
        cdr.pack("I", 4 * place)
        cdr.pack("B", _FLOAT32)
        cdr.pack("I", 1)
    cdr.pack("B", False)  # is_bigendian
    cdr.pack("I", rows.itemsize * 4, rows.nbytes)  # point_step, row_step
    cdr.octets(rows.tobytes())
    cdr.pack("B", True)  # is_dense: no NaN among them
    return cdr.message()


def pack_grid(grid: OccupancyGrid, stamp_ns: int, frame_id: str) -> bytes:
    """`nav_msgs/OccupancyGrid`: -1 unknown, 0 free, 100 occupied; cell (0, 0) begins at the origin."""
    height, width = grid.cells.shape
    cdr = CdrBuilder()
    cdr.header(stamp_ns, frame_id)
    cdr.time(stamp_ns)  # map_load_time
    cdr.pack("f", grid.resolution)
    cdr.pack("I", width, height)
    cdr.pack("d", grid.origin_x, grid.origin_y, 0.0)
    cdr.pack("d", 0.0, 0.0, 0.0, 1.0)
    cdr.octets(grid.cells.tobytes())
    return cdr.message()


class NodeFrames:
    """The transforms from the map to every node, grown as nodes are added.

    A viewer keeps only the last message of `/tf_static`, so each one holds all nodes. The transforms are kept
    as bytes, and only their stamps change from message to message.
    """

    def __init__(self, map_frame: str) -> None:
        self._map_frame = map_frame
        self._cdr = CdrBuilder()
        self._cdr.pack("I", 0)
        self._stamp_places: list[int] = []  # byte of each transform's stamp in the message
        self.nodes: tuple[Node, ...] = ()

    def extend(self, nodes: tuple[Node, ...]) -> None:
        """Take a list of nodes that begins with those already known; ValueError if it does not."""
        known = len(self.nodes)
        if nodes[:known] != self.nodes:
            raise ValueError("a node has moved or is missing: nodes are only ever added at the end")
        for number, node in enumerate(nodes[known:], known):
            self._cdr.align(4)
            self._stamp_places.append(len(self._cdr))
            self._cdr.header(0, self._map_frame)
            self._cdr.string(node_frame(number))
            self._cdr.pack("d", node.x, node.y, 0.0)
            self._cdr.pack("d", 0.0, 0.0, 0.0, 1.0)
        self.nodes = nodes

    def message(self, stamp_ns: int) -> bytes:
        """`tf2_msgs/TFMessage` with every node, all of one stamp."""
        message = bytearray(self._cdr.message())
        words = np.frombuffer(message, "<u4")
        words[1] = len(self.nodes)
        places = np.array(self._stamp_places, np.int64) // 4
        words[places], words[places + 1] = divmod(stamp_ns, _NS)
        return bytes(message)


def unpack_nodes(message: bytes) -> tuple[Node, ...]:
    """The nodes that a message of `NodeFrames` places; ValueError or struct.error if it is none."""
    cdr = CdrParser(message)
    (count,) = cdr.unpack("I")
    nodes = []
    for number in range(count):
        cdr.header()
        if node_of_frame(cdr.string()) != number:
            raise ValueError("nodes are not in order")
        x, y, *_ = cdr.unpack("d", 7)
        nodes.append(Node(x, y))
    return tuple(nodes)
