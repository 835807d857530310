"""What the nodes around say about a thing that one side has and the other has not."""

from timemap_cli.changes.rings import Floats, Ints, Places, Rings
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sightings import look, towards
from timemap_cli.changes.things import Thing

_POINTS = 500  # enough to judge anything; keeps the memory small where a whole building differs


def is_believed(thing: Thing, having: Rings, lacking: Rings, places: Places, rules: Rules) -> bool:
    """True where more of the nodes that can tell saw the thing come or go than never had it, or none can tell.

    A node never had it where it saw past its points on the side that has it. A node that shows it on both sides,
    because it cannot tell it from what is behind or has not made up its mind yet, has no say; nor has one that
    can tell about less than half of the points from its place, or did not look there lately.
    """
    points = thing.points[:: -(-len(thing.points) // _POINTS)]
    agree, contradict = _count(points, having, lacking, places, rules)
    judges = 2 * (agree + contradict) >= len(points)
    in_favour = judges & (agree >= contradict)
    return not judges.any() or float(in_favour[judges].mean()) > rules.vote_share


def _count(points: Floats, having: Rings, lacking: Rings, places: Places, rules: Rules) -> tuple[Ints, Ints]:
    """How many of the points each node within reach agrees with, and contradicts, two (nodes,)."""
    rows, bins, ranges = towards(points, places)
    had, never = look(having, rows, bins, ranges, places, rules)
    _, sees_past = look(lacking, rows, bins, ranges, places, rules)
    often = (having.firm(rules, rules.vote_samples) & having.fresh(rules))[rows, bins]
    agree = often & had & sees_past & lacking.firm(rules, rules.min_samples)[rows, bins]
    return agree.sum(axis=1), (often & never).sum(axis=1)
