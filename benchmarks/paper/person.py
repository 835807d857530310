"""A person who walks through: never in the long level."""

import numpy as np

from benchmarks.paper.definitions import DEFINITIONS, chosen
from benchmarks.paper.rivals import rivals
from benchmarks.paper.rooms import OFFICE
from benchmarks.paper.scene import LASER, laser_poses, measured, poses, rays
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.watched import EVERY, LONG, MID, Watched
from benchmarks.paper.words import percent
from sample_logs.rays import Floats
from sample_logs.world import Walk, World
from timemap_cli.model.levels import Level
from timemap_cli.model.virtual_scan import Ranges

SHORT = Level("short", 7, 5.0)
_ROUND = 300  # scans from one visit to the next; 0.2 s each
_NEARER = 0.3  # [m] before the true surface, in front of which a person counts as shown
_LEAST_BINS = 3


def run(scale: Scale) -> Section:
    """Visits of 20 s: in at one side, a stop of 8 s for a chat, out at the other."""
    nodes, visits = scale.pick((6, 6), (1, 1))
    levels = scale.pick((SHORT, MID, LONG), (SHORT, LONG))
    random = np.random.default_rng(11)
    scans = np.stack([_scans(visits, random) for _ in range(nodes)], axis=1)
    shown: dict[str, dict[str, float]] = {}
    for level in levels:
        definitions = scale.pick(DEFINITIONS, chosen("ours"))
        watched = Watched(level, nodes, definitions, {} if scale is Scale.quick else rivals(nodes, 4.0))
        watched.learn(scans[:_ROUND])
        shown[level.name] = {name: _shown(seen) for name, seen in watched.follow(scans[_ROUND:]).items()}
    rows = [(name, *(percent(shown[level.name][name]) for level in levels)) for name in shown["long"]]
    return Section(
        "A person walking through",
        (
            f"Every {_ROUND} scans (60 s) somebody walks in, stops 8 s a metre from the robot, and leaves by the "
            f"other side: {visits} visits, the first after {_ROUND} quiet scans. "
            f"Share of the estimates that show somebody: at least {_LEAST_BINS} neighbouring angle bins more than "
            f"{_NEARER} m before the true wall. The short level (window 7, half-life 5) "
            f"should show them; the long level never. {nodes} runs, an estimate every {EVERY} scans.",
        ),
        (Table(("share of estimates with somebody in them", *shown), rows),),
        (),
        {level: one["ours"] for level, one in shown.items()},
    )


def _scans(visits: int, random: np.random.Generator) -> Ranges:
    """Virtual scans (scans, angle_bins) of the office, quiet for one round and then with a visit in each."""
    n = _ROUND * (visits + 1)
    times, places = 0.2 * np.arange(n, dtype=np.float64), poses(n, random)
    laser = laser_poses(places, LASER)
    bearings = laser[:, 2:] + LASER.bearings
    origins = np.asarray(np.broadcast_to(laser[:, None, :2], (*bearings.shape, 2)), np.float64)
    world = World(OFFICE, walks=[_visit(0.2 * _ROUND * (1 + i), random) for i in range(visits)])
    true = np.asarray(np.round(world.ranges(times, origins, bearings, LASER.reach), 6), np.float64)
    return measured(true, laser, places, random).virtual()


def _visit(start: float, random: np.random.Generator) -> Walk:
    side = random.uniform(-0.3, 0.3)
    way = np.array([[2.7, side], [1.0, side], [1.0, side], [0.9, 1.3], [-2.0, 0.9]])
    return Walk("visitor", start + np.array([0.0, 4.0, 12.0, 15.0, 20.0]), way)


def _shown(seen: Floats) -> float:
    wall = rays(OFFICE).min(axis=1)
    nearer = seen < wall - _NEARER
    together = nearer & np.roll(nearer, 1, axis=-1) & np.roll(nearer, 2, axis=-1)
    return float(together.any(axis=-1).mean())
