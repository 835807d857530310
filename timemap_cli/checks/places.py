"""Places of the map where several nodes agree that a surface has moved."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.surfaces import farther
from timemap_cli.model.ordering import to_order

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]

_CELL_M = 0.5  # about the size of a thing
_LEAST_ENDS = 8  # in a cell
_LEAST_IN_ALL = (
    16  # at all levels: noise makes a crowd of 8 at one now and then, the side of a sofa 30 at three
)
_SAME_M = 1.0  # places of two levels
_LEAST_NODES = 3  # people who stood about are remembered by one or two
_LEAST_SHARE = 0.4  # of the ends in the cell: along a wall single ends move at its edges


@dataclass(frozen=True, slots=True)
class Ends:
    """Ends of ranges in the map frame."""

    x: Floats  # (n,) [m]
    y: Floats  # (n,) [m]
    node: Ints  # (n,)
    distance: Floats  # (n,) [m] from the other side's surfaces

    def joined(self, other: "Ends") -> "Ends":
        """These and the others."""
        return Ends(
            np.concatenate((self.x, other.x)),
            np.concatenate((self.y, other.y)),
            np.concatenate((self.node, other.node)),
            np.concatenate((self.distance, other.distance)),
        )


@dataclass(frozen=True, slots=True)
class MovedPlace:
    """Where surfaces moved."""

    x: float  # [m] median of the ends that moved
    y: float
    ends: int  # that moved
    nodes: tuple[int, ...]  # that saw it, the one with most ends first
    distance: float  # [m] median of those that moved; +inf where nothing is left near by


def moved_places(ends: Ends, step_m: float, nodes: int) -> list[MovedPlace]:
    """The places where ends lie `step_m` and more off, most ends first; `nodes` is how many were compared."""
    which = np.flatnonzero(_crowded(ends, farther(ends.distance, step_m)))
    places = [_place(ends, which[group]) for group in _touching(ends.x[which], ends.y[which])]
    least = min(_LEAST_NODES, nodes)
    found = [place for place in places if len(place.nodes) >= least]
    return sorted(found, key=lambda place: (-place.ends, to_order(place.x), to_order(place.y)))


def confirmed(levels: Sequence[Sequence[MovedPlace]]) -> list[list[MovedPlace]]:
    """Of each level's places those that all levels together show by enough ends."""
    return [[place for place in level if _ends_in_all(place, levels) >= _LEAST_IN_ALL] for level in levels]


def _ends_in_all(place: MovedPlace, levels: Sequence[Sequence[MovedPlace]]) -> int:
    near = (
        [one.ends for one in level if np.hypot(one.x - place.x, one.y - place.y) <= _SAME_M]
        for level in levels
    )
    return sum(max(ends, default=0) for ends in near)


def _crowded(ends: Ends, moved: Bools) -> Bools:
    """Those of the moved ends (n,) in whose cell many have moved and few stayed."""
    found = np.zeros_like(moved)
    for shift in (
        (0.0, 0.0),
        (0.5, 0.0),
        (0.0, 0.5),
        (0.5, 0.5),
    ):  # a thing may lie across the borders of cells
        places = np.stack([ends.x, ends.y]) / _CELL_M + np.array(shift)[:, None]
        _, cells = np.unique(np.floor(places), axis=1, return_inverse=True)
        cells = cells.reshape(-1)
        counts = np.bincount(cells)
        hits = np.bincount(cells[moved], minlength=len(counts))
        found |= moved & ((hits >= _LEAST_ENDS) & (hits >= _LEAST_SHARE * counts))[cells]
    return found


def _touching(x: Floats, y: Floats) -> list[Ints]:
    """Indices of points (n,) by groups whose cells touch each other, if only at a corner."""
    members: dict[tuple[int, int], list[int]] = {}
    for i, cell in enumerate(np.floor(np.stack([x, y], axis=1) / _CELL_M).astype(int).tolist()):
        members.setdefault((cell[0], cell[1]), []).append(i)
    groups = []
    left = set(members)
    for start in sorted(members):
        waiting, group = [start] if start in left else [], []
        while waiting:
            cell = waiting.pop()
            if cell in left:
                left.remove(cell)
                group += members[cell]
                waiting += [(cell[0] + dx, cell[1] + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        if group:
            groups.append(np.array(sorted(group), np.int64))
    return groups


def _place(ends: Ends, which: Ints) -> MovedPlace:
    x, y, distance = (np.sort(part[which]) for part in (ends.x, ends.y, ends.distance))
    nodes, counts = np.unique(ends.node[which], return_counts=True)
    middle = (len(which) - 1) // 2
    return MovedPlace(
        x=float(x[middle]),
        y=float(y[middle]),
        ends=len(which),
        nodes=tuple(nodes[np.lexsort((nodes, -counts))].tolist()),
        distance=float(distance[middle]),
    )
