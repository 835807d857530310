import pytest

from timemap_cli.reports.event_selection import EventSelection, selected


def event(number, bounds, **more):
    return {
        "id": number,
        "bounds": bounds,
        "x": bounds[0],
        "y": bounds[1],
        "kind": "appeared",
        "support": 0.5,
        "adopted": {},
        "episodes": [{"since_ns": "0", "until_ns": None}],
        "first_seen_ns": "0",
        "last_seen_ns": "1",
    } | more


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_events_of_one_size_come_by_number_wherever_they_lie(order):
    # 0.3 - 0.2 is 0.09999999999999998, 0.4 - 0.3 is 0.10000000000000003
    bounds = [(0.2, 0.0, 0.3, 0.0), (0.3, 0.0, 0.4, 0.0)]
    events = [event(number, bounds[which]) for number, which in enumerate(order)]
    assert [one["id"] for one in selected(events, EventSelection(), "size")] == [0, 1]


def test_the_largest_event_comes_first():
    events = [event(0, (0.0, 0.0, 1.0, 0.0)), event(1, (0.0, 0.0, 0.0, 2.0))]
    assert [one["id"] for one in selected(events, EventSelection(), "size")] == [1, 0]
