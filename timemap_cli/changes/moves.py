"""A thing that vanished here and appeared there in the same shape has moved."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from timemap_cli.changes.bins import step
from timemap_cli.changes.rectangle import rectangle_sides
from timemap_cli.changes.rings import Floats
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run
from timemap_cli.changes.sides import Side
from timemap_cli.model.elementary import lengths


class Outlined(Protocol):
    """Something with an outline."""

    @property
    def points(self) -> Floats:
        """(n, 2) [m, map frame]."""

    @property
    def alone(self) -> bool:
        """Whether it was seen whole, with something farther on either side."""


def pair_moves(gone: Sequence[Outlined], come: Sequence[Outlined], rules: Rules) -> list[tuple[int, int]]:
    """Indices (gone, come) of things that only moved, each used once.

    Both stand alone and have the same least rectangle round them, and neither fits a second partner. One face says
    little: where two sides were not seen, they lie at most `move_max_m` apart. What is in doubt stays one thing
    vanished and one appeared, and so does what is long and stands across now.
    """
    sides = [[rectangle_sides(thing.points) for thing in things] for things in (gone, come)]
    fits = [
        (v, a)
        for v, left in enumerate(gone)
        for a, entered in enumerate(come)
        if _is_same(sides[0][v], sides[1][a], rules)
        and _lies_alike(left, entered, rules)
        and (_is_near(left, entered, rules) or min(sides[0][v][1], sides[1][a][1]) >= rules.move_two_sides_m)
    ]
    gone_uses, come_uses = [v for v, _ in fits], [a for _, a in fits]
    return [
        (v, a)
        for v, a in fits
        if gone_uses.count(v) == 1 and come_uses.count(a) == 1 and gone[v].alone and come[a].alone
    ]


def stands_alone(runs: Sequence[Run], having: Side, rules: Rules) -> bool:
    """True where some node saw a thing in one run whose surface ends on both sides: within two bins one sees past it.

    A part of something larger that was only shifted along itself does not stand alone.
    """
    rows = [run.row for run in runs]
    return any(rows.count(run.row) == 1 and _ends_on_both_sides(run, having, rules) for run in runs)


def _ends_on_both_sides(run: Run, having: Side, rules: Rules) -> bool:
    ring = having.rings.ranges[run.row]
    for edge, outward in ((run.bins[0], (-1, -2)), (run.bins[-1], (1, 2))):
        beside = ring[(edge + np.array(outward)) % having.places.angle_bins]
        if not np.any(beside > ring[edge] + step(ring[edge], rules)):
            return False
    return True


def _is_near(gone: Outlined, come: Outlined, rules: Rules) -> bool:
    apart = gone.points.mean(axis=0) - come.points.mean(axis=0)
    return bool(lengths(apart) <= rules.move_max_m)


def _lies_alike(gone: Outlined, come: Outlined, rules: Rules) -> bool:
    """Whether the bounds of both are of nearly one size: a change names the place that was left by a point alone."""
    extents = [np.ptp(thing.points, axis=0) for thing in (gone, come)]
    return bool((np.abs(extents[0] - extents[1]) <= rules.move_turned_m).all())


def _is_same(one: tuple[float, float], other: tuple[float, float], rules: Rules) -> bool:
    """Whether two rectangles, given by their sides [m], are as good as one."""
    return all(
        abs(a - b) <= max(rules.move_shape_m, rules.move_shape_share * max(a, b))
        for a, b in zip(one, other, strict=True)
    )
