"""Several nodes that learn at one level, and what each definition of the estimate makes of the same memory."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import Definition
from benchmarks.paper.rivals import Rival
from benchmarks.paper.scene import ANGLE_BINS
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Ranges

EVERY = 10  # scans from estimate to estimate

MID = Level("mid", 50, 35.0)  # takes every scan
LONG = Level("long", 100, 277.0)  # takes one in four


def old_history(level: Level) -> int:
    """Scans after which a level is old: five half-lives, and long full."""
    return round(5 * level.half_life) + level.window


class Watched:
    """Nodes of one level. They differ in their random numbers, so that each is a run of its own."""

    def __init__(
        self,
        level: Level,
        nodes: int,
        definitions: Mapping[str, Definition],
        rivals: Mapping[str, Rival] | None = None,
        *,
        angle_bins: int = ANGLE_BINS,
    ) -> None:
        self._memory = Memory(level, angle_bins, seed=0)
        self._memory.add_nodes([Node(float(n), 0.0) for n in range(nodes)])
        self._nodes = np.arange(nodes)
        self._definitions = definitions
        self._rivals = rivals or {}
        self._scans = 0

    def learn(self, scans: Ranges) -> None:
        """Show n scans (n, nodes, angle_bins) [mm], each node its own, without an estimate."""
        n, nodes, angle_bins = scans.shape
        stamps = np.repeat(self._scans + np.arange(n, dtype=np.int64), nodes) * 100_000_000
        self._memory.remember(np.tile(self._nodes, n), stamps, scans.reshape(-1, angle_bins))
        self._scans += n
        for rival in self._rivals.values():
            rival.learn(scans)

    def estimates(self) -> dict[str, Floats]:
        """What each definition and rival holds (nodes, angle_bins) [m]; inf clear, NaN unknown."""
        memory = self._memory.recall(self._nodes)
        found = {name: metres(estimate(memory)) for name, estimate in self._definitions.items()}
        return found | {name: metres(rival.ranges()) for name, rival in self._rivals.items()}

    def follow(self, scans: Ranges, every: int = EVERY) -> dict[str, Floats]:
        """Show scans, with an estimate after each `every` of them: (estimates, nodes, angle_bins) [m]."""
        rounds = []
        for start in range(0, len(scans) - every + 1, every):
            self.learn(scans[start : start + every])
            rounds.append(self.estimates())
        return {name: np.stack([found[name] for found in rounds]) for name in rounds[0]}


def drawn(pool: Ranges, n: int, nodes: int, random: np.random.Generator) -> Ranges:
    """N scans for each node (n, nodes, angle_bins), drawn from a pool (scans, angle_bins) of a still world."""
    return pool[random.integers(0, len(pool), (n, nodes))]


def metres(ranges: npt.NDArray[np.integer]) -> Floats:
    """Ranges in metres from whole millimetres: inf for CLEAR, NaN for UNSEEN."""
    found = ranges / 1000.0
    found[ranges == CLEAR] = np.inf
    found[ranges == UNSEEN] = np.nan
    return np.asarray(found, np.float64)
