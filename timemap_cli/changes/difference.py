"""What a comparison of two estimates says."""

from dataclasses import dataclass, field, replace
from enum import Enum

from timemap_cli.changes.rings import Floats
from timemap_cli.model.elementary import distance


class Kind(Enum):
    """What happened to a thing between the older or slower side and the newer or faster one."""

    APPEARED = "appeared"
    VANISHED = "vanished"
    MOVED = "moved"


@dataclass(frozen=True, slots=True)
class Sector:
    """Neighbouring changed angle bins of one node.

    Runs counter-clockwise from `start_bin` (included, 0 <= start_bin < angle_bins) to `stop_bin` (excluded,
    0 < stop_bin <= angle_bins); it passes bearing 0 where stop_bin <= start_bin. Ranges are lower medians of
    the changed bins, +inf for clear.
    """

    node: int
    start_bin: int
    stop_bin: int
    range_from_m: float
    range_to_m: float

    def bins(self, angle_bins: int) -> int:
        """How many angle bins of a ring of `angle_bins` the sector covers."""
        return (self.stop_bin - self.start_bin - 1) % angle_bins + 1


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that appeared, vanished or moved, in the map frame.

    `x`, `y`, `bounds` are of the surface points seen: where the thing stands (appeared, moved) or stood
    (vanished).
    """

    kind: Kind
    x: float  # [m] mean of the points
    y: float  # [m]
    bounds: tuple[float, float, float, float]  # [m] x_min, y_min, x_max, y_max
    support: float  # 0..1, mean over the changed bins of the weaker of both sides' share of what is known
    sectors: tuple[Sector, ...]  # by node, then start_bin; of a moved thing both places
    points: Floats = field(compare=False, repr=False)  # (n, 2) [m] the surface where it stands, or stood
    alone: bool = False  # it was seen whole, with something farther on either side
    moved_from: tuple[float, float] | None = None  # [m] where a moved thing stood
    points_before: Floats | None = field(
        default=None, compare=False, repr=False
    )  # (n, 2) [m] of a moved thing

    @property
    def nodes(self) -> tuple[int, ...]:
        """Numbers of the nodes that saw it change, ascending."""
        return tuple(sorted({sector.node for sector in self.sectors}))

    @property
    def size_m(self) -> float:
        """Diagonal of the bounds [m]."""
        x_min, y_min, x_max, y_max = self.bounds
        return distance(x_max - x_min, y_max - y_min)

    @property
    def shift_m(self) -> float:
        """How far a moved thing went [m]; of another one, the largest step of range among its sectors.

        A range that was clear, or became it, is a step without bound.
        """
        if self.moved_from is not None:
            return distance(self.x - self.moved_from[0], self.y - self.moved_from[1])
        return max(abs(sector.range_to_m - sector.range_from_m) for sector in self.sectors)


@dataclass(frozen=True, slots=True)
class ComparedNode:
    """How much of one node could be compared."""

    node: int
    compared_bins: int  # angle bins that both sides know firmly
    changed_bins: int  # of these, those that belong to a reported change


@dataclass(frozen=True, slots=True)
class Difference:
    """All changes between two sides, and what they were looked for in."""

    changes: tuple[Change, ...]  # the largest first
    nodes: tuple[ComparedNode, ...]  # by number
    silent_nodes: tuple[int, ...]  # known to one side only, or not seen again: they say nothing
    angle_bins: int  # of every ring; 0 where no node was compared
    small: int = 0  # changes left out by `at_least`

    @property
    def compared_bins(self) -> int:
        """Angle bins that both sides know firmly, over all nodes."""
        return sum(node.compared_bins for node in self.nodes)

    @property
    def changed_bins(self) -> int:
        """Angle bins that belong to a reported change, over all nodes."""
        return sum(node.changed_bins for node in self.nodes)

    def count(self, kind: Kind) -> int:
        """How many changes are of this kind."""
        return sum(change.kind is kind for change in self.changes)

    def at_least(self, size_m: float, shift_m: float) -> "Difference":
        """Only the changes of at least this size and shift [m]; what was compared, and its counts, stay."""
        kept = tuple(one for one in self.changes if one.size_m >= size_m and one.shift_m >= shift_m)
        return replace(self, changes=kept, small=self.small + len(self.changes) - len(kept))
