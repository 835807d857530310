"""Fig. 7, the hidden part: an object seen whole a few times, then only its first or its last part.

The object is an arc round the node, so that its parts can be counted in angle bins.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import chosen
from benchmarks.paper.metrics import Change, half_and_half, shows_new
from benchmarks.paper.rooms import arc
from benchmarks.paper.scene import ANGLE_BINS, ROUND_ROOM, look
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.watched import LONG, Watched, drawn, old_history
from benchmarks.paper.words import share
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level
from timemap_cli.model.virtual_scan import Ranges

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

LEVELS = (Level("window 40", 40, 28.0), Level("window 100", 100, 69.6), LONG)
VISIBLE = 20  # angle bins of the object that stay in view
HIDDEN = (10, 20, 40, 90)
VIEWS = (4, 10, 20, 40)  # of the whole object
SIDES = ("first", "last")  # part in view, in the direction of growing bearings
BORDERS = ("fixed", "loose")  # of the view: the same in each scan, or anywhere within 4 angle bins
_NAMES = ("ours", "profile: paper", "caption, states from data", "vote without pairs", "vote without freshness",
          "median per angle bin")  # fmt: skip
_START = 30  # angle bin at which the object begins


@dataclass(frozen=True, slots=True)
class _Case:
    hidden: int
    side: str
    border: str
    views: int


@dataclass(frozen=True, slots=True)
class _Outcome:
    mixed: float  # share of the estimates that show the part in view, in which the object is half and half
    follows: float  # share of the hidden angle bins that show the object at the end
    course: Floats  # (estimates,) the same, over time


Outcomes = dict[str, dict[_Case, _Outcome]]  # by definition


def run(scale: Scale) -> Section:
    """Hidden parts of 10 to 90 angle bins after 4 to 40 full views."""
    hidden, views = scale.pick(HIDDEN, (20,)), scale.pick(VIEWS, (10,))
    cases = [_Case(*case) for case in product(hidden, SIDES, BORDERS, views)]
    found = {level.name: measured(level, cases) for level in scale.pick(LEVELS, LEVELS[:1])}
    return Section(
        "Fig. 7: the hidden part of an object",
        (
            f"An object of {VISIBLE} angle bins in view, and 10 to 90 more that go out of view: it appears in a "
            "room known for five half-lives, is seen whole in 4 to 40 "
            "scans, and then only its first part (in the direction of growing bearings) or its last, for four "
            "half-lives. The border of the view is fixed, or anywhere within 4 "
            "angle bins. *Half-and-half*: of the estimates that show the part in view, the share in which the "
            "object is more than 10 % old and more than 10 % new. *Follows*: "
            "share of the hidden angle bins that show the object at the end. Levels: window 40 and 100, every "
            "scan; long as in Fig. 6, which takes one scan in four: of four full "
            "views one on average, sometimes none, and what was never seen no definition can know.",
        ),
        (_by_definition(found), *(_by_case(name, one["ours"]) for name, one in found.items())),
        (
            Figure(
                "fig7",
                "Share of the hidden angle bins that show the object, over scans since its part went out of view.",
                partial(_draw, found),
            ),
        ),
        {
            f"{level} {side} {size} {what}": float(
                np.nanmean(
                    [
                        getattr(o, what)
                        for case, o in one["ours"].items()
                        if (case.side, case.hidden) == (side, size)
                    ]
                )
            )
            for level, one in found.items()
            for side, size, what in product(SIDES, hidden, ("mixed", "follows"))
        }
        | {
            f"{level} median {side} mixed": _mean(_compared(one["median per angle bin"], side), "mixed")
            for level, one in found.items()
            for side in SIDES
        },
    )


def measured(level: Level, cases: Sequence[_Case]) -> Outcomes:
    """All cases at one level; each is a node."""
    random = np.random.default_rng(7)
    every = 10 if level.half_life < 100 else 30
    old = look(ROUND_ROOM, 300, random).virtual()
    whole = {hidden: look(_with_object(hidden), 120, random) for hidden in sorted({c.hidden for c in cases})}
    full = {hidden: scans.virtual() for hidden, scans in whole.items()}
    pools = {
        key: whole[key[0]].hiding(_hidden(*key, 120, random)).virtual()
        for key in sorted({(c.hidden, c.side, c.border) for c in cases})
    }
    watched = Watched(level, len(cases), chosen(*_NAMES))
    watched.learn(drawn(old, old_history(level) - max(VIEWS), len(cases), random))
    watched.learn(_views(old, full, cases, random))
    scans = round(4 * level.half_life / every) * every
    part = np.stack(
        [pools[c.hidden, c.side, c.border][random.integers(0, 120, scans)] for c in cases], axis=1
    )
    return {name: _outcomes(seen, cases) for name, seen in watched.follow(part, every).items()}


def _with_object(hidden: int) -> Floats:
    """The room and an object 1 m from the node."""
    return np.concatenate((ROUND_ROOM, arc(_START, _START + VISIBLE + hidden)))


def _hidden(
    hidden: int, side: str, border: str, scans: int, random: np.random.Generator
) -> npt.NDArray[np.bool_]:
    """Angle bins (scans, ANGLE_BINS) out of view: those of the hidden part, and 3 beyond the object's end."""
    slack = random.integers(-2, 3, (scans, 1)) if border == "loose" else np.zeros((scans, 1), np.int64)
    place = np.arange(ANGLE_BINS)
    if side == "first":
        return (place >= _START + VISIBLE + slack) & (place < _START + VISIBLE + hidden + 3)
    return (place >= _START - 3) & (place < _START + hidden + slack)


def _views(
    old: Ranges, full: dict[int, Ranges], cases: Sequence[_Case], random: np.random.Generator
) -> Ranges:
    """The last scans before the object goes out of view: of the old room first, then of the whole object."""
    found = drawn(old, max(VIEWS), len(cases), random)
    for node, case in enumerate(cases):
        pool = full[case.hidden]
        found[max(VIEWS) - case.views :, node] = pool[random.integers(0, len(pool), case.views)]
    return found


def _outcomes(seen: Floats, cases: Sequence[_Case]) -> dict[_Case, _Outcome]:
    changes = {
        hidden: Change.between(ROUND_ROOM, _with_object(hidden)) for hidden in {c.hidden for c in cases}
    }
    return {case: _outcome(seen[:, node], case, changes[case.hidden]) for node, case in enumerate(cases)}


def _outcome(seen: Floats, case: _Case, change: Change) -> _Outcome:
    hidden = change.changed & _hidden(case.hidden, case.side, "fixed", 1, np.random.default_rng(0))[0]
    new = shows_new(seen, change)
    part = new[:, change.changed & ~hidden].mean(axis=1) >= 0.9
    mixed = float(half_and_half(seen[part], change).mean()) if part.any() else float("nan")
    course = new[:, hidden].mean(axis=1)
    return _Outcome(mixed, float(course[-1]), course)


def _mean(outcomes: Sequence[_Outcome], what: str) -> float:
    values = [getattr(outcome, what) for outcome in outcomes]
    return float(np.nanmean(values)) if not np.isnan(values).all() else float("nan")


def _by_definition(found: dict[str, Outcomes]) -> Table:
    header = ["first part / last part in view"]
    header += [f"{level}: {what}" for level in found for what in ("half-and-half", "follows")]
    rows = []
    for name in _NAMES:
        row = [name]
        for one, what in product(found.values(), ("mixed", "follows")):
            row.append(" / ".join(share(_mean(_compared(one[name], side), what)) for side in SIDES))
        rows.append(row)
    return Table(header, rows, "10, 20 and 40 hidden angle bins, 4 to 20 full views:")


def _compared(outcomes: dict[_Case, _Outcome], side: str) -> list[_Outcome]:
    """With 40 full views a window of 40 has learnt the object before a part goes out of view."""
    return [o for case, o in outcomes.items() if case.side == side and case.hidden <= 40 and case.views <= 20]


def _by_case(level: str, outcomes: dict[_Case, _Outcome]) -> Table:
    sizes, views = sorted({case.hidden for case in outcomes}), sorted({case.views for case in outcomes})
    rows = []
    for size, side in product(sizes, SIDES):
        cells = [
            [o for c, o in outcomes.items() if (c.hidden, c.side, c.views) == (size, side, n)] for n in views
        ]
        rows.append(
            (
                f"{size} hidden, {side} part in view",
                *(f"{share(_mean(c, 'mixed'))} / {share(_mean(c, 'follows'))}" for c in cells),
            )
        )
    return Table((f"ours, {level}: half-and-half / follows", *(f"{n} full views" for n in views)), rows)


def _draw(found: dict[str, Outcomes], canvas: "Canvas") -> None:
    axes = canvas.subplots(1, len(found), sharey=True, squeeze=False)[0]
    for axis, level, (title, one) in zip(axes, LEVELS, found.items(), strict=False):
        for name in ("ours", "profile: paper", "vote without freshness", "median per angle bin"):
            course = np.mean([o.course for case, o in one[name].items() if case.hidden <= 40], axis=0)
            every = 10 if level.half_life < 100 else 30
            axis.plot(every * np.arange(1, len(course) + 1), course, label=name)
        axis.axvline(level.half_life, color="0.6", linestyle=":")
        axis.set_title(title)
        axis.set_xlabel("scans")
    axes[0].set_ylabel("hidden bins that follow")
    axes[0].legend(fontsize=7)
