"""What all nodes of a side say together of surface points: the newest looks that could tell come first.

A node that nobody passed again still shows what stood there last week. Another one may have looked at the same place
since, from elsewhere.
"""

from dataclasses import dataclass

import numpy as np

from timemap_cli.changes.looks import looks
from timemap_cli.changes.rings import Bools, Floats, Ints
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side


@dataclass(frozen=True, slots=True)
class Testimony:
    """Of the nodes that looked lately, how many show a surface at each of n points, and how many see past it."""

    shown: Ints  # (n,)
    past: Ints  # (n,)

    @property
    def told(self) -> Bools:
        """Points of which some node can tell (n,)."""
        return self.shown + self.past > 0

    def contradicted(self, share: float) -> Bools:
        """Points that more than this share of the nodes that can tell see past (n,)."""
        return self.past > share * (self.shown + self.past)

    def part(self, which: Ints | Bools) -> "Testimony":
        """What is said of these points alone."""
        return Testimony(self.shown[which], self.past[which])

    def stands(self, points: Ints, agreement: float) -> bool:
        """Whether more than this share of the looks at these points (k,) show a surface."""
        shown, past = self.shown[points].sum(), self.past[points].sum()
        return bool(shown > agreement * (shown + past))

    def is_gone(self, points: Ints, agreement: float) -> bool:
        """Whether more than this share of the looks at these points (k,) see past them."""
        shown, past = self.shown[points].sum(), self.past[points].sum()
        return bool(past > agreement * (shown + past))


def testimony(points: Floats, side: Side, rules: Rules) -> Testimony:
    """What the nodes of a side say of surface points (n, 2) [m, map frame].

    Looks more than `lately_ns` older than the newest that could tell do not count.
    """
    shown, past = np.zeros(len(points), np.int64), np.zeros(len(points), np.int64)
    newest_ns = np.zeros(len(points), np.int64)
    for some in looks(points, side, rules):
        np.maximum.at(newest_ns, some.points, some.seen_ns)
        counts = some.seen_ns >= newest_ns[some.points] - rules.lately_ns
        past += np.bincount(some.points[counts & some.past], minlength=len(points))
        shown += np.bincount(some.points[counts & ~some.past], minlength=len(points))
    return Testimony(shown, past)
