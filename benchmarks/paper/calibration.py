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
from timemap_cli.model.memory import Memory, Remembered
from timemap_cli.model.nodes import Node
from timemap_cli.model.states import states_from_data
from timemap_cli.model.virtual_scan import Ranges
from timemap_cli.model.vote import shares

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_LEVELS = (Level("short", 7, 5.0), Level("mid", 25, 20.0), Level("long", 100, 200.0))
_NEAR = 0.1  # [m] how near an estimate must be to the true surface
_ENOUGH = 50  # angle bins below which a slice says nothing
_SLICES = np.array([0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0])
_SUPPORT = "support"
_QUANTITIES = (_SUPPORT, "share of the window", "its state's share", "mean of that and plausibility")


@dataclass(frozen=True, slots=True)
class _Robot:
    """What a robot sees of the room, and how well it knows where it stands."""

    name: str
    field_deg: float
    jitter: tuple[float, float]  # one sigma [m], [deg]

    @property
    def laser(self) -> Scanner:
        return Scanner(beams=round(2 * self.field_deg), field_deg=self.field_deg)


_ROBOTS = (
    _Robot("240°", 240.0, (0.03, 1.0)),
    _Robot("120°", 120.0, (0.03, 1.0)),
    _Robot("360°", 360.0, (0.03, 1.0)),
    _Robot("240°, right poses", 240.0, (0.0, 0.0)),
)

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
    """A room with a door, a box that is moved, people, and robots of several views."""
    levels, robots = scale.pick(_LEVELS, _LEVELS[1:2]), scale.pick(_ROBOTS, _ROBOTS[::2])
    judged = {
        (level.name, robot.name): _judged(level, robot, scale.pick(12, 3), scale)
        for robot in robots
        for level in levels
    }
    errors = {(*case, q): _error(found, q) for case, found in judged.items() for q in _QUANTITIES}
    return Section(
        "Calibration: what support says, and what is so",
        (
            "A room of 6 m by 5 m with a door that opens and closes, a box that is moved between three "
            "places, people in 40 % of the scans, a scanner of 120, 240 or 360 degrees, and poses that "
            "jitter by 3 cm and 1 degree, or are right. *Right*: the share of the past, each scan weighted by the "
            "level's half-life whether it saw the angle bin or not, in which the true surface "
            f"lies within {100 * _NEAR:.0f} cm of the estimate. *Majority*: how often that is more than "
            "half. By slices of the support that the level gives the angle bin.",
            "The second table has what is so by the distance to what is said (mean over tenths of it), for "
            "support and for three other definitions: the share of the whole window that lies in the state shown, "
            "its share of what is known, and the mean of that and the share of the window that does not "
            "contradict it. The mean is right for the view for which it was found, and for no other.",
        ),
        (_slices(judged), _distances(errors)),
        (Figure("calibration", "Share of the weighted past that agrees, over what is said.", partial(_draw, judged)),),
        {" ".join(case): error for case, error in errors.items()},
    )  # fmt: skip


def _judged(level: Level, robot: _Robot, nodes: int, scale: Scale) -> Judged:
    """Runs of a robot in the room, looked at every half of a half-life once the level is old."""
    random = np.random.default_rng(21)
    pools = [
        _pool(door, place, scale.pick(80, 25), robot, random)
        for door, place in product((True, False), _PLACES)
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
        said, shown = _claims(memory.recall(np.arange(nodes)))
        past = moments[:stop]
        weight = 0.5 ** (np.arange(stop)[::-1] / level.half_life)[:, None]
        agreement = [
            (weight * agrees(shown[n], nearest[past[:, n]], farthest[past[:, n]])).sum(0) / weight.sum()
            for n in range(nodes)
        ]
        sure = ~np.isnan(shown)
        parts.append([values[sure] for values in (*said, np.array(agreement))])
        start = stop
    *claims, agreed = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Judged(dict(zip(_QUANTITIES, claims, strict=True)), agreed)


def _claims(memory: Remembered) -> tuple[Sequence[Floats], Floats]:
    """What each quantity says of the estimates, and their ranges [m], all (nodes, angle_bins)."""
    found = estimate(memory, STATE_WIDTH)
    states = states_from_data(memory, STATE_WIDTH)
    share = shares(memory, states)
    rows = np.arange(len(states.rows))
    chosen = states.labels(found.ranges.reshape(-1)[states.rows, None], rows)[:, 0]
    window = share.known.copy()
    window[states.rows] = share.states[rows, chosen]
    of_known = window / np.maximum(share.known, 1e-9)
    mean = (of_known + 1 - (share.known - window)) / 2
    shape = found.ranges.shape
    others = [values.reshape(shape) for values in (window, of_known, mean)]
    return (found.support, *others), metres(found.ranges)


def _pool(
    door_is_open: bool, place: tuple[float, float], n: int, robot: _Robot, random: np.random.Generator
) -> _Pool:
    """Moments of the room with its door open or closed and the box at its place."""
    room = np.concatenate(
        (_WALLS, _BEHIND if door_is_open else _DOOR, outline_segments(box(*place, 0.5, 0.4, 15.0)))
    )
    metre, degree = robot.jitter
    seen, truths = [], []
    for _ in range(n):
        world = room
        if random.random() < 0.4:
            bearing, distance = random.uniform(-np.pi, np.pi), random.uniform(0.8, 2.2)
            person = disc(distance * np.cos(bearing), distance * np.sin(bearing), 0.2)
            world = np.concatenate((room, outline_segments(person)))
        scan = look(world, 1, random, robot.laser, poses(1, random))
        jitter = random.normal(0, (metre, metre, np.deg2rad(degree)), (1, 3))
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


def _slices(judged: dict[tuple[str, str], Judged]) -> Table:
    levels, robots = (list(dict.fromkeys(names)) for names in zip(*judged, strict=True))
    return Table(
        ("support: right / majority (angle bins)", *robots),
        [
            (
                f"{level}, {low:.1f} to {high:.1f}",
                *(_cell(judged[level, robot], low, high) for robot in robots),
            )
            for level in levels
            for low, high in pairwise(_SLICES.tolist())
        ],
    )


def _cell(found: Judged, low: float, high: float) -> str:
    claim = found.claims[_SUPPORT]
    right = found.agreement[(claim >= low) & ((claim < high) | (high == 1.0))]
    return (
        f"{share(right.mean())} / {share((right > 0.5).mean())} ({len(right)})"
        if len(right) >= _ENOUGH
        else f"- ({len(right)})"
    )


def _distances(errors: dict[tuple[str, str, str], float]) -> Table:
    return Table(
        ("distance of what is said and what is so", *_QUANTITIES),
        [
            (f"{level}, {robot}", *(number(errors[level, robot, q], 3) for q in _QUANTITIES))
            for level, robot in dict.fromkeys(case[:2] for case in errors)
        ],
    )


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


def _draw(judged: dict[tuple[str, str], Judged], canvas: "Canvas") -> None:
    levels = list(dict.fromkeys(level for level, _ in judged))
    for level, axes in zip(levels, canvas.subplots(1, len(levels), squeeze=False)[0], strict=True):
        axes.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        for (name, robot), found in judged.items():
            if name == level:
                said, so, n = _curve(found, _SUPPORT)
                held = n >= 0.005 * n.sum()
                axes.plot(said[held], so[held], "o-", label=robot)
        axes.set_title(level)
        axes.set_xlabel("support")
    canvas.axes[0].set_ylabel("what is so")
    canvas.axes[0].legend()
