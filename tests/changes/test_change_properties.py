"""What holds for any two rings."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.changes.rooms import CENTRE, RADIUS, Box, compare_rings, estimate, ring
from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Change, Difference, Kind
from timemap_cli.model.nodes import Node

SWAPPED = {Kind.APPEARED: Kind.VANISHED, Kind.VANISHED: Kind.APPEARED, Kind.MOVED: Kind.MOVED}

boxes = st.lists(
    st.builds(
        lambda bearing, distance, size: Box(
            distance * np.cos(bearing), distance * np.sin(bearing), size, size
        ),
        st.floats(0, 6.28),
        st.floats(1.5, 6.0),
        st.floats(0.2, 1.0),
    ),
    max_size=4,
)
gaps = st.lists(st.tuples(st.integers(0, 359), st.integers(1, 60)), max_size=3)
walls = st.sampled_from([4.0, 7.0, 20.0])


@st.composite
def room_rings(draw: st.DrawFn):
    """A ring of a room with boxes and unknown stretches."""
    ranges = ring(CENTRE, draw(boxes), draw(walls))
    for start, length in draw(gaps):
        ranges[np.arange(start, start + length) % 360] = np.nan
    return ranges


def places(difference: Difference, *kinds: Kind) -> list[tuple[float, ...]]:
    return sorted(
        (*np.round((c.x, c.y), 6), *np.round(c.bounds, 6)) for c in difference.changes if c.kind in kinds
    )


@settings(max_examples=60, deadline=None)
@given(room_rings())
def test_nothing_differs_from_itself(ranges):
    assert compare_rings(ranges, ranges).changes == ()


@settings(max_examples=100, deadline=None)
@given(room_rings(), room_rings())
def test_swapping_the_sides_swaps_appeared_and_vanished(before, after):
    forth, back = compare_rings(before, after), compare_rings(after, before)
    assert forth.nodes == back.nodes
    assert places(forth, Kind.APPEARED) == places(back, Kind.VANISHED)
    assert places(forth, Kind.VANISHED) == places(back, Kind.APPEARED)
    assert forth.count(Kind.MOVED) == back.count(Kind.MOVED)


@settings(max_examples=100, deadline=None)
@given(room_rings(), room_rings(), st.integers(0, 359))
def test_turning_the_rings_turns_the_changes(before, after, bins):
    turn = np.exp(1j * np.radians(bins))
    straight = compare_rings(before, after).changes
    rolled = compare_rings(np.roll(before, bins), np.roll(after, bins)).changes
    expected = sorted(_told(change, complex(change.x, change.y) * turn, bins) for change in straight)
    found = sorted(_told(change, complex(change.x, change.y), 0) for change in rolled)
    assert [told[:2] for told in found] == [told[:2] for told in expected]
    assert np.allclose([told[2] for told in found], [told[2] for told in expected], atol=1e-6)


def _told(change: Change, at: complex, bins: int):
    """Kind, sectors (a full circle without where it starts) and place, the bins turned on."""
    covered = [(s.start_bin, s.bins(360)) for s in change.sectors]
    turned = [((start + bins) % 360 if count < 360 else 0, count) for start, count in covered]
    return change.kind.value, sorted(turned), (at.real, at.imag)


@settings(max_examples=50, deadline=None)
@given(room_rings(), room_rings(), st.floats(-50, 50), st.floats(-50, 50))
def test_shifting_the_node_shifts_the_changes(before, after, x, y):
    here = compare_rings(before, after)
    there = compare_rings(before, after, nodes=[Node(x, y)])
    assert [c.kind for c in there.changes] == [c.kind for c in here.changes]
    for near, far in zip(here.changes, there.changes, strict=True):
        assert np.allclose((far.x - x, far.y - y), (near.x, near.y), atol=1e-6)


@settings(max_examples=50, deadline=None)
@given(room_rings(), room_rings())
def test_every_change_lies_within_its_bounds_and_counts_add_up(before, after):
    difference = compare_rings(before, after)
    for change in difference.changes:
        x_min, y_min, x_max, y_max = change.bounds
        assert x_min - 1e-9 <= change.x <= x_max + 1e-9
        assert y_min - 1e-9 <= change.y <= y_max + 1e-9
        assert 0.5 <= change.support <= 1.0
    assert difference.changed_bins <= difference.compared_bins <= 360
    covered = sum(sector.bins(360) for change in difference.changes for sector in change.sectors)
    assert difference.changed_bins <= covered


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(room_rings(), room_rings()), min_size=2, max_size=4))
def test_numbering_of_the_nodes_does_not_matter(rings):
    nodes = [Node(30.0 * i, 0.0) for i in range(len(rings))]
    last = len(rings) - 1

    def told(order: list[int]) -> list[tuple[float, ...]]:
        old = {i: estimate(i, rings[n][0]) for i, n in enumerate(order)}
        new = {i: estimate(i, rings[n][1]) for i, n in enumerate(order)}
        difference = compare([nodes[n] for n in order], old, new, radius=RADIUS)
        return places(difference, *Kind)

    assert told(list(range(last + 1))) == told(list(range(last, -1, -1)))
