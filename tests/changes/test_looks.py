"""What one look of a node at a surface point tells."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.changes.rooms import CENTRE, OUTDOORS, Box, estimate, estimates, ring, side_of
from timemap_cli.changes import looks as module
from timemap_cli.changes.looks import looks
from timemap_cli.changes.rules import Rules
from timemap_cli.model.nodes import Node

RULES = Rules()
BOX = Box(2.3, 0.0)  # its face stands at x = 2
SHOWS, PAST, UNTOLD = "shows", "sees past", "cannot tell"


def told(point, ranges, node=CENTRE, **values) -> str:
    side = side_of([node], {0: estimate(0, ranges, **values)})
    found = [PAST if past else SHOWS for look in looks(np.array([point]), side, RULES) for past in look.past]
    assert len(found) <= 1
    return found[0] if found else UNTOLD


def at(bearing_deg: float, range_m: float) -> tuple[float, float]:
    return range_m * np.cos(np.radians(bearing_deg)), range_m * np.sin(np.radians(bearing_deg))


def test_a_surface_that_is_there_is_shown():
    assert told((2.0, 0.1), ring(CENTRE, [BOX])) == SHOWS


def test_one_that_is_gone_is_seen_past():
    assert told((2.0, 0.1), ring(CENTRE)) == PAST
    assert told((2.0, 0.1), np.full(360, np.inf)) == PAST


def test_what_is_hidden_cannot_be_told():
    assert told((2.0, 0.1), ring(CENTRE, [Box(1.0, 0.0, 0.2, 1.0)])) == UNTOLD


@pytest.mark.parametrize("values", [{"samples": 2}, {"support": 0.49}])
@pytest.mark.parametrize("boxes", [[], [BOX]])
def test_what_is_not_firmly_known_cannot_be_told(boxes, values):
    assert told((2.0, 0.1), ring(CENTRE, boxes), **values) == UNTOLD
    assert told((2.0, 0.1), np.full(360, np.nan)) == UNTOLD


@pytest.mark.parametrize(
    ("range_m", "expected"),
    [(4.79, PAST), (4.81, SHOWS), (5.19, SHOWS), (5.21, UNTOLD)],  # a step is 0.2 m
)
def test_a_wall_is_shown_within_a_step(range_m, expected):
    assert told(at(40.5, range_m), np.full(360, 5.0)) == expected


@pytest.mark.parametrize(
    ("bin_", "expected"),
    [(9, SHOWS), (10, SHOWS), (11, SHOWS), (12, PAST), (357, PAST), (358, SHOWS), (359, SHOWS)],
)
def test_a_surface_shown_within_two_degrees_stands(bin_, expected):
    ranges = np.full(360, 8.0)
    ranges[:10] = 2.0
    assert told(at(bin_ + 0.5, 2.0), ranges) == expected


@pytest.mark.parametrize(("bin_", "expected"), [(11, UNTOLD), (12, PAST), (357, PAST), (358, UNTOLD)])
def test_within_two_degrees_of_something_nearer_a_node_does_not_see_past(bin_, expected):
    ranges = np.full(360, 8.0)
    ranges[:10] = 2.0
    assert told(at(bin_ + 0.5, 4.0), ranges) == expected


def test_even_a_nearer_range_that_is_not_firm_is_in_the_way():
    held = estimate(0, np.r_[np.full(10, 2.0), np.full(350, 8.0)])
    held.samples[:10] = 1
    side = side_of([CENTRE], {0: held})
    points = np.array([at(bin_ + 0.5, 4.0) for bin_ in (11, 12)])
    assert [look.points.tolist() for look in looks(points, side, RULES)] == [[1]]


@pytest.mark.parametrize(
    ("range_m", "expected"),
    # the step is 3 % of the range; two of them before the radius is 9.434 m
    [(9.41, PAST), (9.45, UNTOLD), (10.1, UNTOLD)],
)
def test_clear_sees_past_what_lies_well_inside_the_radius(range_m, expected):
    assert told(at(90.5, range_m), np.full(360, np.inf)) == expected


def test_a_point_beyond_the_radius_cannot_be_told_whatever_the_range():
    assert told(at(90.5, 9.9), np.full(360, 9.95)) == SHOWS
    assert told(at(90.5, 10.05), np.full(360, 9.95)) == UNTOLD


def test_a_look_tells_from_where_and_when():
    nodes = [Node(30.0, 0.0), Node(1.0, 0.0)]
    side = side_of(nodes, {i: estimate(i, ring(CENTRE), stamp_ns=i + 5) for i in range(2)})
    (look,) = looks(np.array([(2.0, 0.001), (0.999, 3.0)]), side, RULES)
    order = np.argsort(look.points)
    assert look.points[order].tolist() == [0, 1]
    assert look.rows.tolist() == [1, 1]
    assert look.bins[order].tolist() == [0, 90]
    assert look.ranges[order] == pytest.approx([1.0, 3.0], abs=1e-5)
    assert look.seen_ns.tolist() == [6, 6]


NODES = [Node(x, y) for x in (-14.0, -2.0, 0.0, 9.5) for y in (-11.0, 0.5)]
HOUSE = side_of(NODES, estimates(NODES, [Box(1.0, 1.5), Box(-8.0, 0.0, 0.5, 4.0)], wall=OUTDOORS))


def all_looks(points):
    found = [
        looked
        for look in looks(points, HOUSE, RULES)
        for looked in zip(*(a.tolist() for a in (look.points, look.rows, look.bins, look.past)), strict=True)
    ]
    assert len(found) == len(set(found))
    return sorted(found)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.floats(-25, 20), st.floats(-22, 12)), min_size=1, max_size=20), st.integers(1, 40)
)
def test_many_points_are_looked_at_as_one_alone(points, at_once):
    points = np.array(points)
    alone = [(i, *look[1:]) for i in range(len(points)) for look in all_looks(points[i : i + 1])]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_PAIRS_AT_ONCE", at_once)
        assert all_looks(points) == alone


def test_no_points_have_no_looks():
    assert list(looks(np.empty((0, 2)), HOUSE, RULES)) == []
