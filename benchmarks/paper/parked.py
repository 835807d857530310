"""A robot parked for a night beside something that will be gone in the morning: what the gate is for."""

import numpy as np

from benchmarks.paper.definitions import STATE_WIDTH
from benchmarks.paper.metrics import Change, error, shows_new
from benchmarks.paper.rooms import OFFICE, with_boxes
from benchmarks.paper.scene import ANGLE_BINS, PERIOD_NS, RADIUS, Scans, look
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.watched import metres
from benchmarks.paper.words import number, percent
from sample_logs.rays import Floats
from timemap_cli.model.estimator import estimate
from timemap_cli.model.gate import Gate
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observer

NODE = Node(0.0, 0.0)
TROLLEY = (1.1, 0.4, 0.6, 0.5, 15.0)
GATES = {
    "gate (0.05 m or 5°, 0.15 s)": Gate(0.05, np.deg2rad(5.0), 150_000_000),
    "no gate": Gate(0.0, 0.0, 0),
}
LEVELS = (Level("mid", 25, 20.0), Level("long", 100, 200.0))  # the program's defaults
_DAY, _SCANS_AT_ONCE = 1500, 300


def run(scale: Scale) -> Section:
    """A day of turning about, a night on one spot with a trolley before the laser, a few looks in the morning."""
    hours = scale.pick(8.0, 0.1)
    found = {name: measured(gate, hours) for name, gate in GATES.items()}
    rows = [
        (name, str(taken), *(f"{percent(shown)} / {number(wrong, 3)}" for shown, wrong in levels.values()))
        for name, (taken, levels) in found.items()
    ]
    header = (
        "",
        "scans of the night that passed",
        *(f"{level.name}: trolley shown / error [m]" for level in LEVELS),
    )
    return Section(
        "A robot parked for a night",
        (
            f"A day of {_DAY:,} scans on the move, then a night of 8 hours at 5 Hz on one spot, with a trolley 1 "
            "m before the laser that came after the robot had parked and is gone in "
            "the morning. What the default levels hold at the end of the night: share of the trolley's angle "
            "bins that show it, and the error against the room without it. The "
            "short level takes every scan and shows the trolley, as it should. The night's scans are 300 "
            "different ones, over and over.",
        ),
        (Table(header, rows),),
        (),
        {
            f"{gate} {level}": shown
            for gate, (_, levels) in zip(("gate", "none"), found.values(), strict=True)
            for level, (shown, _) in levels.items()
        },
    )


def measured(gate: Gate, hours: float) -> tuple[int, dict[str, tuple[float, float]]]:
    """How many of the night's scans passed the gate; by level the share of the trolley shown, and the error [m]."""
    random = np.random.default_rng(12)
    observer = Observer(gate, angle_bins=ANGLE_BINS, radius=RADIUS, spacing=1.0, nodes=[NODE])
    memories = [Memory(level, ANGLE_BINS, 0) for level in LEVELS]
    for memory in memories:
        memory.add_nodes([NODE])
    with_trolley = with_boxes(OFFICE, TROLLEY)
    day = look(OFFICE, _DAY, random)
    night = look(with_trolley, _SCANS_AT_ONCE, random, at=_parked(random))
    _learn(observer, memories, day, 0)
    passed, scans = 0, round(hours * 3600e9 / PERIOD_NS)
    for start in range(0, scans, _SCANS_AT_ONCE):
        passed += _learn(observer, memories, night, _DAY + start)
    change = Change.between(OFFICE, with_trolley)
    return passed, {memory.level.name: _held(memory, change) for memory in memories}


def _parked(random: np.random.Generator) -> Floats:
    """Poses of a parked robot: its localisation trembles by 5 mm and 0.2 degrees."""
    return np.array([0.1, -0.1, 0.4]) + random.normal(0, (0.005, 0.005, 0.0035), (_SCANS_AT_ONCE, 3))


def _learn(observer: Observer, memories: list[Memory], scans: Scans, first: int) -> int:
    seen = observer.observe(scans.sweeps(first))
    for memory in memories:
        memory.remember(seen.nodes[seen.passes], seen.stamps_ns[seen.passes], seen.ranges[seen.passes])
    return int(seen.passes.sum())


def _held(memory: Memory, change: Change) -> tuple[float, float]:
    seen = metres(estimate(memory.recall(np.array([0])), STATE_WIDTH).ranges)
    shown = shows_new(seen, change)[..., change.changed].mean()
    return float(shown), float(error(seen, change.old, change.even).mean())
