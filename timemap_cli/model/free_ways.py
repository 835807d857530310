"""Whether the straight way from the laser to its node is known to be free of walls.

A robot that sees 180 degrees seldom sees the node that it stands beside. But a near node may as well stand on the
other side of a wall. The way is free where the robot stands, where this scan or one of those shortly before it saw
past, and where the robot itself has just driven. Several scanners of a robot look to different sides: what one has
seen counts for the others.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.angles import quarter_turns
from timemap_cli.model.elementary import distance
from timemap_cli.model.state import State, prefixed, without_prefix
from timemap_cli.model.sweeps import Sweeps

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

ROBOT_RADIUS = 0.25  # [m] so far round a place where the laser was there is no wall
KEPT_VIEWS = 16  # so many earlier scans are looked at ...
KEPT_TRAVEL = 0.2  # [m] ... each so far from the one before it ...
COS_KEPT_TURN = math.sqrt(0.75)  # ... or turned by 30 degrees
LONGEST_MOVE = 2.0  # [m] between two scans; more is a jump of the pose, or a gap in the recording
LONGEST_PAUSE_NS = 1_000_000_000  # between scans of two scanners, in which the robot stays where it is ...
LONGEST_STRIDE = (
    1.0  # [m] ... or between two scans of one, in which it drives straight, if it turns less than a view
)

_STEPS = 24  # of a way
_CELL = math.radians(2)  # of a view; a narrower gap is not seen through
_WIDEST_SPACING = math.radians(5)  # of beams between which nothing is missed
_NOWHERE: tuple[float, ...] = (math.inf, math.inf, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class _Views:
    """How far k scans saw, from where."""

    origin: Floats  # (k, 2) [m, map frame]
    before: Floats  # (k, 2) [m] where the robot came from, straight; the origin where that is not known
    along: Floats  # (k, 2, 2) the laser's x and y axes laid flat, in columns
    depth: npt.NDArray[np.float32]  # (k, cells + 1) [m] nearest evidence of each cell of beams; -1: none

    def rows(self, rows: slice | Ints) -> "_Views":
        return _Views(self.origin[rows], self.before[rows], self.along[rows], self.depth[rows])

    def then(self, later: "_Views") -> "_Views":
        return _Views(
            np.concatenate((self.origin, later.origin)),
            np.concatenate((self.before, later.before)),
            np.concatenate((self.along, later.along)),
            np.concatenate((self.depth, later.depth)),
        )


@dataclass(frozen=True, slots=True)
class _Fan:
    """A scanner's beams, a few neighbours to a cell."""

    first: float  # [rad]
    step: float  # [rad] from beam to beam, negative if clockwise
    beams: int
    group: int  # beams to a cell

    @classmethod
    def of(cls, bearings: Floats) -> "_Fan":
        step = float(bearings[-1] - bearings[0]) / max(1, len(bearings) - 1) or _CELL
        return cls(float(bearings[0]), step, len(bearings), max(1, round(_CELL / abs(step))))

    def depths(self, sweeps: Sweeps) -> npt.NDArray[np.float32]:
        """Nearest evidence (n, cells + 1) [m] of each cell; -1 if there is none, as beside the field of view."""
        starts = np.arange(0, self.beams, self.group)
        depth = np.full((len(sweeps), len(starts) + 1), -1, np.float32)
        nearest = np.fmin.reduceat(sweeps.ranges, starts, axis=1)
        np.minimum(nearest, np.float32(sweeps.clear_range), out=nearest)
        depth[:, :-1] = np.where(np.isnan(nearest), np.float32(-1), nearest)
        return depth

    def cells_towards(self, x: Floats, y: Floats) -> Ints:
        """Cell of each direction in the laser's plane; the last one beside the field of view."""
        bearing = quarter_turns(x.astype(np.float32), y.astype(np.float32)) * np.float64(math.pi / 2)
        turn = math.tau / abs(self.step)  # in beams
        place = (bearing - self.first) / self.step + 0.5
        place -= np.floor(place / turn) * turn
        beside = -(-self.beams // self.group)
        off_beam = np.abs(place - np.floor(place) - 0.5) * abs(self.step)
        looks_there = (place < self.beams) & (off_beam <= _WIDEST_SPACING / 2)
        cell = np.where(looks_there, np.floor(place / self.group), beside)
        return np.nan_to_num(cell, nan=beside).astype(np.int64)


@dataclass(frozen=True, slots=True)
class _Trail:
    """What a scanner saw on its way here."""

    fan: _Fan
    kept: _Views
    newest: tuple[float, ...]  # x, y [m] of the newest scan, and the direction of the laser's x axis
    stamp_ns: int


@dataclass(frozen=True, slots=True)
class Outlook:
    """What n scans of one scanner know of the ways around them."""

    sweeps: Sweeps
    fan: _Fan
    views: _Views  # of the scans themselves
    kept: _Views  # of the scanner, until now
    begin: Ints  # (n,) the first of those that a scan may look at
    end: Ints  # (n,) behind the last of them
    others: Sequence[_Trail]  # of the robot's other scanners

    def free(self, rows: Ints, centres: Floats) -> Bools:
        """Whether the way from the laser to the node centre (k, 2) [m, map frame] is free, of the scans `rows` (k,)."""
        views = self.views.rows(rows)
        way = _points(views.origin, centres)
        passed = _inside(way, views, self.fan)
        self._look_back(rows, passed, lambda some, kept: _inside(way[some], kept, self.fan))
        doubtful = np.flatnonzero(~passed.all(axis=1))
        passed[doubtful] |= _driven(way[doubtful], views.rows(doubtful))
        self._look_back(rows, passed, lambda some, kept: _driven(way[some], kept))
        for trail in self.others:
            doubtful = np.flatnonzero(~passed.all(axis=1))
            passed[doubtful] |= _seen_by_another(trail, self.sweeps.rows(rows[doubtful]), way[doubtful])
        return np.asarray(passed.all(axis=1))

    def _look_back(self, rows: Ints, passed: Bools, steps: Callable[[Ints, _Views], Bools]) -> None:
        """Add what the kept views know, the newest first, of ways of which some step is not `passed`, in place."""
        begin, end = self.begin[rows], self.end[rows]
        doubtful = np.arange(len(rows))
        for back in range(1, KEPT_VIEWS + 1):
            doubtful = doubtful[~passed[doubtful].all(axis=1) & (end[doubtful] - back >= begin[doubtful])]
            if not len(doubtful):
                break
            passed[doubtful] |= steps(doubtful, self.kept.rows(end[doubtful] - back))

    def are_blocked(self, rows: Ints, centres: Floats) -> Bools:
        """Whether the scans `rows` (k,) hit something between the laser and the centre (k, 2) [m, map frame]."""
        views = self.views.rows(rows)
        offset = (centres - views.origin)[:, None]
        depth, distance = _towards(offset[..., 0], offset[..., 1], views, self.fan)
        return np.asarray((depth >= 0) & (depth < distance))[:, 0]


class FreeWays:
    """Remembers, for each scanner, the views of the last few metres."""

    def __init__(self) -> None:
        self._trails: dict[int, _Trail] = {}

    def look(self, sweeps: Sweeps) -> "Outlook":
        """What the scans of a block know of the ways around them. Blocks must come in stamp order."""
        fan = _Fan.of(sweeps.bearings)
        origin, along = _placed(sweeps)
        views = _Views(origin, self._before(sweeps, origin, along), along, fan.depths(sweeps))
        others = [trail for scanner, trail in self._trails.items() if scanner != sweeps.scanner]
        return Outlook(sweeps, fan, views, *self._keep(sweeps, views, fan), others)

    def kept(self) -> State:
        """The views of all scanners, for `restore`."""
        state: State = {"scanners": list(self._trails)}
        for scanner, trail in self._trails.items():
            fan = trail.fan.first, trail.fan.step, trail.fan.beams, trail.fan.group
            kept = trail.kept
            views = {"origin": kept.origin, "before": kept.before, "along": kept.along, "depth": kept.depth}
            newest = {"newest": np.array(trail.newest), "stamp_ns": trail.stamp_ns, "fan": list(fan)}
            state |= prefixed(str(scanner), views | newest)
        return state

    def restore(self, state: State) -> None:
        """Take over the views that another one kept."""
        for scanner in state["scanners"]:
            found = without_prefix(str(scanner), state)
            views = _Views(*(found[name] for name in ("origin", "before", "along", "depth")))
            newest = tuple(found["newest"].tolist())
            self._trails[scanner] = _Trail(_Fan(*found["fan"]), views, newest, found["stamp_ns"])

    def _before(self, sweeps: Sweeps, origin: Floats, along: Floats) -> Floats:
        """Where the robot drove straight from (n, 2) [m] to each scan; the scan's own place where it did not.

        That is the place of the scan before, a moment ago: a robot that hardly turned went round no wall's end.
        """
        newest, stamp_ns = _NOWHERE, 0
        if (trail := self._trails.get(sweeps.scanner)) is not None:
            newest, stamp_ns = trail.newest, trail.stamp_ns
        place, ahead = np.vstack((newest[:2], origin)), np.vstack((newest[2:], along[:, :, 0]))
        since_ns = np.diff(np.append(stamp_ns, sweeps.stamps_ns))
        straight = (ahead[1:] * ahead[:-1]).sum(axis=1) >= COS_KEPT_TURN
        straight &= ((place[1:] - place[:-1]) ** 2).sum(axis=1) <= LONGEST_STRIDE**2
        straight &= (since_ns >= 0) & (since_ns <= LONGEST_PAUSE_NS)
        return np.where(straight[:, None], place[:-1], origin)

    def _keep(self, sweeps: Sweeps, views: _Views, fan: _Fan) -> tuple[_Views, Ints, Ints]:
        """The views kept before and in this block, and which of them each scan may look at: [begin, end) (n,)."""
        trail = self._trails.get(sweeps.scanner)
        if trail is None or trail.kept.depth.shape[1] != views.depth.shape[1]:
            trail = _Trail(fan, views.rows(slice(0, 0)), _NOWHERE, 0)
        chosen: list[int] = []
        begin, end = np.zeros(len(sweeps), np.int64), np.zeros(len(sweeps), np.int64)
        first, before = 0, len(trail.kept.origin)
        newest, stamp_ns = trail.newest, trail.stamp_ns
        last = (*trail.kept.origin[-1], *trail.kept.along[-1, :, 0]) if before else None
        rows = np.column_stack((views.origin, views.along[:, :, 0])).tolist()
        for i, (row, now_ns) in enumerate(zip(rows, sweeps.stamps_ns.tolist(), strict=True)):
            if now_ns < stamp_ns or not _apart(newest, row) <= LONGEST_MOVE:
                first, last = before + len(chosen), None
            begin[i], end[i] = first, before + len(chosen)
            if last is None or _is_another_view(last, row):
                chosen.append(i)
                last = tuple(row)
            newest, stamp_ns = tuple(row), now_ns
        kept = trail.kept.then(views.rows(np.array(chosen, np.int64)))
        stays = slice(max(first, len(kept.origin) - KEPT_VIEWS), None)
        self._trails[sweeps.scanner] = _Trail(fan, kept.rows(stays), newest, stamp_ns)
        return kept, begin, end


def _placed(sweeps: Sweeps) -> tuple[Floats, Floats]:
    """Where the lasers are (n, 2) [m, map frame], and their x and y axes laid flat (n, 2, 2), in columns."""
    pose = sweeps.map_from_laser_first
    return pose[:, :2, 3], pose[:, :2, :2]


def _apart(one: Sequence[float], other: Sequence[float]) -> float:
    return distance(other[0] - one[0], other[1] - one[1])


def _is_another_view(last: tuple[float, ...], row: list[float]) -> bool:
    turned = last[2] * row[2] + last[3] * row[3] < COS_KEPT_TURN
    return turned or _apart(last, row) >= KEPT_TRAVEL


def _points(origin: Floats, centres: Floats) -> Floats:
    """Points (n, steps + 1, 2) [m, map frame] from the laser to the node."""
    part = np.arange(_STEPS + 1)[:, None] / _STEPS
    return np.asarray(origin[:, None] + part * (centres - origin)[:, None])


def _seen_by_another(trail: _Trail, sweeps: Sweeps, way: Floats) -> Bools:
    """Steps (n, steps) of each scan's way that another scanner of the robot has seen free until now.

    The robot itself lies between the two: there is no wall.
    """
    lasers = sweeps.map_from_laser_first[:, :2, 3]
    there = np.array(trail.newest[:2])
    passed = np.zeros((len(way), _STEPS), np.bool_)
    since_ns = sweeps.stamps_ns - trail.stamp_ns
    away = np.sqrt(((lasers - there) ** 2).sum(axis=1))
    rows = np.flatnonzero((since_ns >= 0) & (away <= LONGEST_MOVE))
    for one in range(len(trail.kept.origin) if len(rows) else 0):
        passed[rows] |= _inside(way[rows], trail.kept.rows(np.full(len(rows), one)), trail.fan)
    rows = rows[since_ns[rows] <= LONGEST_PAUSE_NS]
    passed[rows] |= _between(way[rows], lasers[rows], np.broadcast_to(there, (len(rows), 2)))
    return passed


def _driven(way: Floats, views: _Views) -> Bools:
    """Steps (n, steps) of each way along which the robot came to one view."""
    return _between(way, views.before, views.origin)


def _between(way: Floats, one: Floats, other: Floats) -> Bools:
    """Steps (n, steps) of each way whose ends lie within the robot's radius of the line between two places (n, 2)."""
    along = (other - one)[:, None]
    length = (along**2).sum(axis=2)
    share = ((way - one[:, None]) * along).sum(axis=2) / np.where(length > 0, length, 1)
    foot = one[:, None] + np.clip(share, 0, 1)[..., None] * along
    holds = ((way - foot) ** 2).sum(axis=2) <= ROBOT_RADIUS**2
    return np.asarray(holds[:, :-1] & holds[:, 1:])


def _inside(way: Floats, views: _Views, fan: _Fan) -> Bools:
    """Steps (n, steps) of each way whose two ends one view holds: no wall fits in between.

    A view holds what it saw free, and the place of the robot.
    """
    dx, dy = (way[:, :, axis] - views.origin[:, None, axis] for axis in (0, 1))
    holds = dx * dx + dy * dy <= ROBOT_RADIUS**2
    depth, distance = _towards(dx, dy, views, fan)
    with np.errstate(invalid="ignore"):
        holds |= depth > distance
    return np.asarray(holds[:, :-1] & holds[:, 1:])


def _towards(dx: Floats, dy: Floats, views: _Views, fan: _Fan) -> tuple[npt.NDArray[np.float32], Floats]:
    """How far each view saw towards points (n, k) [m, from the laser, map frame], and how far they are in its plane."""
    (xx, xy), (yx, yy) = views.along.transpose(1, 2, 0)[..., None]
    upright = xx * yy - xy * yx
    with np.errstate(divide="ignore", invalid="ignore"):  # a laser whose plane is vertical sees no way
        u, v = (yy * dx - xy * dy) / upright, (xx * dy - yx * dx) / upright
        cell = fan.cells_towards(u, v)
        return np.take_along_axis(views.depth, cell, axis=1), np.sqrt(u * u + v * v)
