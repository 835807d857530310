"""The newest estimates of all levels around the nodes that were just renewed."""

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

import numpy as np

from timemap_cli.changes.rings import Floats, Ints, Places, Rings, place, stack
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import Words, words
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node


@dataclass(frozen=True, slots=True)
class View:
    """Nodes that every level knows, near those just renewed."""

    newest: Mapping[str, Mapping[int, Estimate]]  # by level and node
    renewed: frozenset[int]  # numbers of the nodes just renewed
    places: Places
    rings: Mapping[str, Rings]  # of the renewed nodes alone, in the order of `places`
    stamps_ns: Ints  # (rows,) newest scan of each renewed node at the fastest level

    @classmethod
    def around(
        cls,
        renewed: AbstractSet[int],
        nodes: Sequence[Node],
        newest: Mapping[str, Mapping[int, Estimate]],
        levels: Sequence[str],
        radius: float,
    ) -> "View | None":
        """The view from the renewed nodes; None if there is none that every level knows."""
        known = sorted(set.intersection(*(set(newest[level]) for level in levels)))
        rows = [number for number in known if number in renewed]
        if not rows:
            return None
        centres = np.array([(node.x, node.y) for node in nodes])
        near = _near(centres, rows, radius).intersection(known)
        local = {level: {n: newest[level][n] for n in sorted(near)} for level in levels}
        rings = {level: stack(newest[level], rows) for level in levels}
        places = place(nodes, rows, rings[levels[0]].ranges.shape[1], radius)
        stamps_ns = np.array([newest[levels[0]][n].stamp_ns for n in rows], np.int64)
        return cls(local, frozenset(rows), places, rings, stamps_ns)

    def words(self, points: Floats, level: str, rules: Rules) -> Words:
        """What each renewed node (rows,) says of a surface at a level."""
        return words(points, self.rings[level], self.places, rules)

    def words_before(self, points: Floats, before: Mapping[int, Estimate], rules: Rules) -> Words:
        """What the renewed nodes that have earlier estimates said of a surface by them."""
        known = np.isin(self.places.numbers, list(before))
        rows = self.places.numbers[known]
        places = replace(self.places, numbers=rows, centres=self.places.centres[known])
        return words(points, stack(before, rows.tolist()), places, rules)


def _near(centres: Floats, rows: Sequence[int], radius: float) -> set[int]:
    """Numbers of the nodes within the radius of one of `rows`."""
    low, high = centres[rows].min(axis=0) - radius, centres[rows].max(axis=0) + radius
    inside = np.flatnonzero(((centres >= low) & (centres <= high)).all(axis=1))
    apart = centres[inside, None, :] - centres[rows]
    reach = (apart * apart).sum(axis=2).min(axis=1) <= radius * radius
    return set(inside[reach].tolist())
