"""A thing that vanished here and appeared nearby in the same shape has moved."""

from collections.abc import Sequence

import numpy as np

from timemap_cli.changes.bins import step
from timemap_cli.changes.rings import Places, Rings
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run
from timemap_cli.changes.things import Thing, distances
from timemap_cli.model.elementary import lengths


def pair_moves(
    vanished: Sequence[Thing], appeared: Sequence[Thing], old: Rings, new: Rings, places: Places, rules: Rules
) -> list[tuple[int, int]]:
    """Indices (vanished, appeared) of things that only moved, each used once.

    Cautious: at least one node, and most of those that saw both whole and alone, must have seen the same
    outline, at most `move_max_m` apart, and neither thing may fit a second partner. What is in doubt stays one
    thing vanished and one appeared.
    """
    fits = [
        (v, a)
        for v, gone in enumerate(vanished)
        for a, come in enumerate(appeared)
        if _is_near(gone, come, rules) and _is_same(gone, come, old, new, places, rules)
    ]
    gone_uses = [v for v, _ in fits]
    come_uses = [a for _, a in fits]
    return [(v, a) for v, a in fits if gone_uses.count(v) == 1 and come_uses.count(a) == 1]


def _is_near(gone: Thing, come: Thing, rules: Rules) -> bool:
    apart = gone.points.mean(axis=0) - come.points.mean(axis=0)
    return bool(lengths(apart) <= rules.move_max_m)


def _is_same(gone: Thing, come: Thing, old: Rings, new: Rings, places: Places, rules: Rules) -> bool:
    """True where most of the nodes that saw both things whole and alone, at least one, saw the same outline."""
    before = _whole_runs(gone, old, places, rules)
    after = _whole_runs(come, new, places, rules)
    shared = sorted(before.keys() & after.keys())
    same = sum(_same_outline(before[row], after[row], rules) for row in shared)
    return 2 * same > len(shared)


def _whole_runs(thing: Thing, having: Rings, places: Places, rules: Rules) -> dict[int, Run]:
    """The thing's run by row, of rows that saw it in one run, with something farther on either side."""
    rows = [run.row for run in thing.runs]
    return {
        run.row: run
        for run in thing.runs
        if rows.count(run.row) == 1 and _stands_alone(run, having, places, rules)
    }


def _stands_alone(run: Run, having: Rings, places: Places, rules: Rules) -> bool:
    """True where the surface ends on both sides: within two bins one sees past it.

    A part of something larger that was only shifted along itself does not stand alone.
    """
    ring = having.ranges[run.row]
    for edge, outward in ((run.bins[0], (-1, -2)), (run.bins[-1], (1, 2))):
        beside = ring[(edge + np.array(outward)) % places.angle_bins]
        if not np.any(beside > ring[edge] + step(ring[edge], rules)):
            return False
    return True


def _same_outline(before: Run, after: Run, rules: Rules) -> bool:
    """True where, laid on each other, no point of either is farther than `move_shape_m` from the other."""
    apart = distances(before.points - before.points.mean(axis=0), after.points - after.points.mean(axis=0))
    return bool(max(apart.min(axis=0).max(), apart.min(axis=1).max()) <= rules.move_shape_m)
