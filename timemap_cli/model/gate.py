"""Which scans of a node the slower levels may take: standing still is not evidence, over and over."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.elementary import distance


@dataclass(frozen=True, slots=True)
class Gate:
    """A scan passes when the robot has moved or turned enough since the last that passed, and the time has gone by.

    A zero leaves its criterion out; with all three zero every scan passes.
    """

    min_travel: float  # [m]
    min_turn: float  # [rad]
    min_interval_ns: int


@dataclass(frozen=True, slots=True)
class Passage:
    """Where and when the last scan of one scanner passed the gate of a node."""

    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad]
    stamp_ns: int


Passages = dict[tuple[int, int], Passage]  # by node and scanner


def passing(
    gate: Gate,
    nodes: Sequence[int],
    places: npt.NDArray[np.float64],
    stamps_ns: npt.NDArray[np.int64],
    last: Passages,
    scanner: int = 0,
) -> npt.NDArray[np.bool_]:
    """Which of n scans pass, each judged against its own node's last; `last` is brought up to date.

    `places` is (n, 3): x, y [m, map frame] and yaw [rad] of the laser. Scanners are judged each by itself: they sit
    at different places of the robot. A decision needs the one before it, so this is a plain loop over scans.
    """
    passes = np.ones(len(nodes), np.bool_)
    if not (gate.min_travel or gate.min_turn or gate.min_interval_ns):
        return passes
    rows = zip(nodes, places.tolist(), stamps_ns.tolist(), strict=True)
    for i, (node, (x, y, yaw), stamp_ns) in enumerate(rows):
        before = last.get((node, scanner))
        if before is None or _far_enough(gate, before, x, y, yaw, stamp_ns):
            last[node, scanner] = Passage(x, y, yaw, stamp_ns)
        else:
            passes[i] = False
    return passes


def _far_enough(gate: Gate, before: Passage, x: float, y: float, yaw: float, stamp_ns: int) -> bool:
    if (
        0 <= stamp_ns - before.stamp_ns < gate.min_interval_ns
    ):  # before 0: another recording, whose clock began anew
        return False
    if not (gate.min_travel or gate.min_turn):
        return True
    travelled = distance(x - before.x, y - before.y)
    turned = abs(math.remainder(yaw - before.yaw, math.tau))
    return 0 < gate.min_travel <= travelled or 0 < gate.min_turn <= turned
