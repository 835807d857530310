"""Real recordings as the model sees them, and what each definition makes of them from scan to scan."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import Definition
from timemap_cli import assembly
from timemap_cli.config import Settings
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.stream import ScanCounts, sweeps
from timemap_cli.logs.survey import survey
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.model.virtual_scan import UNSEEN, Bools, Ranges

Ints = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Recorded:
    """What the scans of recordings say of their nodes, in stamp order."""

    nodes: Ints  # (n,) number of the node
    stamps_ns: Ints  # (n,)
    ranges: Ranges  # (n, angle_bins) virtual scans [mm]
    passes: Bools  # (n,) slower levels may take it
    places: Sequence[Node]


@dataclass(frozen=True, slots=True)
class Followed:
    """One node: its scans that were offered to a level, and the estimates after each of them."""

    stamps_ns: Ints  # (k,)
    ranges: Ranges  # (k, angle_bins) [mm]
    estimates: Mapping[str, Ranges]  # by definition (k, angle_bins) [mm]


def recorded(logs: Sequence[Path], settings: Settings) -> Recorded:
    """Read recordings as a replay with these settings would."""
    with ExitStack() as stack:
        recordings = [stack.enter_context(recording) for recording in open_recordings(logs)]
        plan = survey(recordings, settings)
        observer = assembly.observer(settings, ())
        blocks = sweeps(recordings, plan.selection, plan.beams, ScanCounts(), start_ns=None, end_ns=None)
        seen = [observer.observe(block) for block in blocks if isinstance(block, Sweeps)]
    return Recorded(
        np.concatenate([part.nodes for part in seen]),
        np.concatenate([part.stamps_ns for part in seen]),
        np.concatenate([part.ranges for part in seen]),
        np.concatenate([part.passes for part in seen]),
        observer.nodes,
    )


def followed(
    scans: Recorded, level: Level, definitions: Mapping[str, Definition], *, gated: bool
) -> list[Followed]:
    """Let each node learn its scans, with an estimate after each; `gated`: only scans that passed the gate."""
    angle_bins = scans.ranges.shape[1]
    offered = scans.passes if gated else np.ones(len(scans.nodes), np.bool_)
    memory = Memory(level, angle_bins, seed=0)
    memory.add_nodes(scans.places)
    found = []
    for node in range(len(scans.places)):
        rows = np.flatnonzero(offered & (scans.nodes == node))
        made: dict[str, Ranges] = {
            name: np.full((len(rows), angle_bins), UNSEEN, np.uint16) for name in definitions
        }
        for i, row in enumerate(rows.tolist()):
            one = slice(row, row + 1)
            changed = memory.remember(scans.nodes[one], scans.stamps_ns[one], scans.ranges[one])
            remembered = memory.recall(scans.nodes[one]) if len(changed) else None
            for name, estimates in made.items():
                estimates[i] = estimates[i - 1] if remembered is None else definitions[name](remembered)[0]
        found.append(Followed(scans.stamps_ns[rows], scans.ranges[rows], made))
    return found
