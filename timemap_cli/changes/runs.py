"""Neighbouring changed angle bins of one node, taken together."""

from dataclasses import dataclass

import numpy as np

from timemap_cli.changes.rings import Bools, Floats, Ints, Places
from timemap_cli.changes.rules import Rules


@dataclass(frozen=True, slots=True)
class Run:
    """Changed bins of one row, counter-clockwise; a circular stretch that may pass bearing 0."""

    row: int
    bins: Ints  # (n,) in [0, angle_bins), in order along the stretch
    points: Floats  # (n, 2) [m] map frame, the surface on the side that has it


def find_runs(lost: Bools, ranges: Floats, places: Places, rules: Rules) -> list[Run]:
    """Stretches of `lost` bins along a surface at `ranges`, both (rows, angle_bins); too small ones left out.

    The circle is closed: a stretch over bearing 0 is one run.
    """
    rows, bins = np.nonzero(lost)
    if not len(rows):
        return []
    surface = ranges[rows, bins]
    labels, unrolled = _label(rows, bins, surface, places.angle_bins, rules)
    order = np.lexsort((unrolled, labels))
    starts = np.flatnonzero(np.diff(labels[order], prepend=-1))
    sizes = np.diff(np.append(starts, len(order)))
    along = unrolled[order]
    spans = along[starts + sizes - 1] - along[starts] + 1
    arcs = spans * places.bin_rad * np.add.reduceat(surface[order], starts) / sizes
    kept = (sizes >= rules.min_bins) & (arcs >= rules.min_arc_m)
    parts = (order[start : start + size] for start, size in zip(starts[kept], sizes[kept], strict=True))
    return [Run(int(rows[i[0]]), bins[i], places.points(int(rows[i[0]]), bins[i], surface[i])) for i in parts]


def _label(rows: Ints, bins: Ints, surface: Floats, angle_bins: int, rules: Rules) -> tuple[Ints, Ints]:
    """Number of the run of each bin, and its bin counted on past bearing 0 where its run goes on there."""
    reach = rules.max_gap_bins + 1
    new_row = np.diff(rows) != 0
    cut = new_row | (np.diff(bins) > reach) | (np.abs(np.diff(surface)) >= rules.max_jump_m)
    labels = np.concatenate(([0], np.cumsum(cut)))
    first = np.concatenate(([0], np.flatnonzero(new_row) + 1))
    last = np.concatenate((first[1:] - 1, [len(rows) - 1]))
    over = (
        (bins[first] + angle_bins - bins[last] <= reach)
        & (np.abs(surface[first] - surface[last]) < rules.max_jump_m)
        & (labels[first] != labels[last])
    )
    goes_on = np.arange(labels[-1] + 1)
    goes_on[labels[first[over]]] = labels[last[over]]
    joined = goes_on[labels]
    return joined, np.where(joined != labels, bins + angle_bins, bins)
