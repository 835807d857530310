"""How many half-lives of a level went by at a node between two stamps."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np
import numpy.typing as npt
from ruamel.yaml import YAML

from benchmarks.changes.patrols import SCANNER, Patrol
from timemap_cli.model.gate import Gate, passing
from timemap_cli.spans import Span

_LONGEST_STEP_S = 10.0  # of observed time between two scans of a node

Stamps = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Pace:
    """How a level counts: its half-life, and the stamps (k,) of the scans it was offered, by node."""

    half_life: Span
    offered: Mapping[int, Stamps]

    def half_lives(self, nodes: Sequence[int], since_ns: int, until_ns: int) -> float | None:
        """Half-lives that went by between two stamps, both included: the median over the nodes; None: no node."""
        counts = [self._of_node(node, since_ns, until_ns) for node in nodes]
        return median(counts) if counts else None

    def _of_node(self, node: int, since_ns: int, until_ns: int) -> float:
        stamps = self.offered.get(node, np.zeros(0, np.int64))
        inside = stamps[(stamps >= since_ns) & (stamps <= until_ns)]
        if self.half_life.unit == "obs":
            return len(inside) / self.half_life.value
        steps = np.minimum(np.diff(inside) / 1e9, _LONGEST_STEP_S)
        return float(steps.sum()) / self.half_life.value


def paces(patrols: Sequence[Patrol], nodes: Sequence[tuple[float, float]], settings: str) -> dict[str, Pace]:
    """Each level's pace, from where the laser really was; `settings` are those of the replay, as YAML."""
    values = YAML(typ="safe", pure=True).load(settings)
    gate = Gate(
        values["gate"]["min_travel"],
        float(np.deg2rad(values["gate"]["min_turn_deg"])),
        round(Span.parse(str(values["gate"]["min_interval"])).value * 1e9),
    )
    stamps, places = _scans(patrols)
    nearest = _nearest(places[:, :2], np.array(nodes), values["map"]["node_spacing"])
    stamps, places, nearest = stamps[nearest >= 0], places[nearest >= 0], nearest[nearest >= 0]
    passed = passing(gate, nearest.tolist(), places, stamps, {})
    return {
        level["name"]: Pace(
            Span.parse(level["half_life"]),
            {n: stamps[(nearest == n) & (passed if i else True)] for n in range(len(nodes))},
        )
        for i, level in enumerate(values["levels"])
    }


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
