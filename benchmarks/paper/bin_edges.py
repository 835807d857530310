"""Does it matter where a surface stands? Old and new in the middle and on the edge of the paper's range bins."""

from collections.abc import Mapping
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, RANGE_BIN
from benchmarks.paper.metrics import Change, shows_new
from benchmarks.paper.scene import look
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.watched import LONG, MID, Watched, drawn, old_history
from benchmarks.paper.words import scans
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_COMPARED = (
    *("ours", "profile: paper", "eq. 4 (row sums)", "caption, states from data"),
    "median per angle bin",
)
_NEAR, _MIDDLE, _WALL = 16, 24, 32  # range bins
_KINDS = {"appearing": (_WALL, _NEAR), "moving": (_NEAR, _MIDDLE), "removed": (_NEAR, _WALL)}
_PLACES = {"middle": 0.5, "edge": 0.0}  # of a range bin
_PAIRS = tuple(product(_PLACES, _PLACES))
_EVERY = {"mid": 2, "long": 15}  # scans from estimate to estimate

_Times = dict[str, dict[tuple[str, str], float]]  # by definition, then by the places of old and new


def run(scale: Scale) -> Section:
    """A curved screen of 60 degrees that appears, moves or is taken away, at the mid and the long level."""
    nodes = scale.pick(6, 3)
    levels = scale.pick((MID, LONG), (MID,))
    kinds = scale.pick(tuple(_KINDS), ("appearing",))
    names = scale.pick(_COMPARED, _COMPARED[:2])
    found = {(level.name, kind): _times(level, kind, nodes, names) for level in levels for kind in kinds}
    rows = [
        (f"{name}, {level} {kind}", *(scans(times[name][pair]) for pair in _PAIRS), _span(times[name]))
        for name in names
        for (level, kind), times in found.items()
    ]
    ratios = [ratio for times in found.values() for ratio in _ratios(times["ours"])]
    others = [ratio for times in found.values() for ratio in _ratios(times["profile: paper"])]
    header = ("", *(f"{old} to {new}" for old, new in _PAIRS), "edge / middle")
    return Section(
        "Range-bin edges: where a surface stands must not matter",
        (
            "A curved screen before a round wall appears, moves farther away, or is taken away; its old "
            "and its new range lie in the middle or on the edge of the paper's range "
            f"bins of {100 * RANGE_BIN:.1f} cm. Scans until half of the changed angle bins show the new "
            "one (right is the half-life: 35 at mid, 277 at long), and the three cases "
            f"with an edge by the one without. Means over {nodes} nodes.",
            f"With states from the data the ratios are {min(ratios):.2f} to {max(ratios):.2f} (bar: 0.9 to "
            "1.1).",
        ),
        (Table(header, rows),),
        (Figure("bin_edges", "Scans until a screen that appears is shown.", partial(_draw, found)),),
        {"least": min(ratios), "most": max(ratios), "paper most": float(np.nanmax(others))},
    )  # fmt: skip


def _times(level: Level, kind: str, nodes: int, names: tuple[str, ...]) -> _Times:
    """Switch times [scans] of each definition, for the four pairs of places; NaN never."""
    found: _Times = {name: {} for name in names}
    old_bin, new_bin = _KINDS[kind]
    for places in _PAIRS:
        old, new = (
            (n + _PLACES[place]) * RANGE_BIN for n, place in zip((old_bin, new_bin), places, strict=True)
        )
        worlds = (_room(old), _room(new)) if kind == "moving" else _with_wall(old, new)
        for name, time in _switch_times(level, *worlds, nodes, names).items():
            found[name][places] = time
    return found


def _with_wall(old: float, new: float) -> tuple[Floats, Floats]:
    """The room before and after a change from one range to another [m], the farther of which is the wall."""
    wall, near = max(old, new), min(old, new)
    with_screen, without = np.concatenate((_arc(wall, 360), _arc(near, 60))), _arc(wall, 360)
    return (with_screen, without) if old < new else (without, with_screen)


def _room(screen: float) -> Floats:
    """A room with a screen at this range [m]."""
    return np.concatenate((_arc((_WALL + 0.5) * RANGE_BIN, 360), _arc(screen, 60)))


def _arc(radius: float, degrees: int) -> Floats:
    """Segments (n, 4) [m] of an arc round the node, from bearing 30.2 degrees on, in steps of 2 degrees."""
    bearings = np.deg2rad(30.2 + np.arange(0, degrees + 1, 2))
    corners = radius * np.column_stack((np.cos(bearings), np.sin(bearings)))
    return np.concatenate((corners[:-1], corners[1:]), axis=1)


def _switch_times(
    level: Level, before: Floats, after: Floats, nodes: int, names: tuple[str, ...]
) -> Mapping[str, float]:
    random = np.random.default_rng(11)
    change = Change.between(before, after)
    pools = [look(world, 300, random).virtual() for world in (before, after)]
    watched = Watched(level, nodes, {name: DEFINITIONS[name] for name in names})
    watched.learn(drawn(pools[0], old_history(level), nodes, random))
    every = _EVERY[level.name]
    estimates = watched.follow(drawn(pools[1], round(2.5 * level.half_life), nodes, random), every)
    return {name: _half_way(seen, change, every) for name, seen in estimates.items()}


def _half_way(estimates: Floats, change: Change, every: int) -> float:
    """Scans until half of the changed angle bins show the new state: mean over nodes; NaN if one never does."""
    done = shows_new(estimates, change)[..., change.changed].mean(axis=2) >= 0.5
    times = np.where(done.any(axis=0), (done.argmax(axis=0) + 1.0) * every, np.nan)
    return float(times.mean())


def _ratios(times: Mapping[tuple[str, str], float]) -> list[float]:
    return [times[pair] / times[_PAIRS[0]] for pair in _PAIRS[1:]]


def _span(times: Mapping[tuple[str, str], float]) -> str:
    ratios = _ratios(times)
    return "never" if np.isnan(ratios).any() else f"{min(ratios):.2f}..{max(ratios):.2f}"


def _draw(found: Mapping[tuple[str, str], _Times], canvas: "Canvas") -> None:
    for axes, (level, kind) in zip(
        canvas.subplots(1, 2, squeeze=False)[0],
        [key for key in found if key[1] == "appearing"] * 2,
        strict=False,
    ):
        for name, times in found[level, kind].items():
            axes.plot(
                [" to\n".join(pair) for pair in _PAIRS], [times[pair] for pair in _PAIRS], "o-", label=name
            )
        axes.set_title(f"{level}: {kind}")
        axes.set_ylabel("scans until it is shown")
    canvas.axes[0].legend(fontsize=7)
