"""The half-life that is stated against the one that is measured: of the window, and of the estimate."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import count
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import STATE_WIDTH
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.words import number, share
from sample_logs.rays import Floats
from timemap_cli.model.estimator import estimate
from timemap_cli.model.levels import LONGEST_STEP, Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import UNSEEN

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_OLD, _NEW = 3000, 2000  # [mm]
_NOISE = 10.0  # [mm]
_ANGLE_BINS = 24
_POINTS = 40  # looks at the memory in a half-life
_AT_ONCE = 200  # scans of a node
_HISTORY = 5.0  # half-lives
_VIEWS = (1.0, 0.75, 0.5)  # share of the scans that show an angle bin
_IN_SCANS = (
    *((7, 5.0), (7, 50.0), (7, 500.0), (10, 7.0), (25, 20.0), (25, 200.0), (50, 35.0), (50, 1000.0)),
    *((100, 70.0), (100, 277.0), (100, 2000.0), (200, 140.0), (200, 2000.0)),
)
_Steps = tuple[float, ...]  # [s] from scan to scan, over and over
_IN_SECONDS: tuple[tuple[int, float, _Steps], ...] = (
    (7, 10.0, (0.2,)),
    (25, 30.0, (0.5,)),
    (50, 600.0, (0.5, 5.0)),
    (100, 3600.0, (2.0,) * 9 + (86400.0,)),
    (200, 43200.0, (600.0,)),
)
_MANY = 25  # samples of a window from which on nodes need not be more
_YOUNG = Level("young", 100, 277.0)
_YOUNG_HISTORIES = (30, 100, 180, 230, 300, 370, 550, 1385)


def run(scale: Scale) -> Section:
    """Windows of 7 to 200 samples, half-lives of 5 to 2000 scans and of seconds to half a day."""
    nodes = scale.pick(32, 16)
    cases = list(_cases(scale))
    found = [[measured(level, steps, seen, _runs(level, nodes)) for seen in _VIEWS] for level, steps in cases]
    young = [(history, *_young(history, nodes)) for history in scale.pick(_YOUNG_HISTORIES, (30, 230))]
    alone = [
        _arrives(level, first_old=first, nodes=nodes) for level in _both(scale) for first in (True, False)
    ]
    windows = [ratio.window for row in found for ratio in row]
    estimates = [ratio.estimate for row in found for ratio in row]
    numbers = {
        "window least": min(windows),
        "window most": max(windows),
        "estimate least": min(estimates),
        "estimate most": max(estimates),
        "young least": min(took / due for _, took, due in young),
        "young most": max(took / due for _, took, due in young),
        "apart": min(alone),
    }
    return Section(
        "Half-life: stated and measured", _sentences(nodes, numbers), (_table(cases, found), _young_table(young)),
        (Figure("half_life", "When a young level gives way, by what it saw before: measured, and its law.",
                partial(_draw, young)),), numbers,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Ratio:
    """A measured half-life by the one that is stated."""

    window: float  # until half of what is known is new
    estimate: float  # until half of the angle bins show the new range


class _Scene:
    """Nodes that see one surface and then another, each angle bin in its share of the scans."""

    def __init__(self, level: Level, steps: _Steps, seen: float, nodes: int) -> None:
        self.seen = np.full(_ANGLE_BINS, seen)
        self._memory = Memory(level, _ANGLE_BINS, 0)
        self._memory.add_nodes([Node(float(n), 0.0) for n in range(nodes)])
        self._random = np.random.default_rng(7)
        self._steps, self._nodes, self._scans, self._now = steps, np.arange(nodes), count(), 0

    def show(self, surface: int, scans: int, first: int = 0) -> float:
        """So many scans of every node from number `first` on; returns the time observed [s]."""
        nodes, observed = self._nodes[first:], 0.0
        for start in range(0, scans, _AT_ONCE):
            n = min(_AT_ONCE, scans - start)
            steps = [self._steps[next(self._scans) % len(self._steps)] for _ in range(n)]
            stamps = self._now + np.cumsum(np.rint(np.array(steps) * 1e9).astype(np.int64))
            self._now = int(stamps[-1])
            observed += sum(min(step, LONGEST_STEP) for step in steps)
            ranges = np.rint(self._random.normal(surface, _NOISE, (n * len(nodes), _ANGLE_BINS))).astype(
                np.uint16
            )
            ranges[self._random.random(ranges.shape) >= self.seen] = UNSEEN
            self._memory.remember(np.tile(nodes, n), np.repeat(stamps, len(nodes)), ranges)
        return observed

    def scatter(self, surface: int, scans: int) -> None:
        """Up to so many scans, of each node another number: not all stand at the same place of a turn.

        Some nodes wait meanwhile, which is observed time too: let what is measured begin well after it.
        """
        shown = np.linspace(0, scans, len(self._nodes)).round().astype(int)
        for node in range(1, len(shown)):
            self.show(surface, int(shown[node] - shown[node - 1]), node)

    def new(self) -> tuple[float, Floats]:
        """Share of what is known that is new, and of the nodes that show it (angle_bins,)."""
        found = estimate(self._memory.recall(self._nodes), STATE_WIDTH)
        shows_new = np.abs(found.ranges.astype(np.int64) - _NEW) < (_OLD - _NEW) // 2
        new = found.known * np.where(shows_new, found.support, 1 - found.support)
        return float(new.sum() / found.known.sum()), np.asarray(shows_new.mean(axis=0))


def measured(level: Level, steps: _Steps, seen: float, nodes: int) -> Ratio:
    """Half-life of a level with an old history, by the stated one, in scans or in observed time."""
    scene = _Scene(level, steps, seen, nodes)
    per_scan = float(np.minimum(steps, LONGEST_STEP).mean()) if level.in_seconds else 1.0
    half_life = level.half_life / per_scan  # [scans]
    share = min(1.0, level.places_replaced(per_scan))
    scene.scatter(_OLD, min(100, 2 * math.ceil(max(1 / share, min(12.0, 1 / (1.001 - share))))))
    scene.show(_OLD, math.ceil(_HISTORY * half_life))
    passed, window, shown = [0.0], [0.0], [0.0]
    stride = max(1, round(half_life / _POINTS))
    while min(window[-1], shown[-1]) < 0.5 and passed[-1] < 3 * level.half_life:
        observed = scene.show(_NEW, stride)
        passed.append(passed[-1] + (observed if level.in_seconds else stride))
        new, shows_new = scene.new()
        window.append(new)
        shown.append(float(shows_new.mean()))
    return Ratio(*(_crossing(passed, values) / level.half_life for values in (window, shown)))


def _runs(level: Level, nodes: int) -> int:
    """How many nodes: in few samples chance decides more."""
    return nodes * math.ceil(_MANY / level.window)


def _crossing(passed: Sequence[float], values: Sequence[float]) -> float:
    """When the values first reach a half, on the line between two looks; inf if they do not."""
    for i in range(1, len(values)):
        if values[i] >= 0.5:
            part = (0.5 - values[i - 1]) / (values[i] - values[i - 1])
            return passed[i - 1] + part * (passed[i] - passed[i - 1])
    return math.inf


def young_law(level: Level, history: int) -> float:
    """Scans after which a level gives way that has seen the old state in so many scans, and nothing else.

    Up to T = 1/u scans it holds each scan it was shown alike: plain majority. Then what is old decays.
    """
    mature = level.window / level.places_replaced(1.0)
    if history <= mature / 2:
        return float(history)
    if history >= mature:
        return level.half_life
    return mature - history + level.half_life * math.log2(2 * history / mature)


def _young(history: int, nodes: int) -> tuple[float, float]:
    """Scans until a level with a short history shows the new state, measured and by the law."""
    scene = _Scene(_YOUNG, (0.1,), 1.0, nodes)
    scene.show(_OLD, history)
    due = young_law(_YOUNG, history)
    passed, shown = [0.0], [0.0]
    stride = max(1, round(due / _POINTS))
    while shown[-1] < 0.5 and passed[-1] < 3 * due:
        scene.show(_NEW, stride)
        passed.append(passed[-1] + stride)
        shown.append(float(scene.new()[1].mean()))
    return _crossing(passed, shown), due


def _arrives(level: Level, *, first_old: bool, nodes: int) -> float:
    """Least share of nodes that show the new state in an angle bin, after it was long seen without its neighbour.

    Every third angle bin is seen without those beside it for ten half-lives, while the old state stands or already
    the new one; then all are seen together for ten.
    """
    scene = _Scene(level, (0.1,), 1.0, nodes)
    ten = math.ceil(10 * level.half_life)
    scene.show(_OLD, ten)
    scene.seen[:] = np.arange(_ANGLE_BINS) % 3 == 0
    scene.show(_OLD if first_old else _NEW, ten)
    alone = 1.0 if first_old else float(scene.new()[1][::3].min())
    scene.seen[:] = 1.0
    scene.show(_NEW, ten)
    return min(alone, float(scene.new()[1].min()))


def _cases(scale: Scale) -> Iterator[tuple[Level, _Steps]]:
    for window, half_life in scale.pick(_IN_SCANS, ((7, 50.0), (25, 20.0), (100, 200.0))):
        yield Level("level", window, half_life), (0.1,)
    for window, seconds, steps in scale.pick(_IN_SECONDS, _IN_SECONDS[1:2]):
        yield Level("level", window, seconds, in_seconds=True), steps


def _both(scale: Scale) -> tuple[Level, ...]:
    levels = (Level("mid", 25, 20.0), Level("mid", 50, 35.0), Level("long", 100, 277.0))
    return scale.pick(levels, levels[:1])


def _sentences(nodes: int, numbers: dict[str, float]) -> tuple[str, ...]:
    return (
        "A surface at 3 m gives way to one at 2 m at levels that have known it for five half-lives. "
        "*Window*: when half of what the level knows is new. *Estimate*: when half "
        "of the angle bins show it. Both by the half-life that was stated: 1.00 is right. Neighbours are "
        "seen together where both are seen, and each angle bin in all, three "
        f"quarters or half of the scans. Means over {nodes} nodes, of windows below {_MANY} over more. In time, an "
        "absence counts 10 s: the last three rows are scans 0.5 and 5 s apart in turns, with a day between "
        "every ten, and one in ten minutes.",
        f"Window {numbers['window least']:.2f} to {numbers['window most']:.2f}, estimate "
        f"{numbers['estimate least']:.2f} to {numbers['estimate most']:.2f} (bar: 0.9 to 1.1).",
        "Seen without its neighbour for ten half-lives, then with it for ten, an angle bin shows the new "
        "state, and so does the neighbour, in "
        f"{100 * numbers['apart']:.0f} % of the nodes (also where the change came while it was seen "
        "alone).",
    )  # fmt: skip


def _table(cases: Sequence[tuple[Level, _Steps]], found: Sequence[Sequence[Ratio]]) -> Table:
    kinds: dict[str, Callable[[Ratio], float]] = {
        "window": lambda ratio: ratio.window,
        "estimate": lambda ratio: ratio.estimate,
    }
    return Table(
        (
            "window [samples], half-life",
            *(f"{kind}, {seen:.0%} of scans" for kind in kinds for seen in _VIEWS),
        ),
        [
            (
                f"{level.window}, {level.half_life:g} {'s' if level.in_seconds else 'scans'}",
                *(share(kind(ratio)) for kind in kinds.values() for ratio in row),
            )
            for (level, _), row in zip(cases, found, strict=True)
        ],
    )


def _young_table(young: Sequence[tuple[int, float, float]]) -> Table:
    return Table(
        ("scans seen before", "gives way after [scans]", "by its law", "ratio"),
        [
            (str(history), number(took, 0), number(due, 0), share(took / due))
            for history, took, due in young
        ],
        f"A young memory (window {_YOUNG.window}, half-life {_YOUNG.half_life:g} scans). Its law: the "
        "plain majority of all it was shown, up to 1/u = "
        f"{_YOUNG.window / _YOUNG.places_replaced(1.0):.0f} scans; from then on the old part decays with "
        "the half-life.",
    )  # fmt: skip


def _draw(young: Sequence[tuple[int, float, float]], canvas: "Canvas") -> None:
    axes = canvas.subplots()
    histories: npt.NDArray[np.int64] = np.arange(1, young[-1][0] + 1)
    axes.plot(histories, [young_law(_YOUNG, int(h)) for h in histories], label="law")
    axes.plot([y[0] for y in young], [y[1] for y in young], "o", label="measured")
    axes.set_xlabel("scans in which the old state was seen")
    axes.set_ylabel("gives way after [scans]")
    axes.legend()
