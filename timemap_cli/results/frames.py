"""Names of the nodes' frames: `timemap/node_0007` stands at node 7, its axes along the map's."""

import re

_FRAME = re.compile(r"timemap/node_(\d{4,})")


def node_frame(node: int) -> str:
    """Frame of a node."""
    return f"timemap/node_{node:04d}"


def node_of_frame(frame: str) -> int:
    """Node of a frame; ValueError for a frame of anything else."""
    found = _FRAME.fullmatch(frame)
    if not found:
        raise ValueError(f"frame '{frame}' is no node's")
    return int(found[1])
