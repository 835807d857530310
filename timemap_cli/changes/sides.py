"""One side of a comparison: all its nodes with their estimates."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from timemap_cli.changes.rings import Bools, Floats, Ints, Places, Rings, place, stack
from timemap_cli.changes.rules import Rules
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node


@dataclass(frozen=True, slots=True)
class Side:
    """What the nodes of one side show, a row per node."""

    places: Places
    rings: Rings
    firm: Bools  # (rows, angle_bins) known well enough to be compared
    nearest: Floats  # (rows, angle_bins) [m] least range within `edge_deg`; NaN where none is known
    farthest: Floats  # (rows, angle_bins) [m] greatest range within `edge_deg`; NaN where none is known

    @classmethod
    def of(
        cls, estimates: Mapping[int, Estimate], nodes: Sequence[Node], radius: float, rules: Rules
    ) -> "Side":
        """The side of these estimates, by node number; at least one. `radius` [m] is how far a node sees.

        Raises ValueError where they differ in their number of angle bins.
        """
        numbers = sorted(estimates)
        rings = stack(estimates, numbers)
        places = place(nodes, numbers, rings.ranges.shape[1], radius)
        nearest = farthest = rings.ranges
        for shift in range(1, places.edge_bins(rules) + 1):
            for turned in (np.roll(rings.ranges, shift, axis=1), np.roll(rings.ranges, -shift, axis=1)):
                nearest, farthest = np.fmin(nearest, turned), np.fmax(farthest, turned)
        return cls(places, rings, rings.firm(rules, rules.min_samples), nearest, farthest)

    def part(self, rows: Ints, among: Bools) -> "Side":
        """Only these rows (k,), which are firm in no other angle bins than these (rows of all, angle_bins)."""
        places = replace(self.places, numbers=self.places.numbers[rows], centres=self.places.centres[rows])
        rings = Rings(*(getattr(self.rings, one.name)[rows] for one in fields(self.rings)))
        firm = self.firm[rows] & among[rows]
        return Side(places, rings, firm, self.nearest[rows], self.farthest[rows])

    @property
    def shows_surface(self) -> Bools:
        """Angle bins that firmly end at a surface (rows, angle_bins)."""
        return self.firm & np.isfinite(self.rings.ranges)

    def ends(self, rows: Ints, bins: Ints) -> Floats:
        """Where these angle bins (k,) end, (k, 2) [m, map frame]."""
        return self.places.points(rows, bins, self.rings.ranges[rows, bins])
