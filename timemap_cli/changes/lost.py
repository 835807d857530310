"""What one side has and the other has not."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from timemap_cli.changes.looks import looks
from timemap_cli.changes.moves import stands_alone
from timemap_cli.changes.nearby import near
from timemap_cli.changes.rings import Bools, Floats, Ints
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run, find_runs
from timemap_cli.changes.sides import Side
from timemap_cli.changes.testimony import Testimony, testimony
from timemap_cli.changes.things import Thing, link
from timemap_cli.model.elementary import lengths

_BETWEEN = (0.25, 0.5, 0.75)  # of the way from one end to the next


@dataclass(frozen=True, slots=True)
class Agreement:
    """Share of all looks at a thing that must say so, on either side."""

    having: float
    lacking: float


@dataclass(frozen=True, slots=True)
class Lost:
    """The things that one side has and the other sees past."""

    things: tuple[Thing, ...]
    told: Bools  # (rows, angle_bins) ends of the side that has them of which the other side can tell


def lost_things(
    having: Side, lacking: Side, rules: Rules, agreement: Agreement, among: Bools | None = None
) -> Lost:
    """What stands by the looks of `having` and is gone by those of `lacking`; only `among` these angle bins.

    Nodes turn one after the other, so what is contested belongs together, and all looks at a thing decide on it as a
    whole. What lies on a surface that stands on the other side is not lost, and nor is what no node of the
    other side sees past in enough neighbouring angle bins.
    """
    rows, bins = np.nonzero(having.shows_surface if among is None else having.shows_surface & among)
    points = having.ends(rows, bins)
    heard = testimony(points, lacking, rules)
    told = np.zeros(having.firm.shape, np.bool_)
    told[rows[heard.told], bins[heard.told]] = True
    doubtful = np.flatnonzero(heard.contradicted(rules.min_contested))
    if len(doubtful) < rules.min_bins:
        return Lost((), told)
    own = testimony(points[doubtful], having, rules)
    stood = ~own.contradicted(1 - rules.min_contested)
    doubtful, own = doubtful[stood], own.part(stood)
    standing = _standing_near(points[doubtful], lacking, rules)
    apart = ~near(points[doubtful], standing, rules.min_apart_m)
    judge = _Judge(
        having, lacking, rules, agreement, rows[doubtful], bins[doubtful], apart, heard.part(doubtful), own
    )
    return Lost(tuple(judge.things()), told)


@dataclass(frozen=True, slots=True)
class _Judge:
    """Decides on contested angle bins, thing by thing."""

    having: Side
    lacking: Side
    rules: Rules
    agreement: Agreement
    rows: Ints  # (n,) of the contested angle bins
    bins: Ints  # (n,)
    apart: Bools  # (n,) the end lies on no surface that stands on the lacking side
    heard: Testimony  # of the lacking side on their ends
    own: Testimony  # of the having side

    def things(self) -> list[Thing]:
        """Those that are lost."""
        contested = np.zeros(self.having.firm.shape, np.bool_)
        number = np.zeros(contested.shape, np.int64)
        contested[self.rows, self.bins] = True
        number[self.rows, self.bins] = np.arange(len(self.rows))
        runs = [
            run
            for run in find_runs(contested, self.having.rings.ranges, self.having.places, self.rules)
            if np.count_nonzero(self.apart[number[run.row, run.bins]]) >= self.rules.min_bins
        ]
        found: list[Thing] = []
        for thing in link(runs, self.rules.link_m):
            which = np.concatenate([number[run.row, run.bins] for run in thing.runs])
            if self._is_lost(which):
                passed = _runs_past(thing.points, self.lacking, self.rules)
                alone = stands_alone(thing.runs, self.having, self.rules)
                found.append(replace(thing, passed=tuple(passed), alone=alone))
        return [thing for thing in found if thing.passed and self._is_witnessed(thing)]

    def _is_lost(self, points: Ints) -> bool:
        gone = self.heard.is_gone(points, self.agreement.lacking)
        stood = self.own.stands(points, self.agreement.having)
        return gone and stood and len(points) >= self.rules.min_thing_bins

    def _is_witnessed(self, thing: Thing) -> bool:
        """Whether more than one node shows it, or one that sees past it itself or is right about the rest around it.

        A node that was made while the robot did not know where it was shows walls beside the walls.
        """
        first, having, lacking = thing.runs[0].row, self.having.places, self.lacking.places
        if any(run.row != first for run in thing.runs):
            return True
        if any(lacking.numbers[run.row] == having.numbers[first] for run in thing.passed):
            return True
        bins = np.flatnonzero(self.having.shows_surface[first])
        ends = self.having.ends(np.full(len(bins), first), bins)
        heard = testimony(ends, self.lacking, self.rules)
        confirmed = np.count_nonzero(heard.shown > heard.past) * having.bin_rad
        return bool(confirmed >= np.radians(self.rules.lone_confirmed_deg))


def _runs_past(points: Floats, side: Side, rules: Rules) -> Sequence[Run]:
    """Where the nodes of a side see past a surface, as runs along the surface."""
    past = np.zeros(side.firm.shape, np.bool_)
    surface = np.full(side.firm.shape, np.inf)
    for look in looks(points, side, rules):
        row, angle_bin = look.rows[look.past], look.bins[look.past]
        past[row, angle_bin] = True
        np.minimum.at(surface, (row, angle_bin), look.ranges[look.past])
    return find_runs(past, surface, side.places, rules)


def _standing_near(points: Floats, side: Side, rules: Rules) -> Floats:
    """Surface points (k, 2) [m, map frame] of a side near these (n, 2) that hardly any of its nodes contradicts.

    Neighbouring ends closer than `max_jump_m` are joined: at a flat angle a surface goes on between them.
    """
    shows = side.shows_surface
    rows, bins = np.nonzero(shows)
    ends = side.ends(rows, bins)
    close = near(ends, points, rules.min_apart_m + rules.max_jump_m)
    rows, bins, ends = rows[close], bins[close], ends[close]
    contested = testimony(ends, side, rules).contradicted(rules.min_contested)
    shows[:] = False
    shows[rows[~contested], bins[~contested]] = True
    rows, bins, ends = rows[~contested], bins[~contested], ends[~contested]
    following = (bins + 1) % side.places.angle_bins
    joined = shows[rows, following]
    start, along = ends[joined], side.ends(rows[joined], following[joined]) - ends[joined]
    short = lengths(along) < rules.max_jump_m
    return np.concatenate([ends, *(start[short] + share * along[short] for share in _BETWEEN)])
