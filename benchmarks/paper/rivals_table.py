"""Everybody on the same scans: error, delay, half-objects, hidden parts, flicker; and a case that we lose."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, chosen
from benchmarks.paper.metrics import Change, delay, error, flicker, half_and_half, shows_new
from benchmarks.paper.rivals import rivals
from benchmarks.paper.rooms import OFFICE, arc, with_boxes
from benchmarks.paper.scene import ANGLE_BINS, ROUND_ROOM, look
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.watched import EVERY, LONG, MID, Watched, drawn, old_history
from benchmarks.paper.words import number, percent, scans, share
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level
from timemap_cli.model.virtual_scan import Ranges

_BOX = (1.5, -0.1, 0.4, 0.6, 15.0)
_SCREEN, _SEEN = (60, 110), 20  # an object from one angle bin to another, of which the first 20 stay in view
_VIEWS = 12  # of the whole screen
_OUTLIERS = 0.02  # share of the beams, in the second table
_JITTER = (0.02, 0.02, np.deg2rad(0.5))
_AGAIN = ("ours", "profile: paper", "caption, states from data", "median per angle bin")

WORLD = np.concatenate((with_boxes(OFFICE, _BOX), arc(*_SCREEN, 0.9)))


@dataclass(frozen=True, slots=True)
class _Outcome:
    error: float  # [m] at the end
    delay: float  # [scans] of the box; NaN never
    mixed: float  # share of a half-life for which the box or the screen is half-and-half
    hidden: float  # share of the screen's hidden angle bins that show it at the end
    flicker: float


_SENTENCES = (
    "An office, poses with 2 cm and 0.5° of jitter, known for five half-lives. Then a box appears and stays in view; "
    f"and a screen of 50 angle bins appears, is seen whole in {_VIEWS} scans, and after that only its first "
    f"{_SEEN} are "
    "in view. After three half-lives: *error* [m] over all angle bins; *delay* of the box in scans and in "
    "half-lives of "
    "the level; *half-and-half*: for how many half-lives the box or the screen is half old, half new; *hidden*: "
    "share "
    "of the screen's hidden angle bins that show it; *flicker*: share of the steps of an angle bin outside the "
    "change "
    "that jump. Last scan, grids and Markov chains have no levels: what they lack is a memory that is slow on "
    "purpose, "
    "and a grid that counts all hits follows the later, the longer it has seen the old world.",
    "**Cases that we lose.** (1) Two objects that touch appear together and are seen for two half-lives. One "
    "goes out of "
    "view; then the other is taken away. What was always seen side by side is concluded to leave together, so we "
    "take "
    "the hidden one away too, though it still stands; who keeps angle bins apart is right here (last table). (2) "
    "With "
    f"{_OUTLIERS:.0%} outliers the hidden part no longer follows: a remembered outlier of which no pair is left "
    "forbids "
    "nothing, and the path changes over from the new state to the old one on it. (3) Where poses tremble we "
    "flicker more "
    "than the median (see *Scenes made to fail*). (4) A last scan and clamped log-odds show a new thing at once, the "
    "hidden part with it; and everybody who walks by, at every time scale.",
)


def run(scale: Scale) -> Section:
    """A box in view all the time, and a screen of which most goes out of view."""
    nodes, levels = scale.pick(8, 2), scale.pick((MID, LONG), (MID,))
    others = scale is Scale.full
    names = scale.pick(tuple(DEFINITIONS), ("ours", "median per angle bin"))
    again = scale.pick(_AGAIN, names)
    found = {level: measured(level, nodes, 0.0, names, others=others) for level in levels}
    rough = {level: measured(level, nodes, _OUTLIERS, again, others=False) for level in levels}
    neighbour = {level.name: _left_alone(level, nodes, names, others=others) for level in levels}

    lost = Table(
        ("share of the hidden neighbour that is still shown", *neighbour),
        [(name, *(share(one[name]) for one in neighbour.values())) for name in neighbour[levels[0].name]],
        "Two neighbours, of which the hidden one stays:",
    )
    return Section(
        "Others on the same scans",
        _SENTENCES,
        (
            *(_table(level, one, "") for level, one in found.items()),
            *(_table(level, one, f"The same with {_OUTLIERS:.0%} outliers:") for level, one in rough.items()),
            lost,
        ),
        (),
        {
            f"{level.name} {name} {what}": getattr(outcome, what)
            for level, one in found.items()
            for name, outcome in one.items()
            for what in ("error", "delay", "mixed", "hidden", "flicker")
        }
        | {
            f"{level.name} outliers {name} hidden": o.hidden
            for level, one in rough.items()
            for name, o in one.items()
        }
        | {
            f"{level} {name} neighbour": value
            for level, one in neighbour.items()
            for name, value in one.items()
        },
    )


def measured(
    level: Level, nodes: int, outliers: float, names: Sequence[str], *, others: bool
) -> dict[str, _Outcome]:
    """What everybody makes of the same scans at one level."""
    random = np.random.default_rng(15)
    before = _scans(OFFICE, random, outliers, hide=False)
    whole, part = (_scans(WORLD, random, outliers, hide=hide) for hide in (False, True))
    watched = Watched(level, nodes, chosen(*names), rivals(nodes, 4.0) if others else {})
    watched.learn(drawn(before, old_history(level), nodes, random))
    watched.learn(drawn(whole, _VIEWS, nodes, random))
    length = round(3 * level.half_life)
    seen = watched.follow(drawn(part, length, nodes, random))
    return {name: _outcome(one, level) for name, one in seen.items()}


def _scans(world: Floats, random: np.random.Generator, outliers: float, *, hide: bool) -> Ranges:
    found = look(world, 400, random)
    if hide:
        found = found.hiding(_hidden())
    wild = (random.random(found.ranges.shape) < outliers) & ~np.isnan(found.ranges)
    anything = np.round(random.uniform(0.1, 10.0, wild.shape), 3).astype(np.float32)
    tremble = random.normal(0, _JITTER, found.poses.shape)
    return replace(
        found, ranges=np.where(wild, anything, found.ranges), poses=found.poses + tremble
    ).virtual()


def _hidden() -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    place = np.arange(ANGLE_BINS)
    return (place >= _SCREEN[0] + _SEEN) & (place < _SCREEN[1] + 3)


def _outcome(seen: Floats, level: Level) -> _Outcome:
    box = Change.between(OFFICE, with_boxes(OFFICE, _BOX))
    both = Change.between(OFFICE, WORLD)
    mixed = float(half_and_half(seen, both).sum(axis=0).mean() * EVERY)
    hidden = both.changed & _hidden()
    return _Outcome(
        float(error(seen[-1], both.new, both.even).mean()),
        float(delay(seen, box, EVERY).mean()) + _VIEWS,
        mixed / level.half_life,
        float(shows_new(seen[-1], both)[..., hidden].mean()),
        flicker(seen, both.even & ~both.changed),
    )


def _left_alone(level: Level, nodes: int, names: Sequence[str], *, others: bool) -> dict[str, float]:
    """Share of an object that is still shown after its neighbour was taken away, while it was out of view."""
    random = np.random.default_rng(16)
    alone = np.concatenate((ROUND_ROOM, arc(45, 75)))
    pair = np.concatenate((alone, arc(20, 45)))
    hidden = (np.arange(ANGLE_BINS) >= 45) & (np.arange(ANGLE_BINS) < 78)
    empty, before = (look(world, 400, random).virtual() for world in (ROUND_ROOM, pair))
    after = look(alone, 400, random).hiding(hidden).virtual()
    watched = Watched(level, nodes, chosen(*names), rivals(nodes, 2.0) if others else {})
    watched.learn(drawn(empty, old_history(level), nodes, random))
    watched.learn(drawn(before, round(2 * level.half_life), nodes, random))
    watched.learn(drawn(after, round(3 * level.half_life), nodes, random))
    change = Change.between(ROUND_ROOM, alone)
    there = change.changed & hidden
    return {
        name: float(shows_new(seen, change)[..., there].mean()) for name, seen in watched.estimates().items()
    }


def _table(level: Level, found: dict[str, _Outcome], caption: str) -> Table:
    rows = [
        (
            name,
            number(one.error, 3),
            scans(one.delay),
            number(one.delay / level.half_life, 2),
            number(one.mixed, 2),
            share(one.hidden),
            percent(one.flicker),
        )
        for name, one in found.items()
    ]
    header = (
        level.name,
        "error [m]",
        "delay [scans]",
        "delay [half-lives]",
        "half-and-half",
        "hidden",
        "flicker",
    )
    return Table(header, rows, caption)
