"""Differences written by hand, for the reports."""

from math import inf

import numpy as np

from timemap_cli.changes.difference import Change, ComparedNode, Difference, Kind, Sector
from timemap_cli.model.nodes import Node
from timemap_cli.reports.sides import ComparedSide

NODES = [Node(0.0, 0.0), Node(1.5, -0.00001), Node(3.0, 0.25)]
OLD = ComparedSide("house.timemap.mcap", "long", 1714564800000000000)
NEW = ComparedSide("house.timemap.mcap", "mid", 1714564800250000000)

VANISHED = Change(
    Kind.VANISHED,
    x=2.0,
    y=-0.004,
    bounds=(1.95, -0.3, 2.0, 0.3),
    support=0.8125,
    sectors=(Sector(0, 351, 9, 2.0, inf), Sector(1, 40, 70, 1.25, 4.5)),
    points=np.array([[1.95, -0.3], [2.0, 0.3]]),
)
APPEARED = Change(
    Kind.APPEARED,
    x=-4.0,
    y=1.0,
    bounds=(-4.1, 0.9, -3.9, 1.1),
    support=0.6,
    sectors=(Sector(2, 170, 176, 8.0, 7.0),),
    points=np.array([[-4.1, 0.9], [-3.9, 1.1]]),
)
MOVED = Change(
    Kind.MOVED,
    x=5.0,
    y=6.0,
    bounds=(4.9, 5.9, 5.1, 6.1),
    support=0.7,
    sectors=(Sector(0, 45, 52, 9.5, 7.75), Sector(0, 60, 66, 7.5, 9.25)),
    points=np.array([[4.9, 5.9], [5.1, 6.1]]),
    moved_from=(4.4, 6.8),
)
COMPARED = (ComparedNode(0, 350, 31), ComparedNode(1, 300, 30), ComparedNode(2, 120, 6))


def difference(*changes: Change, silent: tuple[int, ...] = ()) -> Difference:
    """All three nodes compared, with these changes."""
    return Difference(changes, COMPARED, silent, 360)


NOTHING_COMPARED = Difference((), (), (0, 1), 0)
