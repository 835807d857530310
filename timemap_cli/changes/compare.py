"""What differs between two estimates of the same nodes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from timemap_cli.changes.apart import stands_apart
from timemap_cli.changes.bins import lost_bins
from timemap_cli.changes.difference import Change, ComparedNode, Difference, Kind, Sector
from timemap_cli.changes.moves import pair_moves
from timemap_cli.changes.rings import Places, Rings, comparable, place, stack
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run, find_runs
from timemap_cli.changes.things import Thing, link
from timemap_cli.changes.vote import is_believed
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.ordering import to_order

_DEFAULT = Rules()


def compare(
    nodes: Sequence[Node],
    old: Mapping[int, Estimate],
    new: Mapping[int, Estimate],
    rules: Rules = _DEFAULT,
    *,
    radius: float,
    only_renewed: bool = False,
) -> Difference:
    """Changes from `old` to `new`, both by node number; `radius` [m] is how far a node sees.

    With `only_renewed` (two times of one level) a node with the same stamp on both sides was not seen in
    between and says nothing: it reports no change, and has no vote on its neighbours' reports. Do not set it
    for two levels of one time: they may well have learnt from the same scan last. Raises ValueError where
    rings differ in their number of angle bins.
    """
    numbers = comparable(old, new, only_renewed)
    silent = tuple(sorted((old.keys() | new.keys()) - set(numbers)))
    if not numbers:
        return Difference((), (), silent, 0)
    places = place(nodes, numbers, _angle_bins(numbers, old, new), radius)
    before, after = stack(old, numbers), stack(new, numbers)
    vanished = _things(before, after, places, rules)
    appeared = _things(after, before, places, rules)
    moves = pair_moves(vanished, appeared, before, after, places, rules)
    tell = _Teller(places, before, after)
    changes = [tell.moved(vanished[v], appeared[a]) for v, a in moves]
    changes += [tell.one(Kind.VANISHED, t) for v, t in enumerate(vanished) if v not in {v for v, _ in moves}]
    changes += [tell.one(Kind.APPEARED, t) for a, t in enumerate(appeared) if a not in {a for _, a in moves}]
    changes.sort(key=_largest_first)
    compared = before.firm(rules, rules.min_samples) & after.firm(rules, rules.min_samples)
    per_node = _count_bins(numbers, compared.sum(axis=1).tolist(), vanished + appeared)
    return Difference(tuple(changes), per_node, silent, places.angle_bins)


def _largest_first(change: Change) -> tuple[float, str, float, float]:
    return -to_order(change.size_m), change.kind.value, to_order(change.x), to_order(change.y)


def _angle_bins(numbers: Sequence[int], old: Mapping[int, Estimate], new: Mapping[int, Estimate]) -> int:
    sizes = sorted({len(side[n].ranges) for side in (old, new) for n in numbers})
    if len(sizes) > 1:
        raise ValueError(f"estimates of {' and '.join(map(str, sizes))} angle bins cannot be compared")
    return sizes[0]


def _things(having: Rings, lacking: Rings, places: Places, rules: Rules) -> list[Thing]:
    """What `having` has and `lacking` has not."""
    lost = lost_bins(having, lacking, places, rules)
    found = find_runs(lost, having.ranges, places, rules)
    runs = [run for run in found if stands_apart(run, lacking, places, rules)]
    return [
        thing
        for thing in link(runs, rules.link_m)
        if len(thing.points) >= rules.min_thing_bins and is_believed(thing, having, lacking, places, rules)
    ]


def _count_bins(
    numbers: Sequence[int], compared: Sequence[int], things: Sequence[Thing]
) -> tuple[ComparedNode, ...]:
    changed = [0] * len(numbers)
    for thing in things:
        for run in thing.runs:
            changed[run.row] += len(run.bins)
    return tuple(ComparedNode(n, c, d) for n, c, d in zip(numbers, compared, changed, strict=True))


class _Teller:
    """Tells things as changes."""

    def __init__(self, places: Places, before: Rings, after: Rings) -> None:
        self._places = places
        self._before = before
        self._after = after

    def one(self, kind: Kind, thing: Thing) -> Change:
        """A thing that appeared or vanished."""
        x, y = thing.points.mean(axis=0).tolist()
        x_min, y_min = thing.points.min(axis=0).tolist()
        x_max, y_max = thing.points.max(axis=0).tolist()
        sectors = sorted((self._sector(run) for run in thing.runs), key=lambda s: (s.node, s.start_bin))
        bounds = (x_min, y_min, x_max, y_max)
        return Change(kind, x, y, bounds, self._support(thing.runs), tuple(sectors), thing.points)

    def moved(self, gone: Thing, come: Thing) -> Change:
        """A thing that left one place for another."""
        here = self.one(Kind.MOVED, come)
        there = self.one(Kind.MOVED, gone)
        sectors = sorted(here.sectors + there.sectors, key=lambda s: (s.node, s.start_bin))
        support = self._support(gone.runs + come.runs)
        return replace(
            here,
            support=support,
            sectors=tuple(sectors),
            moved_from=(there.x, there.y),
            points_before=there.points,
        )

    def _sector(self, run: Run) -> Sector:
        return Sector(
            node=int(self._places.numbers[run.row]),
            start_bin=int(run.bins[0]),
            stop_bin=int(run.bins[-1]) + 1,
            range_from_m=_lower_median(self._before, run),
            range_to_m=_lower_median(self._after, run),
        )

    def _support(self, runs: Sequence[Run]) -> float:
        weaker = [
            np.minimum(self._before.support[run.row, run.bins], self._after.support[run.row, run.bins])
            for run in runs
        ]
        return float(np.concatenate(weaker).mean())


def _lower_median(side: Rings, run: Run) -> float:
    ranges = np.sort(side.ranges[run.row, run.bins])
    return float(ranges[(len(ranges) - 1) // 2])
