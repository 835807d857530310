"""What differs between two sides, asked of places: what one node has seen counts for what another one holds."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from timemap_cli.changes.bins import step
from timemap_cli.changes.difference import Change, ComparedNode, Difference, Kind
from timemap_cli.changes.lost import Agreement, Lost, lost_things
from timemap_cli.changes.moves import pair_moves
from timemap_cli.changes.rings import Bools, Ints
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.runs import Run, find_runs
from timemap_cli.changes.sides import Side
from timemap_cli.changes.telling import Teller
from timemap_cli.changes.testimony import testimony
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.ordering import to_order

_DEFAULT = Rules()
_CELL_M = 0.1
_CELLS = 1 << 31  # in a row, more than any map has


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

    With `only_renewed` (two times of one level) a node with the same stamp on both sides was not seen in between and
    says nothing on the newer side: others may have looked there since. Do not set it for two levels of one
    time: they may well have learnt from the same scan last. Raises ValueError where rings differ in their number of
    angle bins.
    """
    asked = {
        n: e for n, e in new.items() if not (only_renewed and n in old and old[n].stamp_ns == e.stamp_ns)
    }
    known = sorted(old.keys() | new.keys())
    if not old or not asked:
        return Difference((), (), tuple(known), 0)
    before, after = (Side.of(side, nodes, radius, rules) for side in (old, asked))
    if before.places.angle_bins != after.places.angle_bins:
        sizes = sorted((before.places.angle_bins, after.places.angle_bins))
        raise ValueError(f"estimates of {sizes[0]} and {sizes[1]} angle bins cannot be compared")
    gone = lost_things(before, after, rules, Agreement(rules.agreement_before, rules.agreement_after))
    come = lost_things(after, before, rules, Agreement(rules.agreement_after, rules.agreement_before))
    changes = _told(gone, come, before, after, rules)
    per_node = _counted(known, gone, come, before, after)
    silent = tuple(sorted(set(known) - {one.node for one in per_node}))
    return Difference(changes, per_node, silent, before.places.angle_bins)


def news(before: Side, now: Side, rules: Rules) -> tuple[Change, ...]:
    """Changes from `before` to the nodes that look `now`, as far as they show what they did not show before."""
    fresh = _fresh_bins(before, now, rules)
    seers = np.flatnonzero(fresh.any(axis=1))
    if not len(seers):
        return ()
    came = Agreement(having=rules.agreement_after, lacking=rules.agreement_before)
    went = Agreement(having=rules.agreement_before, lacking=rules.agreement_after)
    come = lost_things(now, before, rules, came, _seen_past(now, fresh, before, rules))
    anew = _seen_past(before, before.shows_surface, now.part(seers, fresh), rules)
    if anew.any():
        anew = _seen_past(before, anew, now, rules)
    gone = lost_things(before, now, rules, went, anew)
    return _told(gone, come, before, now, rules)


def _fresh_bins(before: Side, now: Side, rules: Rules) -> Bools:
    """Angle bins (rows, angle_bins) of the nodes `now`, enough side by side, that they did not show so before."""
    rows = np.searchsorted(before.places.numbers, now.places.numbers)
    rows = np.minimum(rows, len(before.places.numbers) - 1)
    known = (before.places.numbers[rows] == now.places.numbers)[:, None] & before.firm[rows]
    was, shown = before.rings.ranges[rows], now.rings.ranges
    with np.errstate(invalid="ignore"):  # clear less clear
        same = (was == shown) | (np.abs(was - shown) <= step(np.minimum(was, shown), rules))
    fresh = now.firm & ~(known & same)
    reach = np.minimum(shown, now.places.radius)
    in_runs = np.zeros(fresh.shape, np.bool_)
    for run in find_runs(fresh, np.nan_to_num(reach), now.places, replace(rules, max_jump_m=np.inf)):
        in_runs[run.row, run.bins] = True
    return in_runs


def _seen_past(having: Side, among: Bools, lacking: Side, rules: Rules) -> Bools:
    """Of `among`, the angle bins (rows, angle_bins) whose ends nodes of `lacking` see past.

    One end of each cell of 10 cm is asked for all: what is lost is larger.
    """
    rows, bins = np.nonzero(having.shows_surface & among)
    ends = having.ends(rows, bins)
    cells = np.floor(ends / _CELL_M).astype(np.int64)
    _, first, cell = np.unique(cells[:, 0] * _CELLS + cells[:, 1], return_index=True, return_inverse=True)
    past = testimony(ends[first], lacking, rules).contradicted(rules.min_contested)[cell]
    found = np.zeros(having.firm.shape, np.bool_)
    found[rows[past], bins[past]] = True
    return found


def _told(gone: Lost, come: Lost, before: Side, after: Side, rules: Rules) -> tuple[Change, ...]:
    """All changes, the largest first."""
    tell = Teller(before, after)
    moves = pair_moves(gone.things, come.things, rules)
    left, entered = {v for v, _ in moves}, {a for _, a in moves}
    changes = [tell.moved(gone.things[v], come.things[a]) for v, a in moves]
    changes += [tell.one(Kind.VANISHED, t) for v, t in enumerate(gone.things) if v not in left]
    changes += [tell.one(Kind.APPEARED, t) for a, t in enumerate(come.things) if a not in entered]
    return tuple(sorted(changes, key=_largest_first))


def _largest_first(change: Change) -> tuple[float, str, float, float]:
    return -to_order(change.size_m), change.kind.value, to_order(change.x), to_order(change.y)


def _counted(
    known: Sequence[int], gone: Lost, come: Lost, before: Side, after: Side
) -> tuple[ComparedNode, ...]:
    """How much of each node could be compared, nodes of which nothing could left out.

    An angle bin is compared where both sides know it firmly at the node itself, or where some node of the other side
    can tell of what it ends at; it is changed where it shows a reported thing or sees past it.
    """
    bins = before.places.angle_bins
    compared, changed = np.zeros((len(known), bins), np.bool_), np.zeros((len(known), bins), np.bool_)
    rows_before, rows_after = (np.searchsorted(known, side.places.numbers) for side in (before, after))
    firm_before, firm_after = np.zeros_like(compared), np.zeros_like(compared)
    firm_before[rows_before], firm_after[rows_after] = before.firm, after.firm
    compared |= firm_before & firm_after
    compared[rows_before] |= gone.told
    compared[rows_after] |= come.told & ~firm_before[rows_after]
    for having, lacking, lost in ((rows_before, rows_after, gone), (rows_after, rows_before, come)):
        _mark(changed, having, [run for thing in lost.things for run in thing.runs])
        _mark(changed, lacking, [run for thing in lost.things for run in thing.passed])
    compared |= changed
    counts = zip(known, compared.sum(axis=1).tolist(), changed.sum(axis=1).tolist(), strict=True)
    return tuple(ComparedNode(node, of, part) for node, of, part in counts if of)


def _mark(bins: Bools, rows: Ints, runs: Sequence[Run]) -> None:
    for run in runs:
        bins[rows[run.row], run.bins] = True
