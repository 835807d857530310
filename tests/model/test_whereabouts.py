"""Whether the robot is lost or the world has changed: what the nodes that it passed say."""

import numpy as np
import pytest

from tests.model.scenes import pillar, rectangle
from tests.model.test_misplaced import REACH, seen_from
from timemap_cli.model.contradiction import Bounds
from timemap_cli.model.whereabouts import LONGEST_PAUSE_NS, NODES, Whereabouts

LIMIT = 0.75
HALL = rectangle(-9.0, -2.0, 9.0, 2.5)
SHELVES = np.concatenate([pillar(-8.0 + 2 * i, 1.7 - 3.0 * (i % 2), 0.9 + 0.1 * (i % 3)) for i in range(9)])
HELD = np.concatenate((HALL, SHELVES))
EMPTY = rectangle(-9.5, -5.0, 9.5, 6.0)  # nothing of it is where it was
PLACES = [(-6.0 + i, 0.2) for i in range(13)]  # of the nodes


def held():
    """What the nodes hold of the hall."""
    return Bounds.around(np.stack([at(HELD, node) for node in range(len(PLACES))]), REACH)


def at(world, node, x=0.0, y=0.0, turned=0.0):
    """What is seen of a world by a robot that believes itself at the node and is beside it (angle_bins,)."""
    return seen_from(world, PLACES[node][0] + x, PLACES[node][1] + y, turned)


def verdicts(scans, expected, *, every_ns=10**8, whereabouts=None):
    """Of each scan (node, ranges): whether it is a lost robot's; None where it does not contradict enough to ask."""
    whereabouts = whereabouts or Whereabouts(LIMIT, 360)
    found = []
    for i, (node, ranges) in enumerate(scans):
        share = float(expected.rows(np.array([node])).contradiction(ranges[None])[0])
        whereabouts.come_to(i * every_ns)
        whereabouts.see(node, ranges, share)
        found.append(whereabouts.are_wrong(ranges, expected) if share >= LIMIT else None)
    return found


def test_where_only_some_nodes_contradict_and_nothing_fits_elsewhere_the_world_has_changed():
    scans = [(node, at(EMPTY if node in (5, 6, 7) else HELD, node)) for node in range(10)]
    found = verdicts(scans, held())
    assert found == [None] * 5 + [False] * 3 + [None] * 2


def test_a_robot_that_is_shifted_is_lost_at_once_and_everywhere():
    found = verdicts([(node, at(HELD, node, 0.0, 0.9, 0.4)) for node in range(10)], held())
    assert found.count(True) >= 5
    assert False not in found


def test_who_contradicts_at_every_node_is_lost_though_nothing_fits_elsewhere():
    found = verdicts([(node, at(EMPTY, node)) for node in range(10)], held())
    assert found[0] is False
    assert all(found[6:])


def test_what_fits_elsewhere_at_one_node_alone_does_not_make_a_robot_lost():
    """A box round the node was moved by half a metre each way; the nodes before fit as they are, not by that shift."""
    box, moved = (rectangle(-0.9 + by, -0.9 + by, 0.9 + by, 0.9 + by) for by in (0.0, 0.5))
    expected = held().with_rows(np.array([5]), Bounds.around(seen_from(box)[None], REACH))
    fitting = [(node, at(HELD, node)) for node in range(5)]
    assert verdicts([*fitting, (5, seen_from(moved))], expected)[-1] is False


def test_many_scans_of_one_node_are_one_voice():
    nowhere = [(0, at(EMPTY, 0))] * 500
    fitting = [(node, at(HELD, node)) for node in range(1, 9)]
    assert verdicts([*fitting, *nowhere], held())[-1] is False


def test_nodes_that_were_left_long_ago_are_forgotten():
    whereabouts = Whereabouts(LIMIT, 360)
    verdicts([(node, at(HELD, node)) for node in range(13)], held(), whereabouts=whereabouts)
    assert len(whereabouts.kept()["nodes"]) == NODES
    assert whereabouts.kept()["nodes"].tolist() == list(range(1, 13))


@pytest.mark.parametrize("pause_ns", [LONGEST_PAUSE_NS + 1, -1])
def test_after_a_pause_or_when_the_clock_begins_anew_nothing_is_known(pause_ns):
    whereabouts = Whereabouts(LIMIT, 360)
    whereabouts.come_to(10**12)
    whereabouts.see(3, at(HELD, 3), 0.0)
    whereabouts.come_to(10**12 + pause_ns)
    assert len(whereabouts.kept()["nodes"]) == 0


def test_what_was_kept_goes_on():
    scans = [(node, at(HELD, node, 0.0, 0.9, 0.4)) for node in range(12)]
    one = Whereabouts(LIMIT, 360)
    whole = verdicts(scans, held())
    first = verdicts(scans[:6], held(), whereabouts=one)
    other = Whereabouts(LIMIT, 360)
    other.restore(one.kept())
    expected = held()
    rest = []
    for i, (node, ranges) in enumerate(scans[6:], 6):
        share = float(expected.rows(np.array([node])).contradiction(ranges[None])[0])
        other.come_to(i * 10**8)
        other.see(node, ranges, share)
        rest.append(other.are_wrong(ranges, expected) if share >= LIMIT else None)
    assert first + rest == whole


def test_nothing_is_kept_before_the_first_scan():
    kept = Whereabouts(LIMIT, 360).kept()
    assert kept["ranges"].shape == (0, 360)
    other = Whereabouts(LIMIT, 360)
    other.restore(kept)
    assert other.kept()["newest_ns"] is None
