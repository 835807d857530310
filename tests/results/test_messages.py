"""Points, grids and frames against rosbags, which decodes by the definitions alone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_typestore

from tests.results.rooms import T0
from timemap_cli.model.level_map import OccupancyGrid
from timemap_cli.model.nodes import Node
from timemap_cli.results import definitions
from timemap_cli.results.messages import NodeFrames, pack_grid, pack_points, unpack_nodes

STORE = get_typestore(Stores.ROS2_HUMBLE)
frames = st.text("abcdefgh_/", min_size=1, max_size=12)
finite = st.floats(-1e6, 1e6)


@given(frames)
def test_points_are_what_a_ros_client_reads(frame):
    points = np.array([[1.5, -2.0, 0.25], [3.0, 4.0, 1.0]], np.float32)
    raw = pack_points(points, T0, frame)
    cloud = STORE.deserialize_cdr(raw, definitions.POINT_CLOUD)
    assert bytes(STORE.serialize_cdr(cloud, definitions.POINT_CLOUD)) == raw
    assert (cloud.header.frame_id, cloud.height, cloud.width) == (frame, 1, 2)
    assert [(f.name, f.offset, f.datatype, f.count) for f in cloud.fields] == [
        ("x", 0, 7, 1),
        ("y", 4, 7, 1),
        ("z", 8, 7, 1),
        ("intensity", 12, 7, 1),
    ]
    assert (cloud.point_step, cloud.row_step, cloud.is_bigendian, cloud.is_dense) == (16, 32, False, True)
    rows = cloud.data.view("<f4").reshape(2, 4)
    assert rows.tolist() == [[1.5, -2.0, 0.0, 0.25], [3.0, 4.0, 0.0, 1.0]]


@given(frames)
def test_grid_is_what_a_ros_client_reads(frame):
    cells = np.array([[-1, 0, 100], [0, 0, -1]], np.int8)
    raw = pack_grid(OccupancyGrid(cells, 0.05, -1.5, 2.25), T0, frame)
    grid = STORE.deserialize_cdr(raw, definitions.OCCUPANCY_GRID)
    assert bytes(STORE.serialize_cdr(grid, definitions.OCCUPANCY_GRID)) == raw
    assert (grid.info.width, grid.info.height) == (3, 2)
    assert grid.info.resolution == np.float32(0.05)
    position, turn = grid.info.origin.position, grid.info.origin.orientation
    assert (position.x, position.y, position.z, turn.w) == (-1.5, 2.25, 0.0, 1.0)
    assert grid.data.tolist() == [-1, 0, 100, 0, 0, -1]


@given(frames, st.lists(st.tuples(finite, finite), min_size=1, max_size=5), st.integers(0, 2**31 * 10**9 - 1))
def test_frames_are_what_a_ros_client_reads(map_frame, places, stamp_ns):
    nodes = tuple(Node(x, y) for x, y in places)
    growing = NodeFrames(map_frame)
    for known in range(1, len(nodes) + 1):
        growing.extend(nodes[:known])
    raw = growing.message(stamp_ns)
    message = STORE.deserialize_cdr(raw, definitions.TF_MESSAGE)
    assert bytes(STORE.serialize_cdr(message, definitions.TF_MESSAGE)) == raw
    for number, (node, one) in enumerate(zip(nodes, message.transforms, strict=True)):
        assert one.header.stamp.sec * 10**9 + one.header.stamp.nanosec == stamp_ns
        assert (one.header.frame_id, one.child_frame_id) == (map_frame, f"timemap/node_{number:04d}")
        shift, turn = one.transform.translation, one.transform.rotation
        assert (shift.x, shift.y, shift.z) == (node.x, node.y, 0.0)
        assert (turn.x, turn.y, turn.z, turn.w) == (0.0, 0.0, 0.0, 1.0)
    assert unpack_nodes(raw) == nodes


def test_nodes_cannot_move_or_go():
    frames_of = NodeFrames("map")
    frames_of.extend((Node(1.0, 2.0), Node(3.0, 4.0)))
    for changed in [(Node(1.0, 2.0),), (Node(1.0, 2.1), Node(3.0, 4.0))]:
        with pytest.raises(ValueError, match="only ever added"):
            frames_of.extend(changed)
