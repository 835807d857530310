"""Fig. 6, convergence: a box appears in a round room and stays, and levels follow at their own pace."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, Definition, chosen
from benchmarks.paper.metrics import Change
from benchmarks.paper.rivals import rivals
from benchmarks.paper.scene import ROUND_ROOM, look
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.trial import Outcome, Trial
from benchmarks.paper.watched import EVERY, LONG, MID
from benchmarks.paper.words import number, scans
from sample_logs.world import box, outline_segments
from timemap_cli.model.levels import Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

BOX = outline_segments(box(0.95, 0.2, 0.4, 0.5, 20.0))
_SHOWN = ("ours", "profile: paper", "eq. 4 (row sums)", "median per angle bin")


def run(scale: Scale) -> Section:
    """A box of 0.4 m by 0.5 m, 1 m from the node, in a round room of 3 m."""
    nodes = scale.pick(10, 2)
    definitions = scale.pick(DEFINITIONS, chosen("ours", "median per angle bin"))
    found = {
        level.name: measured(level, nodes, definitions, others=scale is Scale.full) for level in (MID, LONG)
    }
    rows = [
        (
            name,
            *(
                cell
                for level in found.values()
                for cell in (scans(level[name].delay), scans(level[name].mixed), number(level[name].error, 3))
            ),
        )
        for name in found["mid"]
    ]
    header = (
        "",
        *(f"{level}: {what}" for level in found for what in ("delay", "half-and-half", "error [m]")),
    )
    return Section(
        "Fig. 6: a box appears and stays",
        (
            "A box appears in a round room of 3 m that a level has known for five half-lives. *Delay*: scans "
            "until 90 % of the changed angle bins show it (right is the "
            "half-life: 35 and 277). *Half-and-half*: for how many scans a run of neighbouring changed angle "
            "bins is more than 10 % old and more than 10 % new. *Error*: at the "
            f"end, mean over the angle bins. Means of {nodes} runs, an estimate every {EVERY} scans. What has no "
            "half-life has the same row twice.",
        ),
        (Table(header, rows),),
        (
            Figure(
                "fig6", "Share of the box that is shown, over scans since it appeared.", partial(_draw, found)
            ),
        ),
        {
            f"{level} {what}": getattr(outcomes["ours"], what)
            for level, outcomes in found.items()
            for what in ("delay", "slowest", "mixed", "error")
        },
    )


def measured(
    level: Level, nodes: int, definitions: Mapping[str, Definition], *, others: bool
) -> dict[str, Outcome]:
    """What becomes of the box at one level, for each definition."""
    random = np.random.default_rng(6)
    world = np.concatenate((ROUND_ROOM, BOX))
    trial = Trial(
        look(ROUND_ROOM, 400, random).virtual(),
        look(world, 400, random).virtual(),
        Change.between(ROUND_ROOM, world),
    )
    seen = trial.estimates(level, nodes, random, definitions, rivals(nodes, 2.0) if others else {})
    return {name: trial.outcome(estimates) for name, estimates in seen.items()}


def _draw(found: dict[str, dict[str, Outcome]], canvas: "Canvas") -> None:
    for axes, (level, outcomes), half_life in zip(
        canvas.subplots(1, 2, sharey=True), found.items(), (MID.half_life, LONG.half_life), strict=True
    ):
        for name in _SHOWN:
            share = outcomes[name].share
            axes.plot(EVERY * np.arange(1, len(share) + 1), share, label=name)
        axes.axvline(half_life, color="0.6", linestyle=":")
        axes.set_title(f"{level} (half-life {half_life:g})")
        axes.set_xlabel("scans since the box appeared")
    canvas.axes[0].set_ylabel("share of the box shown")
    canvas.axes[0].legend()
