"""Which scans of a node the slower levels may take: standing still is not evidence, over and over."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class Gate:
    """A scan passes when the robot has moved or turned enough since the last that passed, and the time has gone by."""

    min_travel: float  # [m]
    min_turn: float  # [rad]
    min_interval_ns: int


@dataclass(frozen=True, slots=True)
class Passage:
    """Where and when a node's last scan passed the gate."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]
    stamp_ns: int


def passing(
    gate: Gate,
    nodes: Sequence[int],
    places: npt.NDArray[np.float64],
    stamps_ns: npt.NDArray[np.int64],
    last: dict[int, Passage],
) -> npt.NDArray[np.bool_]:
    """Which of n scans pass, each judged against its own node's last; `last` is brought up to date.

    `places` is (n, 3): x, y [m, map frame] and yaw [rad] of the laser. The decision on a scan needs the one
    before it, so this is a plain loop over scans.
    """
    passes = np.ones(len(nodes), np.bool_)
    if not (gate.min_travel or gate.min_turn or gate.min_interval_ns):
        return passes
    for i, (node, (x, y, yaw), stamp) in enumerate(
        zip(nodes, places.tolist(), stamps_ns.tolist(), strict=True)
    ):
        before = last.get(node)
        if before is None or _far_enough(gate, before, x, y, yaw, stamp):
            last[node] = Passage(x, y, yaw, stamp)
        else:
            passes[i] = False
    return passes


def _far_enough(gate: Gate, before: Passage, x: float, y: float, yaw: float, stamp_ns: int) -> bool:
    if stamp_ns - before.stamp_ns < gate.min_interval_ns:
        return False
    turned = abs(math.remainder(yaw - before.yaw, math.tau))
    return math.hypot(x - before.x, y - before.y) >= gate.min_travel or turned >= gate.min_turn
