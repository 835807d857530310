"""From settings to the parts of the model: the model knows no settings, and they know no model."""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial

from timemap_cli.changes.tracker import Tracker
from timemap_cli.config import LevelSettings, Settings
from timemap_cli.model.estimator import Estimator, estimate
from timemap_cli.model.gate import Gate
from timemap_cli.model.guard import Guard
from timemap_cli.model.learner import Answer, Asked, Kept, Learner
from timemap_cli.model.levels import Level
from timemap_cli.model.nodes import Node
from timemap_cli.model.observer import Observer
from timemap_cli.model.paper_profile import estimate_as_in_paper
from timemap_cli.model.schedule import Period, Schedule
from timemap_cli.model.time_map import TimeMap


def observer(settings: Settings, nodes: Sequence[Node], likely: Sequence[Node] = ()) -> Observer:
    """What turns scans into observations of nodes; given `nodes` are all there will be; `likely`: Placement."""
    gate = settings.gate
    return Observer(
        Gate(gate.min_travel, math.radians(gate.min_turn_deg), round(gate.min_interval_s * 1e9)),
        angle_bins=settings.map.angle_bins,
        radius=settings.map.radius,
        spacing=settings.map.node_spacing,
        nodes=nodes,
        likely=likely,
    )


def learner(
    settings: Settings, nodes: Sequence[Node], kept: Callable[[], Iterable[Kept]] | None = None
) -> Callable[[Asked], Answer]:
    """What learns from observations; given `nodes` are known from the start.

    It has learnt nothing yet, or goes on from what another one `kept`, whose observer knew the nodes.
    """
    time_map = TimeMap(
        levels(settings),
        _estimator(settings),
        angle_bins=settings.map.angle_bins,
        seed=settings.seed,
        nodes=nodes if kept is None else (),
    )
    guard = Guard(
        settings.gate.max_contradiction,
        angle_bins=settings.map.angle_bins,
        radius=settings.map.radius,
        window=settings.levels[-1].window,
    )
    learner = Learner(time_map, guard, _schedule(settings))
    if kept is not None:
        learner.restore(kept(), nodes)
    return learner.take


def tracker(settings: Settings) -> Tracker:
    """What follows changes, and knows of none yet.

    A window of one sample is no memory: as the fastest level it would have every passer-by undo what is suspected.
    """
    remembering = [level.name for level in settings.levels if level.window > 1]
    return Tracker(remembering, settings.map.radius)


def levels(settings: Settings) -> list[Level]:
    """The levels of a map, fastest first."""
    return [_level(level) for level in settings.levels]


def _level(level: LevelSettings) -> Level:
    return Level(level.name, level.window, level.half_life.value, in_seconds=level.half_life.unit == "s")


def _estimator(settings: Settings) -> Estimator:
    if settings.profile == "paper":
        return partial(estimate_as_in_paper, range_bin=settings.map.range_bin)
    return partial(estimate, state_width=settings.map.range_bin)


def _schedule(settings: Settings) -> Schedule:
    """When the nodes that changed are estimated."""
    every = settings.estimate.every
    if every.unit == "obs":
        return Schedule(Period(max(1, round(every.value)), in_scans=True))
    return Schedule(Period(round(every.value * 1e9), in_scans=False))
