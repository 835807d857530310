"""A small result that a page is made of: a box that appears after 20 s, and a thing that came and went."""

import json
from pathlib import Path

from tests.cli.result_files import NODE, SECOND, START, all_levels, write
from timemap_cli.model.nodes import Node

NODES = (NODE, Node(14.5, 2.0))
HOSTILE = '</script><img src=x onerror="document.title=1">.mcap'
REPORT = {
    "schema": "timemap.report/1",
    "nodes": 2,
    "scans": {"read": 40, "used": 37, "dropped": {"no_pose": 2, "lost": 1}},
}
INPUTS = [{"name": HOSTILE, "sha256": "0123abcd"}]


def at(seconds: int) -> str:
    """A time of the result as documents have it."""
    return str(START + seconds * SECOND)


def event(number: int, kind: str, x: float, y: float, **more):
    """An event 0.4 m wide, as in a document of the schema timemap.changes/1."""
    outline = [[x - 0.2, y - 0.2], [x + 0.2, y - 0.2], [x + 0.2, y + 0.2], [x - 0.2, y + 0.2]]
    return {
        "id": number,
        "kind": kind,
        "x": x,
        "y": y,
        "bounds": [x - 0.2, y - 0.2, x + 0.2, y + 0.2],
        "outline": outline,
        "moved_from": None,
        "first_seen_ns": at(20),
        "last_seen_ns": at(20),
        "looked_ns": at(20),
        "not_seen_since": False,
        "closed_ns": None,
        "adopted": {"short": at(20), "mid": at(20), "long": None},
        "nodes": [0],
        "against": [],
        "support": 0.75,
        "recurring": False,
        "toggles": 0,
        "looks": 3,
        "share_held": 1.0,
        "episodes": [{"since_ns": at(20), "until_ns": None}],
    } | more


APPEARED = event(3, "appeared", 1.0, 4.0)
GONE_AGAIN = event(
    7,
    "vanished",
    14.5,
    -2.0,
    first_seen_ns=at(0),
    closed_ns=at(10),
    nodes=[],
    against=[1],
    share_held=0.5,
    episodes=[{"since_ns": at(0), "until_ns": at(10)}],
)
CHANGES = {
    "schema": "timemap.changes/1",
    "events": [APPEARED, GONE_AGAIN],
    "summary": {"events": 2, "open": 1, "recurring": 0, "toggles": 1},
}


def write_page_result(path: Path) -> Path:
    """Two nodes, estimated at 0, 10 and 20 s; short and mid see the box from 20 s on."""
    seen = [
        (0, all_levels(False)),
        (10, all_levels(False)),
        (20, {"short": True, "mid": True, "long": False}),
    ]
    return write(path, seen, NODES, metadata={"inputs": json.dumps(INPUTS)}, report=REPORT, changes=CHANGES)
