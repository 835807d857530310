"""Which node of the baseline is which of the result."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.nodes import Node
from timemap_cli.model.ordering import to_order

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Matched:
    """Pairs of nodes, and those that have no partner."""

    pairs: tuple[tuple[int, int], ...]  # numbers in the baseline and in the result, by the first
    missing: tuple[int, ...]  # numbers in the baseline
    new: tuple[int, ...]  # numbers in the result


def matched(expected: Sequence[Node], found: Sequence[Node], within_m: float) -> Matched:
    """Nodes at nearly the same place, the nearest first; each has one partner at most."""
    apart = np.hypot(*(_places(expected)[:, None] - _places(found)[None]).transpose(2, 0, 1))
    near = np.argwhere(apart <= within_m).tolist()
    taken: dict[int, int] = {}
    given: set[int] = set()
    for one, other in sorted(near, key=lambda pair: (to_order(apart[tuple(pair)]), pair)):
        if one not in taken and other not in given:
            taken[one] = other
            given.add(other)
    missing = tuple(i for i in range(len(expected)) if i not in taken)
    new = tuple(i for i in range(len(found)) if i not in given)
    return Matched(tuple(sorted(taken.items())), missing, new)


def _places(nodes: Sequence[Node]) -> Floats:
    return np.array([(node.x, node.y) for node in nodes], np.float64).reshape(-1, 2)
