"""The rings of a level on both sides, of the nodes that both have."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.verdict import Spot
from timemap_cli.model.ordering import to_order

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

SHOWN = 5  # spots: more do not help to find the cause


@dataclass(frozen=True, slots=True)
class Pair:
    """Rings side by side, a row per node; a node that a side does not know has unknown bins."""

    expected: Floats  # (nodes, angle_bins) [m]; +inf clear, NaN unknown
    found: Floats  # (nodes, angle_bins) [m]
    centres: Floats  # (nodes, 2) [m] map frame, of the result
    apart: Floats  # (nodes, 2) [m] from the result's node to the baseline's
    numbers: tuple[int, ...]  # of the nodes in the baseline

    @property
    def both(self) -> Bools:
        """(nodes, angle_bins) known to both."""
        return np.asarray(~np.isnan(self.expected) & ~np.isnan(self.found))

    def node_spots(self, rows: Ints, values: Floats, told: Callable[[float], str]) -> tuple[Spot, ...]:
        """The nodes, by their rows, with the greatest values; `told` puts a value into words."""
        order = sorted(range(len(values)), key=lambda i: -to_order(float(values[i])))[:SHOWN]
        return tuple(
            Spot(
                float(self.centres[row, 0]),
                float(self.centres[row, 1]),
                f"node {self.numbers[row]}: {told(value)}",
                (self.numbers[row],),
            )
            for row, value in ((int(rows[i]), float(values[i])) for i in order)
            if value > 0
        )
