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

    def assign(self, places: Floats) -> tuple[Ints, Ints]:
        """Node (n,) of each scan taken at `places` (n, 2) [m, map frame], in this order; how many there were then (n,).

        NO_NODE if none is near, or the place is not finite.
        """
        chosen = np.full(len(places), NO_NODE)
        known = np.full(len(places), len(self.nodes))
        start = 0
        while start < len(places):
            nearest, near = self._nearest(places[start:])
            chosen[start:] = np.where(near, nearest, NO_NODE)
            far = np.flatnonzero(~near & np.isfinite(places[start:]).all(axis=1))
            if self.all_given or not len(far):
                break
            start += int(far[0])
            self._make(places[start])
            known[start:] = len(self.nodes)
        return chosen, known

    def farther(self, places: Floats, known: Ints, choice: int) -> tuple[npt.NDArray[np.bool_], Ints]:
        """Whether a place (n, 2) has so many nearer nodes and one more within reach (n,), and the number of that (n,).

        `choice`: 1 for the second nearest. Only the first `known` (n,) nodes count.
        """
        if len(self.nodes) <= choice:
            return np.zeros(len(places), np.bool_), np.full(len(places), NO_NODE)
        squared = self._squared(places)
        squared[np.arange(len(self.nodes)) >= known[:, None]] = np.inf
        node = np.argsort(squared, axis=1, kind="stable")[:, choice]
        return squared[np.arange(len(places)), node] <= self._spacing**2, node

    def insert(self, place: Floats, number: int) -> None:
        """Make a node at a place (2,), to be the node of this number; what was made from there on is undone."""
        del self.nodes[number:]
        self._make(place)

    def _make(self, place: Floats) -> None:
        # whole millimetres: a node's centre is a key of its random numbers
        x, y = (round(value, 3) for value in place.tolist())
        self.nodes.append(Node(x, y))

    def _nearest(self, places: Floats) -> tuple[Ints, npt.NDArray[np.bool_]]:
        if not self.nodes:
            return np.zeros(len(places), np.int64), np.zeros(len(places), np.bool_)
        squared = self._squared(places)
        nearest = squared.argmin(axis=1)
        return nearest, squared[np.arange(len(places)), nearest] <= self._spacing**2

    def _squared(self, places: Floats) -> Floats:
        """Squares of the distances (n, nodes) [m^2] from places (n, 2) to all nodes."""
        dx, dy = (places[:, None, axis] - self.centres[:, axis] for axis in (0, 1))
        return np.asarray(dx * dx + dy * dy)
