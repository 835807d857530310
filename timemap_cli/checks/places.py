"""Places of the map where several nodes agree that a surface has moved."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_CELL_M = 0.5  # about the size of a thing
_LEAST_ENDS = 8
_LEAST_NODES = 3  # people who stood about are remembered by one or two
_LEAST_SHARE = 0.4  # of the ends in the cell: along a wall single ends move at its edges
_NEAR_M = 1.0  # cells of one thing


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

    x: float  # [m] mean of the ends that moved
    y: float
    ends: int  # that moved
    nodes: tuple[int, ...]  # that saw it, the one with most ends first
    distance: float  # [m] median of those that moved; +inf where nothing is left near by


def moved_places(ends: Ends, step_m: float, nodes: int) -> list[MovedPlace]:
    """The places where ends lie `step_m` and more off, most ends first; `nodes` is how many were compared."""
    if not len(ends.x):
        return []
    found: list[MovedPlace] = []
    least = min(_LEAST_NODES, nodes)
    for shift in (
        (0.0, 0.0),
        (0.5, 0.0),
        (0.0, 0.5),
        (0.5, 0.5),
    ):  # a thing may lie across the borders of cells
        columns = np.floor(np.stack([ends.x, ends.y]) / _CELL_M + np.array(shift)[:, None]).astype(np.int64)
        _, cells, counts = np.unique(columns, axis=1, return_inverse=True, return_counts=True)
        cells = cells.reshape(-1)
        moved = ends.distance > step_m
        hits = np.bincount(cells[moved], minlength=len(counts))
        for cell in np.flatnonzero((hits >= _LEAST_ENDS) & (hits >= _LEAST_SHARE * counts)).tolist():
            place = _place(ends, np.flatnonzero(moved & (cells == cell)))
            if len(place.nodes) >= least:
                found.append(place)
    return _apart(sorted(found, key=lambda place: (-place.ends, place.x, place.y)))


def _place(ends: Ends, which: Ints) -> MovedPlace:
    nodes, counts = np.unique(ends.node[which], return_counts=True)
    order = np.lexsort((nodes, -counts))
    distances = np.sort(ends.distance[which])
    return MovedPlace(
        x=float(ends.x[which].mean()),
        y=float(ends.y[which].mean()),
        ends=len(which),
        nodes=tuple(nodes[order].tolist()),
        distance=float(distances[(len(distances) - 1) // 2]),
    )


def _apart(places: Sequence[MovedPlace]) -> list[MovedPlace]:
    """Of places near each other the one with most ends."""
    kept: list[MovedPlace] = []
    for place in places:
        if all(np.hypot(place.x - one.x, place.y - one.y) > _NEAR_M for one in kept):
            kept.append(place)
    return kept
