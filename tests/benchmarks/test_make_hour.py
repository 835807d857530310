"""The long recording of the benchmark, a few seconds of it."""

from itertools import pairwise

import numpy as np
from rosbags.highlevel import AnyReader

from benchmarks.make_hour import SCANNER, building, make, one_round, patrol
from sample_logs.world import outline_segments


def test_the_route_stays_clear_of_walls_and_furniture():
    world = building()
    segments = np.concatenate([world.walls, *(outline_segments(thing.outline) for thing in world.things)])
    route = np.array(one_round())
    points = np.concatenate([np.linspace(a, b, 40) for a, b in pairwise(route)])
    start, edge = segments[None, :, :2], (segments[:, 2:] - segments[:, :2])[None]
    share = np.clip(((points[:, None] - start) * edge).sum(-1) / (edge**2).sum(-1), 0, 1)
    assert np.linalg.norm(points[:, None] - start - share[..., None] * edge, axis=-1).min() > 0.3


def test_a_round_visits_more_than_a_hundred_places_a_metre_apart():
    poses = patrol(600.0).poses[:, :2]
    nodes = poses[:1]
    for pose in poses[::20]:
        if np.hypot(*(nodes - pose).T).min() > 1.0:
            nodes = np.vstack([nodes, pose])
    assert len(nodes) > 100


def test_it_holds_what_a_nav2_robot_sends(tmp_path):
    path = make(tmp_path, 0.1)
    with AnyReader([path]) as reader:
        counts = {connection.topic: connection.msgcount for connection in reader.connections}
        both = [
            len(reader.deserialize(raw, connection.msgtype).transforms)
            for connection, _, raw in reader.messages()
            if connection.topic == "/tf"
        ]
        scan = next(
            reader.deserialize(raw, connection.msgtype)
            for connection, _, raw in reader.messages()
            if connection.topic == "/scan"
        )
    assert counts["/scan"] == 54  # 6 s at 10 Hz, less 0.3 s at both ends
    assert counts["/tf"] == 299 + 60 + 60
    assert both.count(2) == 60
    assert len(scan.ranges) == SCANNER.beams == 1081
    assert make(tmp_path, 0.1) == path
