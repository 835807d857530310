"""Estimates without what others have seen past since."""

import numpy as np
import pytest

from tests.changes.rooms import RADIUS, Box, estimate, estimates, ring
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Event
from timemap_cli.changes.ghosts import without_ghosts
from timemap_cli.model.nodes import Node

NODES = [Node(-1.5, 0.0), Node(1.5, 0.0), Node(0.0, -1.0)]
BOX = Box(0.0, 2.3)
MINUTE = 60 * 10**9
# from node 0 at (-1.5, 0) the corner (0.3, 2.0) of the box lies at 48.01 degrees, (-0.3, 2.6) at 65.22
BOX_BINS = list(range(48, 65))


def seen(*boxes_and_minutes: tuple[list[Box], int]):
    """An estimate of each node, that saw these boxes in this minute."""
    return {
        i: estimate(i, ring(NODES[i], boxes), stamp_ns=minutes * MINUTE)
        for i, (boxes, minutes) in enumerate(boxes_and_minutes)
    }


def blanked(held, vanished=()) -> dict[int, list[int]]:
    """Angle bins that became unknown, by node; all others must be as they were."""
    shown = without_ghosts(NODES, held, vanished, RADIUS)
    assert shown.keys() == held.keys()
    found = {}
    for node, before in held.items():
        after = shown[node].ranges
        gone = np.isnan(after) & ~np.isnan(before.ranges)
        np.testing.assert_array_equal(after[~gone], before.ranges[~gone])
        if gone.any():
            found[node] = np.flatnonzero(gone).tolist()
    return found


def vanished(*points: tuple[float, float], last_seen_ns: int = 0) -> Event:
    return Event(
        id=0,
        kind=Kind.VANISHED,
        points=np.array(points),
        moved_from=None,
        support=0.9,
        first_seen_ns=0,
        last_seen_ns=last_seen_ns,
        looked_ns=last_seen_ns,
        adopted={},
        nodes=(),
        against=(),
        episodes=(),
        looks=1,
        looks_held=1,
    )


def test_where_all_show_the_same_nothing_is_unknown():
    assert blanked(seen(([BOX], 1), ([BOX], 1), ([BOX], 1))) == {}


def test_what_a_stale_node_shows_and_newer_looks_see_past_is_unknown():
    assert blanked(seen(([BOX], 1), ([], 30), ([], 30))) == {0: BOX_BINS}
    assert blanked(seen(([BOX], 1), ([], 30))) == {0: BOX_BINS}


def test_what_two_of_three_that_look_now_see_past_is_unknown():
    assert blanked(seen(([BOX], 30), ([], 30), ([], 30))) == {0: BOX_BINS}


def test_a_wall_in_doubt_stays():
    assert blanked(seen(([BOX], 30), ([], 30))) == {}


def test_what_nobody_else_can_tell_of_stays():
    screen = Box(0.3, 1.4, 1.8, 0.2)
    held = seen(([BOX], 1), ([screen], 30))
    assert not set(BOX_BINS[4:-4]) & set(blanked(held).get(0, []))


def test_estimates_that_were_handed_in_are_not_changed():
    held = seen(([BOX], 1), ([], 30))
    kept = {node: one.ranges.copy() for node, one in held.items()}
    shown = without_ghosts(NODES, held, [], RADIUS)
    assert np.isnan(shown[0].ranges).any()
    for node, one in held.items():
        np.testing.assert_array_equal(one.ranges, kept[node])


def test_all_but_the_ranges_stays():
    held = seen(([BOX], 1), ([], 30))
    shown = without_ghosts(NODES, held, [], RADIUS)[0]
    assert (shown.node, shown.level, shown.stamp_ns) == (0, "mid", MINUTE)
    assert shown.ranges.dtype == np.float32
    np.testing.assert_array_equal(shown.samples, held[0].samples)


OUTLINE = (-2.0, 1.9), (2.0, 1.9), (2.0, 2.8), (-2.0, 2.8)  # of something large that stood round the box


@pytest.mark.parametrize(("seen_minute", "bins"), [(4, BOX_BINS), (5, BOX_BINS), (6, [])])
def test_what_lies_in_the_outline_of_what_vanished_and_is_older_is_unknown(seen_minute, bins):
    found = blanked(seen(([BOX], seen_minute)), [vanished(*OUTLINE, last_seen_ns=5 * MINUTE)])
    assert found == ({0: bins} if bins else {})


def test_a_part_of_what_vanished_is_unknown_whenever_it_was_seen():
    """The left lower corner of the box lies within 0.3 m of a point of the event, its right one does not."""
    event = vanished((-0.35, 1.95), (-0.35, 2.7), (0.9, 2.7), (0.9, 1.9))
    (found,) = blanked(seen(([BOX], 6)), [event]).values()
    assert set(found) < set(BOX_BINS)
    x, y = points(found)
    assert np.hypot(x + 0.35, y - 1.95).min() < 0.1
    assert x.max() < 0.05


def points(bins: list[int]):
    """Where bins of node 0 end at the box."""
    ranges, bearings = ring(NODES[0], [BOX])[bins], np.radians(np.array(bins) + 0.5)
    return NODES[0].x + ranges * np.cos(bearings), NODES[0].y + ranges * np.sin(bearings)


def test_what_lies_outside_of_the_outline_stays():
    event = vanished((-0.1, 1.0), (0.1, 1.0), (0.1, 1.8), (-0.1, 1.8), last_seen_ns=9 * MINUTE)
    assert blanked(seen(([BOX], 1)), [event]) == {}


def test_no_estimates_are_no_estimates():
    assert without_ghosts(NODES, {}, [], RADIUS) == {}
    assert blanked(estimates(NODES, wall=1000.0)) == {}
