"""Which node a scan goes to: the nearest within reach, else a new one where the robot stands."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from timemap_cli.model.nodes import Node

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

NO_NODE = -1
_PAIRS_AT_ONCE = 1 << 20  # bounds the memory
MOST_NODES = 10_000  # bounds the memory; the aisles of a hall of 100 m by 100 m need half of them


class Placement:
    """The nodes of a map in the order in which they were made; none ever moves."""

    def __init__(self, spacing: float, given: Sequence[Node] = (), likely: Sequence[Node] = ()) -> None:
        """`spacing` [m]: a scan farther than this from every node makes one, unless all nodes are given.

        It is made where the scan was taken, or at the nearest of the `likely` nodes that is left within the spacing:
        so nodes come where they came in another replay, and when the robot first needs them.
        """
        self.nodes = list(given)
        self.all_given = bool(given)
        self._spacing = spacing
        self._likely = list(likely)

    @property
    def centres(self) -> Floats:
        """(nodes, 2) [m, map frame]."""
        return np.array([(node.x, node.y) for node in self.nodes], np.float64).reshape(-1, 2)

    def centres_of(self, nodes: Ints) -> Floats:
        """Centres (n, 2) [m, map frame] of these nodes (n,); NaN for NO_NODE."""
        return np.vstack((self.centres, np.full(2, np.nan)))[nodes]

    def assign(self, places: Floats) -> tuple[Ints, Ints]:
        """Node (n,) of each scan taken at `places` (n, 2) [m, map frame], in this order; how many there were then (n,).

        NO_NODE if none is near and none may be made: all are given, there are MOST_NODES, or the place is not finite.
        """
        chosen, squared = self._nearest(places)
        known = np.full(len(places), len(self.nodes))
        finite = np.asarray(np.isfinite(places).all(axis=1))
        start = 0
        while not self.all_given and len(self.nodes) < MOST_NODES:
            far = np.flatnonzero(~(squared[start:] <= self._spacing * self._spacing) & finite[start:])
            if not len(far):
                break
            start += int(far[0])
            centre = self._make(places[start])
            new = _squared_distances(places[start:], centre[None])[:, 0]
            nearer = start + np.flatnonzero(~(squared[start:] <= new))
            chosen[nearer], squared[nearer] = len(self.nodes) - 1, new[nearer - start]
            known[start:] = len(self.nodes)
        return np.where(squared <= self._spacing * self._spacing, chosen, NO_NODE), known

    def farther(self, places: Floats, known: Ints, choice: int) -> tuple[npt.NDArray[np.bool_], Ints]:
        """Whether a place (n, 2) has so many nearer nodes and one more within reach (n,), and the number of that (n,).

        `choice`: 1 for the second nearest. Only the first `known` (n,) nodes count.
        """
        near, node = np.zeros(len(places), np.bool_), np.full(len(places), NO_NODE)
        centres = self.centres
        at_once = max(1, _PAIRS_AT_ONCE // max(1, len(centres)))
        for begin in range(0, len(places) if len(centres) > choice else 0, at_once):
            part = slice(begin, begin + at_once)
            squared = _squared_distances(places[part], centres)
            squared[np.arange(len(centres)) >= known[part, None]] = np.inf
            node[part] = np.argsort(squared, axis=1, kind="stable")[:, choice]
            near[part] = squared[np.arange(len(squared)), node[part]] <= self._spacing * self._spacing
        return near, node

    def may_insert(self, number: int) -> bool:
        """Whether a node of this number may be made."""
        return not self.all_given and number < MOST_NODES

    def insert(self, place: Floats, number: int) -> None:
        """Make a node at a place (2,), to be the node of this number; what was made from there on is undone."""
        del self.nodes[number:]
        self._make(place)

    def _make(self, place: Floats) -> Floats:
        """Make a node and return its centre (2,): whole millimetres, as it is a key of its random numbers."""
        node = self._likely_at(place) or Node(*(round(value, 3) for value in place.tolist()))
        self.nodes.append(node)
        return np.array([node.x, node.y])

    def _likely_at(self, place: Floats) -> Node | None:
        made = set(self.nodes)
        left = [node for node in self._likely if node not in made]
        if not left:
            return None
        squared = _squared_distances(place[None], np.array([(node.x, node.y) for node in left]))[0]
        nearest = int(squared.argmin())
        return left[nearest] if squared[nearest] <= self._spacing * self._spacing else None

    def _nearest(self, places: Floats) -> tuple[Ints, Floats]:
        """Nearest node (n,) of each place and the square of how far it is [m^2]; NO_NODE, inf if there is none."""
        chosen, squared = np.full(len(places), NO_NODE), np.full(len(places), np.inf)
        if not self.nodes:
            return chosen, squared
        centres = self.centres
        at_once = max(1, _PAIRS_AT_ONCE // len(centres))
        for begin in range(0, len(places), at_once):
            some = _squared_distances(places[begin : begin + at_once], centres)
            nearest = some.argmin(axis=1)
            chosen[begin : begin + at_once] = nearest
            squared[begin : begin + at_once] = some[np.arange(len(some)), nearest]
        return chosen, squared


def _squared_distances(places: Floats, centres: Floats) -> Floats:
    """(places, centres) [m^2]."""
    dx, dy = (places[:, None, axis] - centres[:, axis] for axis in (0, 1))
    return np.asarray(dx * dx + dy * dy)
