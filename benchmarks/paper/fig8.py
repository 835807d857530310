"""Fig. 8, localisation jumps: a part of the scans comes from a robot that believes itself elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.paper.definitions import chosen
from benchmarks.paper.metrics import Change, apart, error, half_and_half, shows_new
from benchmarks.paper.rooms import OFFICE
from benchmarks.paper.scene import look, truth
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.watched import LONG, MID, Watched, old_history
from benchmarks.paper.words import number, percent
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

SHARES = (0.1, 0.4, 0.6)
_ONE_STATE = 0.15  # [m] surfaces closer than this are one state, of which no estimate can be half
ERROR = (0.19, 0.19, np.deg2rad(15.0))  # 0.27 m aside and turned
_NAMES = ("ours", "profile: paper", "eq. 4 (row sums)", "caption, states from data", "vote without pairs",
          "median per angle bin")  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Outcome:
    error: float  # [m] mean over estimates and angle bins
    flipped: float  # share of the estimates that show the wrong world
    mixed: float  # share of the estimates that are half true, half wrong
    last: Floats  # (angle_bins,) the last estimate of the first node


Outcomes = dict[tuple[str, float], dict[str, _Outcome]]  # by level and share of wrong poses


def run(scale: Scale) -> Section:
    """10, 40 and 60 % of the scans at a pose that is wrong by 0.27 m and 15 degrees, always the same way."""
    nodes, levels = scale.pick(10, 3), scale.pick((MID, LONG), (MID,))
    names = scale.pick(_NAMES, _NAMES[:1])
    found = {
        (level.name, part): measured(level, part, nodes, names) for level, part in product(levels, SHARES)
    }
    header = ("", *(f"{level}, {part:.0%}: error [m] / flipped / half-and-half" for level, part in found))
    rows = [
        (
            name,
            *(
                f"{number(one[name].error, 3)} / {percent(one[name].flipped)} / {percent(one[name].mixed)}"
                for one in found.values()
            ),
        )
        for name in names
    ]
    return Section(
        "Fig. 8: localisation jumps",
        (
            "10, 40 and 60 % of the scans, chosen by chance, come from a robot that believes itself 0.27 m aside and "
            "turned by 15°, always the same way, so that the wrong scans agree among themselves; no guard sorts them "
            "out. Measured over two half-lives once this has gone on for five: the mean error of an angle bin, the "
            "share of the estimates that show the wrong world (*flipped*: more than half of the angle bins that tell "
            f"the worlds apart), and of those in which surfaces more than {_ONE_STATE} m apart are half and half.",
            "At 40 % a window of 50 holds more wrong scans than right ones now and then, by chance, and the whole "
            "scan, or a whole surface, follows; that is what there is of error beyond the noise. At 60 % the wrong "
            f"world is what the memory holds, and all that can be asked is consistency. {nodes} runs.",
        ),
        (Table(header, rows),),
        (
            Figure(
                "fig8", "Estimates of the mid level with 40 % wrong poses.", partial(_draw, found["mid", 0.4])
            ),
        ),
        {
            f"{level} {part} {what}": getattr(one["ours"], what)
            for (level, part), one in found.items()
            for what in ("error", "flipped", "mixed")
        },
    )


def measured(level: Level, part: float, nodes: int, names: Sequence[str]) -> dict[str, _Outcome]:
    """Estimates of all definitions over two half-lives, after five."""
    random = np.random.default_rng(8)
    right = look(OFFICE, 400, random)
    wrong = right.misplaced(np.ones(400, np.bool_), ERROR)
    pool = np.stack((right.virtual(), wrong.virtual()))
    watched = Watched(level, nodes, chosen(*names))
    rounds = []
    for scans in (old_history(level), round(2 * level.half_life)):
        lost = random.random((scans, nodes)) < part
        rounds.append(pool[lost.astype(np.int64), random.integers(0, 400, (scans, nodes))])
    watched.learn(rounds[0])
    change = Change.between(OFFICE, _misplaced(OFFICE))
    return {name: _outcome(seen, change) for name, seen in watched.follow(rounds[1]).items()}


def _misplaced(segments: Floats) -> Floats:
    """The world as a lost robot believes it to be."""
    x, y, yaw = ERROR
    ends = segments.reshape(-1, 2)
    along, across = (np.cos(yaw), np.sin(yaw)), (-np.sin(yaw), np.cos(yaw))
    moved = ends[:, :1] * along + ends[:, 1:] * across + (x, y)
    return np.asarray(moved.reshape(-1, 4))


def _outcome(seen: Floats, change: Change) -> _Outcome:
    wrong = shows_new(seen, change)[..., change.changed].mean(axis=2)
    far = change.changed & (apart(change.old, change.new) > _ONE_STATE)
    return _Outcome(
        float(error(seen, change.old, change.even).mean()),
        float((wrong > 0.5).mean()),
        float(half_and_half(seen, replace(change, changed=far)).mean()),
        seen[-1, 0],
    )


def _draw(found: dict[str, _Outcome], canvas: "Canvas") -> None:
    names = ("ours", "profile: paper", "eq. 4 (row sums)", "median per angle bin")
    true = truth(OFFICE)
    bearings = (np.arange(len(true)) + 0.5) * (2 * np.pi / len(true))
    for axes, name in zip(canvas.subplots(1, len(names)), names, strict=True):
        for ranges, colour, width in ((true, "0.8", 3.0), (found[name].last, "#c1440e", 1.5)):
            x, y = ranges * np.cos(bearings), ranges * np.sin(bearings)
            gap = np.full(len(x), np.nan)
            dots = (np.column_stack(ends).ravel() for ends in ((x, x + 0.01, gap), (y, y, gap)))
            axes.plot(*dots, color=colour, linewidth=width, solid_capstyle="round")  # a marker each is 300 kB
        axes.set_title(name, fontsize=8)
        axes.set(aspect="equal", xlim=(-2.4, 3.2), ylim=(-2.4, 2.8))
        axes.set_axis_off()
