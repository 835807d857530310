"""Small results on disk: a round room of 4 m radius, in which a box may stand 2 m from the node."""

from pathlib import Path

import numpy as np

from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.status import Status
from timemap_cli.results.writer import ResultWriter

BINS = 360
SECOND = 1_000_000_000
START = 1_700_000_000 * SECOND
NODE = Node(1.0, 2.0)
LEVELS = ("short", "mid", "long")

NO_REPORT = {"schema": "timemap.report/1", "nodes": 0, "scans": {"read": 0, "used": 0, "dropped": {}}}
NO_CHANGES = {"schema": "timemap.changes/1", "events": [], "summary": {}}


def room(level, stamp_ns, *, box: bool, node: int = 0) -> Estimate:
    """What the level holds; the box stands to the left (+y) of the node, 30 degrees wide."""
    ranges = np.full(BINS, 4.0, np.float32)
    if box:
        ranges[75:105] = 2.0
    sure = np.ones(BINS, np.float32)
    samples = np.full(BINS, 7, np.uint16)
    status, last_seen_ns = np.full(BINS, Status.MEASURED, np.uint8), np.full(BINS, stamp_ns)
    return Estimate(node, level, stamp_ns, ranges, sure, sure, samples, status, last_seen_ns)


def write(
    path: Path,
    boxes,
    nodes=(NODE,),
    *,
    levels=LEVELS,
    map_frame="map",
    radius=10.0,
    ends=(),
    metadata=None,
    report=None,
    changes=NO_CHANGES,
) -> Path:
    """Write a result; `boxes` lists (seconds from START, {level: whether it sees the box}).

    Recordings end at those of these seconds that are in `ends`.
    """
    settings = {"levels": levels, "angle_bins": BINS, "radius": radius, "map_frame": map_frame}
    with ResultWriter(path, **settings) as writer:
        for seconds, seen in boxes:
            stamp_ns = START + seconds * SECOND
            writer.write_nodes(nodes, stamp_ns)
            for node in range(len(nodes)):
                writer.write_estimates(
                    [room(lv, stamp_ns, box=seen[lv], node=node) for lv in levels], stamp_ns
                )
            if seconds in ends:
                latest = {
                    lv: {n: room(lv, stamp_ns, box=seen[lv], node=n) for n in range(len(nodes))}
                    for lv in levels
                }
                writer.write_maps(latest, nodes, stamp_ns)
        writer.finish(
            {"nodes": str(len(nodes))} | (metadata or {}), "seed: 0\n", report or NO_REPORT, changes
        )
    return path


def all_levels(box: bool):
    return dict.fromkeys(LEVELS, box)


def written(path: Path) -> Path:
    """The box appears after 20 s; short and mid adopt it, long does not."""
    return write(
        path,
        [(0, all_levels(False)), (10, all_levels(False)), (20, {"short": True, "mid": True, "long": False})],
    )
