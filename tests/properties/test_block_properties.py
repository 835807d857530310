"""How a recording is cut into blocks changes nothing, to the last bit."""

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.model.drives import LEVELS, as_bytes, drive, replay
from tests.model.memories import codes
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import virtual_scans

SCANS = drive(90, seed=4)
WHOLE = as_bytes(replay(SCANS)[1])


@given(st.sets(st.integers(1, 89), max_size=12))
@settings(max_examples=25)
def test_a_replay_does_not_depend_on_its_blocks(cuts):
    learnt, found = replay(SCANS, cuts)
    assert as_bytes(found) == WHOLE
    assert len(learnt.nodes) == 1 + max(node for _, node in WHOLE)


def test_a_replay_scan_by_scan_is_the_same():
    assert as_bytes(replay(SCANS, range(1, 90))[1]) == WHOLE


@given(st.integers(0, 80), st.integers(1, 89), st.sampled_from([12, 72, 361]))
@settings(max_examples=40)
def test_a_virtual_scan_does_not_depend_on_its_neighbours(start, length, angle_bins):
    """Whether the others move or stand, and how many they are."""
    centres = np.random.default_rng(1).uniform(-0.5, 0.5, (90, 2))
    free = np.arange(90) % 5 > 0
    whole, judged = virtual_scans(SCANS, centres, free, angle_bins, 5.0)
    part = slice(start, min(90, start + length))
    ranges, some = virtual_scans(SCANS.rows(part), centres[part], free[part], angle_bins, 5.0)
    np.testing.assert_array_equal(ranges, whole[part])
    np.testing.assert_array_equal(some, judged[part])


@st.composite
def streams(draw):
    """Virtual scans of a few nodes, and where the stream is cut."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    scans = draw(st.integers(1, 60))
    ranges = np.round(random.uniform(0.5, 4, (scans, 5)), 3)
    ranges[random.random(ranges.shape) < 0.3] = np.nan
    nodes = random.integers(0, draw(st.integers(1, 4)), scans)
    stamps = np.cumsum(random.integers(0, 3 * 10**9, scans))
    return ranges, nodes, stamps, draw(st.sets(st.integers(1, 59), max_size=6))


def remembered(level, ranges, nodes, stamps, cuts):
    memory = Memory(level, ranges.shape[1], 3)
    memory.add_nodes([Node(n, 0) for n in range(4)])
    borders = [0, *sorted(cut for cut in cuts if cut < len(ranges)), len(ranges)]
    for start, stop in pairwise(borders):
        memory.remember(nodes[start:stop], stamps[start:stop], codes(ranges[start:stop]))
    found = memory.recall(np.arange(4))
    arrays = (found.samples, found.ages * (found.samples < 65535), found.left, found.right, found.n_samples)
    counts = (found.n_pairs, found.last_seen_ns, found.taken, found.stamps_ns)
    return [array.tobytes() for array in (*arrays, *counts)]


@given(
    streams(), st.sampled_from([Level("a", 3, 2.5), Level("b", 4, 9.0), Level("c", 5, 20.0, in_seconds=True)])
)
@settings(max_examples=100)
def test_a_memory_does_not_depend_on_blocks(stream, level):
    ranges, nodes, stamps, cuts = stream
    whole = remembered(level, ranges, nodes, stamps, ())
    assert remembered(level, ranges, nodes, stamps, cuts) == whole
    assert remembered(level, ranges, nodes, stamps, range(1, len(ranges))) == whole


@given(streams(), st.sampled_from([Level("a", 3, 2.5), Level("b", 4, 9.0), Level("c", 5, 60.0)]))
@settings(max_examples=50)
def test_an_angle_bin_was_last_seen_in_the_newest_scan_that_was_taken_and_saw_it(stream, level):
    ranges, nodes, stamps, _ = stream
    memory = Memory(level, 5, 3)
    memory.add_nodes([Node(n, 0) for n in range(4)])
    newest = np.zeros((4, 5), np.int64)
    taken = np.zeros(4, np.int64)
    for n, stamp, scan in zip(nodes, stamps, ranges, strict=True):
        memory.remember(np.array([n]), np.array([stamp]), codes([scan]))
        now = memory.recall(np.arange(4)).taken
        if now[n] > taken[n]:
            newest[n, ~np.isnan(scan)] = stamp
        taken = now
    assert memory.recall(np.arange(4)).last_seen_ns.tolist() == newest.tolist()


@given(streams())
@settings(max_examples=50)
def test_a_node_remembers_what_it_would_alone(stream):
    """Other nodes' scans in between change nothing of it."""
    ranges, nodes, stamps, _ = stream
    for level in LEVELS:
        everybody = Memory(level, 5, 3)
        everybody.add_nodes([Node(n, 0) for n in range(4)])
        everybody.remember(nodes, stamps, codes(ranges))
        for node in range(4):
            mine = nodes == node
            alone = Memory(level, 5, 3)
            alone.add_nodes([Node(node, 0)])
            alone.remember(np.zeros(mine.sum(), np.int64), stamps[mine], codes(ranges[mine]))
            expected, found = alone.recall(np.array([0])), everybody.recall(np.array([node]))
            for name in ("samples", "left", "right", "n_samples", "n_pairs", "last_seen_ns", "taken"):
                np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
