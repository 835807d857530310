"""Which node a scan goes to: the nearest within reach, else a new one where the robot stands."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from timemap_cli.model.nodes import Node

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

NO_NODE = -1


class Placement:
    """The nodes of a map in the order in which they were made; none ever moves."""

    def __init__(self, spacing: float, given: Sequence[Node] = ()) -> None:
        """`spacing` [m]: a scan farther than this from every node makes one, unless all nodes are given."""
        self.nodes = list(given)
        self.all_given = bool(given)
        self._spacing = spacing

    @property
    def centres(self) -> Floats:
        """(nodes, 2) [m, map frame]."""
        return np.array([(node.x, node.y) for node in self.nodes], np.float64).reshape(-1, 2)

    def centres_of(self, nodes: Ints) -> Floats:
        """Centres (n, 2) [m, map frame] of these nodes (n,); NaN for NO_NODE."""
        return np.vstack((self.centres, np.full(2, np.nan)))[nodes]

    def assign(self, places: Floats) -> Ints:
        """Node (n,) of each scan taken at `places` (n, 2) [m, map frame], in this order.

        NO_NODE if none is near, or the place is not finite.
        """
        chosen = np.full(len(places), NO_NODE)
        start = 0
        while start < len(places):
            nearest, near = self._nearest(places[start:])
            chosen[start:] = np.where(near, nearest, NO_NODE)
            far = np.flatnonzero(~near & np.isfinite(places[start:]).all(axis=1))
            if self.all_given or not len(far):
                break
            start += int(far[0])
            # whole millimetres: a node's centre is a key of its random numbers
            x, y = (round(value, 3) for value in places[start].tolist())
            self.nodes.append(Node(x, y))
        return chosen

    def _nearest(self, places: Floats) -> tuple[Ints, npt.NDArray[np.bool_]]:
        if not self.nodes:
            return np.zeros(len(places), np.int64), np.zeros(len(places), np.bool_)
        dx, dy = (places[:, None, axis] - self.centres[:, axis] for axis in (0, 1))
        squared = dx * dx + dy * dy
        nearest = squared.argmin(axis=1)
        return nearest, squared[np.arange(len(places)), nearest] <= self._spacing**2
