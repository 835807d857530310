"""What the nodes that were just renewed say: only they may judge, the others have not looked."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

import numpy as np

from timemap_cli.changes.rings import Floats, Ints, Places, Rings, place, stack
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import Words, words
from timemap_cli.model.elementary import lengths
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node


@dataclass(frozen=True, slots=True)
class View:
    """The renewed nodes that every level knows."""

    estimates: Mapping[str, Mapping[int, Estimate]]  # by level and node
    places: Places
    rings: Mapping[str, Rings]  # by level, in the order of `places`
    stamps_ns: Ints  # (rows,) newest scan of each node at the fastest level

    @classmethod
    def of(
        cls,
        renewed: AbstractSet[int],
        nodes: Sequence[Node],
        newest: Mapping[str, Mapping[int, Estimate]],
        levels: Sequence[str],
        radius: float,
    ) -> "View | None":
        """The view from the renewed nodes; None if there is none that every level knows."""
        rows = sorted(number for number in renewed if all(number in newest[level] for level in levels))
        if not rows:
            return None
        estimates = {level: {number: newest[level][number] for number in rows} for level in levels}
        rings = {level: stack(estimates[level], rows) for level in levels}
        places = place(nodes, rows, rings[levels[0]].ranges.shape[1], radius)
        stamps_ns = np.array([estimates[levels[0]][number].stamp_ns for number in rows], np.int64)
        return cls(estimates, places, rings, stamps_ns)

    def words(self, points: Floats, level: str, rules: Rules) -> Words:
        """What each node (rows,) says of a surface at a level."""
        return words(points, self.rings[level], self.places, rules)

    def has_in_reach(self, node: Node) -> bool:
        """Whether something that a node sees may be in sight of one of the renewed nodes."""
        away = lengths(self.places.centres - np.array((node.x, node.y)))
        return bool(away.min() <= 2 * self.places.radius)
