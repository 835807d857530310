"""A removed obstacle: before a wall farther away, and before open space."""

from collections.abc import Mapping

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, Definition, chosen
from benchmarks.paper.metrics import Change
from benchmarks.paper.rivals import rivals
from benchmarks.paper.rooms import OPEN_OFFICE, with_boxes
from benchmarks.paper.scene import ROUND_ROOM, look
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.trial import Outcome, Trial
from benchmarks.paper.watched import LONG, MID
from benchmarks.paper.words import scans
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level

WORLDS = {
    "wall": (ROUND_ROOM, (0.95, 0.2, 0.4, 0.5, 20.0)),
    "open space": (OPEN_OFFICE, (1.8, 0.2, 0.5, 0.8, 10.0)),
}


def run(scale: Scale) -> Section:
    """A box that stood for five half-lives is taken away."""
    nodes, levels = scale.pick(10, 2), scale.pick((MID, LONG), (MID,))
    definitions = scale.pick(DEFINITIONS, chosen("ours"))
    found = {
        (level.name, behind): measured(level, *WORLDS[behind], nodes, definitions, others=scale is Scale.full)
        for level in levels
        for behind in WORLDS
    }
    header = ("", *(f"{level}, before {behind}: delay / half-and-half" for level, behind in found))
    rows = [
        (name, *(f"{scans(one[name].delay)} / {scans(one[name].mixed)}" for one in found.values()))
        for name in next(iter(found.values()))
    ]
    return Section(
        "A removed obstacle",
        (
            "A box that a level has known for five half-lives is taken away; behind it there is a wall, or "
            "nothing within the scanner's reach (`+inf`). Delay [scans] until 90 % of "
            f"its angle bins show what is behind, and for how many scans it is half there. {nodes} runs; right is "
            "the half-life, 35 and 277.",
        ),
        (Table(header, rows),),
        (),
        {
            f"{level} {behind} {what}": getattr(one["ours"], what)
            for (level, behind), one in found.items()
            for what in ("delay", "slowest", "mixed")
        },
    )


def measured(
    level: Level,
    world: Floats,
    thing: tuple[float, float, float, float, float],
    nodes: int,
    definitions: Mapping[str, Definition],
    *,
    others: bool,
) -> dict[str, Outcome]:
    """What becomes of the box at one level, for each definition."""
    random = np.random.default_rng(9)
    before = with_boxes(world, thing)
    trial = Trial(
        look(before, 400, random).virtual(), look(world, 400, random).virtual(), Change.between(before, world)
    )
    seen = trial.estimates(level, nodes, random, definitions, rivals(nodes, 4.0) if others else {})
    return {name: trial.outcome(estimates) for name, estimates in seen.items()}
