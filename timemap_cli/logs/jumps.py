"""Jumps of a pose between neighbouring transforms: what lies between them was interpolated and is nowhere."""

import numpy as np

from timemap_cli.logs.batches import Float64s, Int64s
from timemap_cli.logs.transforms import TransformBuffer

ARM_M = 2.0  # a turn counts as it moves what stands so far away
SPEED, TURN_RATE = 3.0, 6.3  # [m/s], [rad/s] what no robot indoors exceeds


def jumps(buffer: TransformBuffer, target: str, source: str, first_ns: Int64s, last_ns: Int64s) -> Float64s:
    """How far (n,) [m] `source` jumps in `target` between the transforms that enclose the times from first to last.

    The largest over the moving edges of the chain. An edge to an odometry frame (map -> odom) should stand still: its
    change counts where it puts the source, at the first time. Any other edge carries the robot: only what it moves
    faster than a robot can counts. 0 where the times are those of transforms.
    """
    found = np.zeros(len(first_ns))
    for child in buffer.moving_edges(target, source, first_ns):
        older_ns, newer_ns = buffer.around(child, first_ns, last_ns)
        _, older = buffer.edge(child, older_ns)
        _, newer = buffer.edge(child, newer_ns)
        rows = np.flatnonzero((older != newer).any(axis=(1, 2)))
        seconds = (newer_ns - older_ns)[rows] / 1e9
        if "odom" in child:
            older, _ = buffer.lookup(target, source, first_ns[rows], {child: older_ns[rows]})
            newer, _ = buffer.lookup(target, source, first_ns[rows], {child: newer_ns[rows]})
            found[rows] = np.fmax(found[rows], _moved(older, newer))
        else:
            excess = _moved(older[rows], newer[rows], seconds)
            found[rows] = np.fmax(found[rows], excess)
    return found


def _moved(older: Float64s, newer: Float64s, seconds: Float64s | float = 0.0) -> Float64s:
    """How far (n,) [m] a pose (n, 3, 4) moves in the plane, and by its turn, beyond what a robot moves in so long."""
    step = newer - older
    way = np.sqrt(step[:, 0, 3] ** 2 + step[:, 1, 3] ** 2)
    turn = np.sqrt(
        (step[:, :, :3] ** 2).sum(axis=(1, 2)) / 2
    )  # 2 sin(angle / 2): by how much a point at 1 m moves
    moved: Float64s = np.maximum(way - SPEED * seconds, 0) + ARM_M * np.maximum(turn - TURN_RATE * seconds, 0)
    return moved
