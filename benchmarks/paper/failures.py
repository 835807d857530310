"""Scenes that were made to make the estimate fail; ours beside the median and the paper."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.paper.definitions import chosen
from benchmarks.paper.metrics import Change
from benchmarks.paper.rooms import OFFICE, arc, with_boxes
from benchmarks.paper.scene import LASER, Scanner, Scans, look, poses
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.trial import Outcome, Trial
from benchmarks.paper.watched import LONG, MID
from benchmarks.paper.words import number, percent, scans
from sample_logs.rays import Floats
from sample_logs.world import box, outline_segments
from timemap_cli.model.levels import Level

NAMES = ("ours", "profile: paper", "median per angle bin")
_BOX = (1.5, 0.3, 0.4, 0.6, 15.0)
_CORRIDOR = outline_segments(box(0.0, 0.3, 16.0, 1.8))
_NARROW = Scanner(beams=181, field_deg=90.0)

Look = Callable[[Floats, np.random.Generator], Scans]


def _looks(world: Floats, random: np.random.Generator) -> Scans:
    return look(world, 400, random)


def _narrow(world: Floats, random: np.random.Generator) -> Scans:
    return look(world, 1200, random, _NARROW)


def _with_outliers(world: Floats, random: np.random.Generator) -> Scans:
    found = _looks(world, random)
    wild = random.random(found.ranges.shape) < 0.05
    anything = np.round(random.uniform(0.1, 10.0, wild.shape), 3).astype(np.float32)
    return replace(found, ranges=np.where(wild, anything, found.ranges))


def _with_jitter(world: Floats, random: np.random.Generator) -> Scans:
    found = _looks(world, random)
    return replace(found, poses=found.poses + random.normal(0, (0.05, 0.05, np.deg2rad(1.0)), (400, 3)))


def _through_glass(world: Floats, random: np.random.Generator) -> Scans:
    """The wall at +x is glass: 3 of 4 beams go through and meet nothing."""
    places = poses(400, random)
    solid, open_side = (look(one, 400, random, LASER, places) for one in (world, np.delete(world, 1, axis=0)))
    through = random.random(solid.ranges.shape) < 0.75
    return replace(solid, ranges=np.where(through, open_side.ranges, solid.ranges))


def _legs(x: float, y: float, turned_deg: float) -> list[tuple[float, float, float, float, float]]:
    """A table and two chairs: twelve legs of 4 cm."""
    turn = np.deg2rad(turned_deg)
    spots = [(i * 0.6, j * 0.35) for i in (-1, 1) for j in (-1, 1)]
    spots += [(c * 0.3 + i * 0.18, 0.75 + j * 0.18) for c in (-1, 1) for i in (-1, 1) for j in (-1, 1)]
    return [
        (
            x + a * np.cos(turn) - b * np.sin(turn),
            y + a * np.sin(turn) + b * np.cos(turn),
            0.04,
            0.04,
            turned_deg,
        )
        for a, b in spots
    ]


@dataclass(frozen=True, slots=True)
class Scene:
    """A change, and how it is looked at."""

    before: Floats
    after: Floats
    look: Look = _looks


_SHELVES = [(-0.9 + 0.6 * i, 1.5 + 0.12 * (i % 2), 0.6, 0.4, 0.0) for i in range(4)]

SCENES = {
    "touching shelves, one of four taken away": Scene(
        with_boxes(OFFICE, *_SHELVES), with_boxes(OFFICE, *_SHELVES[:2], *_SHELVES[3:])
    ),
    "corridor at a grazing angle, a box appears": Scene(
        _CORRIDOR, with_boxes(_CORRIDOR, (3.0, 0.9, 0.5, 0.5, 0.0))
    ),
    "glass that answers 1 beam in 4, a box appears before it": Scene(
        OFFICE, with_boxes(OFFICE, _BOX), _through_glass
    ),
    "furniture legs, moved by 0.4 m": Scene(
        with_boxes(OFFICE, *_legs(0.9, 0.8, 10.0)), with_boxes(OFFICE, *_legs(1.25, 0.6, 25.0))
    ),
    "two touching objects, one is taken away": Scene(
        np.concatenate((OFFICE, arc(20, 45), arc(45, 75, 1.05))), np.concatenate((OFFICE, arc(45, 75, 1.05)))
    ),
    "one object moves in front of another": Scene(
        np.concatenate((OFFICE, arc(20, 60, 1.4))),
        np.concatenate((OFFICE, arc(20, 60, 1.4), arc(35, 80, 1.2))),
    ),
    "a view of 90°, a box appears": Scene(OFFICE, with_boxes(OFFICE, _BOX), _narrow),
    "5 % outliers, a box appears": Scene(OFFICE, with_boxes(OFFICE, _BOX), _with_outliers),
    "poses with 5 cm and 1° of jitter, a box appears": Scene(OFFICE, with_boxes(OFFICE, _BOX), _with_jitter),
}


def run(scale: Scale) -> Section:
    """Every scene at mid and long."""
    nodes, levels = scale.pick(8, 2), scale.pick((MID, LONG), (MID,))
    scenes = scale.pick(
        tuple(SCENES), ("touching shelves, one of four taken away", "5 % outliers, a box appears")
    )
    pools = {name: _trial(SCENES[name]) for name in scenes}
    found = {
        level.name: {name: measured(level, trial, nodes) for name, trial in pools.items()} for level in levels
    }
    return Section(
        "Scenes made to fail",
        (
            "In each scene a level knows the world for five half-lives, then something changes and stays. Error "
            "at the end [m], scans until 90 % of the changed angle bins follow, "
            "scans for which a changed run is half-and-half, and flicker: share of the steps from estimate to "
            "estimate in which an angle bin outside the change jumps by more than "
            f"0.1 m. Three half-lives, {nodes} runs, an estimate every 10 scans.",
            "Where the old world itself shows two states, as glass does, the new one wins as soon as it outweighs the "
            "larger of them: earlier than at the half-life. Poses that tremble by 5 cm spread the ranges at edges and "
            "slanted walls over several states, which take turns: there the median is steadier and nearer.",
        ),
        tuple(_table(level, one) for level, one in found.items()),
        (),
        {
            f"{level} {name} {scene} {what}": getattr(outcome, what)
            for level, one in found.items()
            for scene, outcomes in one.items()
            for name, outcome in outcomes.items()
            for what in ("delay", "mixed", "error", "flicker")
        },
    )


def _trial(scene: Scene) -> Trial:
    random = np.random.default_rng(13)
    before, after = (scene.look(world, random).virtual() for world in (scene.before, scene.after))
    return Trial(before, after, Change.between(scene.before, scene.after))


def measured(level: Level, trial: Trial, nodes: int) -> dict[str, Outcome]:
    """One scene at one level."""
    random = np.random.default_rng(14)
    seen = trial.estimates(level, nodes, random, chosen(*NAMES))
    return {name: trial.outcome(estimates) for name, estimates in seen.items()}


def _table(level: str, found: dict[str, dict[str, Outcome]]) -> Table:
    rows = [(scene, *(_cell(outcomes[name]) for name in NAMES)) for scene, outcomes in found.items()]
    return Table((f"{level}: error / delay / half-and-half / flicker", *NAMES), rows)


def _cell(outcome: Outcome) -> str:
    parts = (number(outcome.error, 3), scans(outcome.delay), scans(outcome.mixed), percent(outcome.flicker))
    return " / ".join(parts)
