"""Is support what it says? Against the world that the level should hold: weighted by its half-life."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import STATE_WIDTH
from benchmarks.paper.scene import ANGLE_BINS, Scanner, look, poses, rays
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.watched import metres
from benchmarks.paper.words import number, share
from sample_logs.rays import Floats
from sample_logs.world import box, disc, outline_segments
from timemap_cli.model.estimator import estimate
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import Ranges

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_LEVELS = (Level("mid", 25, 20.0), Level("long", 100, 200.0))
_LASER = Scanner(beams=480, field_deg=240.0)
_NEAR = 0.1  # [m] how near an estimate must be to the true surface
_SLICES = np.array([0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0])
_QUANTITIES = ("support", "support / known", "plausibility", "mean of these two")

_WALLS = np.array(
    [(-3, -2.5, 3, -2.5), (-3, -2.5, -3, 2.5), (-3, 2.5, 3, 2.5), (3, -2.5, 3, -0.6), (3, 0.6, 3, 2.5)], float
)
_BEHIND = np.array([(3, -0.6, 5, -0.6), (5, -0.6, 5, 0.6), (5, 0.6, 3, 0.6)], float)
_DOOR = np.array([(3, -0.6, 3, 0.6)], float)
_PLACES = ((-1.6, 1.3), (-1.2, -1.4), (0.3, 1.6))  # [m] where the box may stand


@dataclass(frozen=True, slots=True)
class _Pool:
    """Moments of one arrangement of the room: what the robot saw, and between what ranges the truth lay."""

    scans: Ranges  # (n, angle_bins) [mm]
    nearest: Floats  # (n, angle_bins) [m]
    farthest: Floats


@dataclass(frozen=True, slots=True)
class Judged:
    """What a level claimed of angle bins, and how it was: flat arrays (n,)."""

    claims: dict[str, Floats]  # by quantity, 0..1
    agreement: Floats  # share of the world, weighted by the half-life, in which the estimate is right


def run(scale: Scale) -> Section:
    """A room with a door, a box that is moved, people, and a robot whose poses jitter."""
    judged = {
        level.name: _judged(level, scale.pick(16, 3), scale) for level in scale.pick(_LEVELS, _LEVELS[:1])
    }
    errors = {(name, q): _error(found, q) for name, found in judged.items() for q in _QUANTITIES}
    rows = [
        (f"{name}, {low:.1f} to {high:.1f}", *_cells(found, low, high))
        for name, found in judged.items()
        for low, high in pairwise(_SLICES.tolist())
    ]
    columns = ("angle bins", "right", "majority")
    return Section(
        "Calibration: what support says, and what is so",
        (
            "A room of 6 m by 5 m with a door that opens and closes, a box that is moved between three "
            "places, people in 40 % of the scans, poses that jitter by 3 cm and 1 degree, "
            "and a scanner of 240 degrees. *Right*: the share of the past, each scan weighted by the "
            "level's half-life whether it saw the angle bin or not, in which the true surface "
            f"lies within {100 * _NEAR:.0f} cm of the estimate. *Majority*: how often that is more than "
            "half. By slices of what the level says of the angle bin.",
            "Mean distance of what is said and what is so: "
            + "; ".join(f"{name}, {quantity} {number(error, 3)}" for (name, quantity), error in errors.items())
            + ".",
        ),
        (Table(("", *(f"{quantity}: {column}" for quantity in _QUANTITIES for column in columns)), rows),),
        (Figure("calibration", "Share of the weighted past that agrees, over what is said.", partial(_draw, judged)),),
        {f"{name} {quantity}": error for (name, quantity), error in errors.items()},
    )  # fmt: skip


def _judged(level: Level, nodes: int, scale: Scale) -> Judged:
    """Runs of a robot in the room, looked at every half of a half-life once the level is old."""
    random = np.random.default_rng(21)
    pools = [
        _pool(door, place, scale.pick(80, 25), random) for door, place in product((True, False), _PLACES)
    ]
    scans, nearest, farthest = (
        np.concatenate([getattr(pool, name) for pool in pools]) for name in ("scans", "nearest", "farthest")
    )
    first = round(4 * level.half_life)
    looks = [first + round(i * level.half_life / 2) for i in range(scale.pick(10, 6))]
    moments = np.stack(
        [_history(looks[-1], len(pools[0].scans), level.half_life, random) for _ in range(nodes)], axis=1
    )
    memory = Memory(level, ANGLE_BINS, 0)
    memory.add_nodes([Node(float(n), 0.0) for n in range(nodes)])
    parts: list[list[Floats]] = []
    start = 0
    for stop in looks:
        block = scans[moments[start:stop]].reshape(-1, ANGLE_BINS)
        stamps = np.repeat(np.arange(start, stop, dtype=np.int64), nodes) * 10**8
        memory.remember(np.tile(np.arange(nodes), stop - start), stamps, block)
        found = estimate(memory.recall(np.arange(nodes)), STATE_WIDTH)
        known = found.support + 1 - found.plausibility
        seen = found.support / np.maximum(known, 1e-9)
        said = (found.support, seen, found.plausibility, (seen + found.plausibility) / 2)
        past = moments[:stop]
        weight = 0.5 ** (np.arange(stop)[::-1] / level.half_life)
        shown = metres(found.ranges)
        agreement = [
            weight @ agrees(shown[n], nearest[past[:, n]], farthest[past[:, n]]) / weight.sum()
            for n in range(nodes)
        ]
        sure = known > 0
        parts.append([values[sure] for values in (*said, np.array(agreement))])
        start = stop
    *claims, agreed = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Judged(dict(zip(_QUANTITIES, claims, strict=True)), agreed)


def _pool(door_is_open: bool, place: tuple[float, float], n: int, random: np.random.Generator) -> _Pool:
    """Moments of the room with its door open or closed and the box at its place."""
    room = np.concatenate(
        (_WALLS, _BEHIND if door_is_open else _DOOR, outline_segments(box(*place, 0.5, 0.4, 15.0)))
    )
    seen, truths = [], []
    for _ in range(n):
        world = room
        if random.random() < 0.4:
            bearing, distance = random.uniform(-np.pi, np.pi), random.uniform(0.8, 2.2)
            person = disc(distance * np.cos(bearing), distance * np.sin(bearing), 0.2)
            world = np.concatenate((room, outline_segments(person)))
        scan = look(world, 1, random, _LASER, poses(1, random))
        jitter = random.normal(0, (0.03, 0.03, np.deg2rad(1.0)), (1, 3))
        seen.append(replace(scan, poses=scan.poses + jitter).virtual()[0])
        truths.append(rays(world))
    return _Pool(
        np.array(seen), np.array([t.min(axis=1) for t in truths]), np.array([t.max(axis=1) for t in truths])
    )


def _history(n: int, pool: int, half_life: float, random: np.random.Generator) -> npt.NDArray[np.int64]:
    """Moments (n,) of one run, as numbers into all pools: the door stays for some scans, the box for longer."""
    share_open = random.uniform(0.1, 0.9)
    door, place = random.random() < share_open, int(random.integers(3))
    found = np.empty(n, np.int64)
    for i in range(n):
        if random.random() < 1 / (0.4 * half_life):
            door = random.random() < share_open
        if random.random() < 1 / (2 * half_life):
            place = int(random.integers(3))
        found[i] = (3 * (not door) + place) * pool + random.integers(pool)
    return found


def agrees(shown: Floats, nearest: Floats, farthest: Floats) -> Floats:
    """Where an estimate (angle_bins,) is near to what was there at each moment (n, angle_bins)."""
    return np.asarray((shown >= nearest - _NEAR) & (shown <= farthest + _NEAR), np.float64)


def _cells(found: Judged, low: float, high: float) -> Sequence[str]:
    cells: list[str] = []
    for claim in found.claims.values():
        here = (claim >= low) & ((claim < high) | (high == 1.0))
        right = found.agreement[here]
        cells += (
            [str(len(right)), share(float(right.mean())), share(float((right > 0.5).mean()))]
            if len(right)
            else ["0", "-", "-"]
        )
    return cells


def _curve(found: Judged, quantity: str) -> tuple[Floats, Floats, Floats]:
    """By tenths of a claim: its mean, the mean agreement, and how many angle bins."""
    claim = found.claims[quantity]
    tenth = np.minimum((claim * 10).astype(int), 9)
    n = np.bincount(tenth, minlength=10)
    sums = [np.bincount(tenth, values, 10) for values in (claim, found.agreement)]
    return sums[0] / np.maximum(n, 1), sums[1] / np.maximum(n, 1), n.astype(np.float64)


def _error(found: Judged, quantity: str) -> float:
    """Distance of claim and agreement, mean over tenths that hold at least 0.5 % of the angle bins."""
    said, so, n = _curve(found, quantity)
    held = n >= 0.005 * n.sum()
    return float(np.abs(said - so)[held].mean())


def _draw(judged: dict[str, Judged], canvas: "Canvas") -> None:
    for axes, (name, found) in zip(
        canvas.subplots(1, len(judged), squeeze=False)[0], judged.items(), strict=True
    ):
        axes.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        for quantity in _QUANTITIES:
            said, so, n = _curve(found, quantity)
            held = n >= 0.005 * n.sum()
            axes.plot(said[held], so[held], "o-", label=quantity)
        axes.set_title(name)
        axes.set_xlabel("what the level says")
    canvas.axes[0].set_ylabel("what is so")
    canvas.axes[0].legend()
