"""How many half-lives of a level went by at a node between two stamps."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import numpy.typing as npt
from rosbags.highlevel import AnyReader
from ruamel.yaml import YAML

from benchmarks.changes.worlds.patrols import SCANNER, Patrol
from timemap_cli.model.gate import Gate, passing
from timemap_cli.results.reader import ResultReader
from timemap_cli.spans import Span

_LONGEST_STEP_S = 10.0  # of observed time between two scans of a node

Stamps = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Pace:
    """How a level counts: its half-life, and by node the stamps (k,) of the scans it was offered.

    What a level shows is known only when a node is estimated: `estimated` holds, by node, the stamps (e,) of the
    newest scans of its estimates.
    """

    half_life: Span
    offered: Mapping[int, Stamps]
    estimated: Mapping[int, Stamps]

    def half_lives(self, nodes: Sequence[int], since_ns: int, until_ns: int) -> float:
        """Half-lives that went by between two stamps, both included: the median over the nodes."""
        return median(self._of_node(node, since_ns, until_ns) for node in nodes)

    def half_lives_before(self, nodes: Sequence[int], since_ns: int, until_ns: int) -> float:
        """The same up to each node's estimate before that which was the newest at `until_ns`."""
        return median(self._of_node(node, since_ns, self._before(node, until_ns)) for node in nodes)

    def _before(self, node: int, until_ns: int) -> int:
        stamps = self.estimated.get(node, np.zeros(0, np.int64))
        earlier = stamps[stamps <= until_ns][:-1]
        return int(earlier[-1]) if len(earlier) else -1

    def _of_node(self, node: int, since_ns: int, until_ns: int) -> float:
        stamps = self.offered.get(node, np.zeros(0, np.int64))
        inside = stamps[(stamps >= since_ns) & (stamps <= until_ns)]
        if self.half_life.unit == "obs":
            return len(inside) / self.half_life.value
        steps = np.minimum(np.diff(inside) / 1e9, _LONGEST_STEP_S)
        return float(steps.sum()) / self.half_life.value


def paces(result: Path, patrols: Sequence[Patrol]) -> dict[str, Pace]:
    """Each level's pace in a result of these patrols, from where the laser really was."""
    with ResultReader(result) as reader:
        nodes, settings = [(node.x, node.y) for node in reader.nodes], reader.config
    values = YAML(typ="safe", pure=True).load(settings)
    offered = offered_scans(patrols, nodes, values)
    return {
        level["name"]: Pace(
            Span.parse(level["half_life"]),
            offered[0 if i == 0 else 1],
            estimate_stamps(result, level["name"]),
        )
        for i, level in enumerate(values["levels"])
    }


def offered_scans(
    patrols: Sequence[Patrol], nodes: Sequence[tuple[float, float]], settings: Mapping[str, Any]
) -> tuple[dict[int, Stamps], dict[int, Stamps]]:
    """Stamps of the scans that the fastest level, and that the slower levels are offered, by node."""
    gate = Gate(
        settings["gate"]["min_travel"],
        float(np.deg2rad(settings["gate"]["min_turn_deg"])),
        round(Span.parse(str(settings["gate"]["min_interval"])).value * 1e9),
    )
    stamps, places = _scans(patrols)
    nearest = _nearest(places[:, :2], np.array(nodes), settings["map"]["node_spacing"])
    passed = passing(gate, nearest.tolist(), places, stamps, {})
    every = {node: stamps[nearest == node] for node in range(len(nodes))}
    gated = {node: stamps[(nearest == node) & passed] for node in range(len(nodes))}
    return every, gated


def estimate_stamps(result: Path, level: str) -> dict[int, Stamps]:
    """Stamps (e,) of the newest scans of a level's estimates, by node, in the order in which they were made."""
    found: dict[int, list[int]] = {}
    with AnyReader([result]) as reader:
        scans = [c for c in reader.connections if c.topic == f"/timemap/{level}/scan"]
        for connection, _, raw in reader.messages(connections=scans):
            message: Any = reader.deserialize(raw, connection.msgtype)
            header = message.header
            node = int(header.frame_id.rpartition("_")[2])
            found.setdefault(node, []).append(header.stamp.sec * 10**9 + header.stamp.nanosec)
    return {node: np.unique(stamps) for node, stamps in found.items()}


def _scans(patrols: Sequence[Patrol]) -> tuple[Stamps, npt.NDArray[np.float64]]:
    """Stamps (n,) of all scans, and the laser's x [m], y [m] and yaw [rad] (n, 3)."""
    stamps, places = [], []
    for patrol in patrols:
        drive = patrol.drive()
        times = np.arange(0.3, drive.motion.duration - 0.3, SCANNER.period)
        poses = drive.motion.at(times)
        forward = np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
        poses[:, :2] += SCANNER.mount.x * forward
        stamps.append(drive.start_ns + np.round(times * 1e9).astype(np.int64))
        places.append(poses)
    return np.concatenate(stamps), np.concatenate(places)


def _nearest(
    places: npt.NDArray[np.float64], nodes: npt.NDArray[np.float64], spacing: float
) -> npt.NDArray[np.int64]:
    """Number (n,) of the nearest node, -1 where none is within the spacing."""
    away = np.linalg.norm(places[:, None] - nodes[None], axis=-1)
    return np.where(away.min(1) <= spacing, away.argmin(1), -1)
