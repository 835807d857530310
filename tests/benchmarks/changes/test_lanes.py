"""The building's patrols on other ways."""

import pytest

from benchmarks.changes.worlds.building import DAYS, DOORWAYS, NORTH, SOUTH, door_open
from benchmarks.changes.worlds.building import route as same_route
from benchmarks.changes.worlds.clearance import clearance
from benchmarks.changes.worlds.lanes import CLEAR_M, FAR_LANES, LANES, standing_on

DAYS_AND_SPREADS = [(spread, day) for spread in (LANES, FAR_LANES) for day in range(1, DAYS + 1)]


def rooms_of(way) -> set[str]:
    """The rooms in which a way has corners."""
    north = {("meeting", "store")[x > 8.0] for x, y in way if y > NORTH}
    south = {("office", "kitchen", "workshop")[(x > 6.0) + (x > 11.5)] for x, y in way if y < SOUTH}
    return north | south


@pytest.mark.parametrize(("spread", "day"), DAYS_AND_SPREADS)
def test_every_way_keeps_clear_and_looks_into_the_same_rooms(spread, day):
    way = spread.route(day)
    assert clearance(way, standing_on(day)) >= CLEAR_M
    assert rooms_of(way) == rooms_of(same_route(day))
    assert rooms_of(way) == DOORWAYS.keys() - ({"store"} if not door_open(day) else set())


@pytest.mark.parametrize("spread", [LANES, FAR_LANES])
def test_lane_order_and_direction_change_from_day_to_day(spread):
    ways = [spread.route(day) for day in range(1, DAYS + 1)]
    lanes = [way[0][1] for way in ways]
    assert max(lanes) - min(lanes) > 0.5
    assert {way[0][0] for way in ways} == {1.0, 17.0}
    assert len({tuple(x for x, y in way if y in lanes) for way in ways}) == DAYS


def test_a_way_is_the_same_every_time():
    assert LANES.route(5) == LANES.route(5)
    assert LANES.route(5) != FAR_LANES.route(5)
