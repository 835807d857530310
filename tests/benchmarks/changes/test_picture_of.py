"""What is drawn of the worlds."""

import pytest

from benchmarks.changes.picture_of import picture_of


@pytest.mark.parametrize(("world", "changes"), [("building", 9), ("far_lanes", 9), ("hall1", 7), ("wh10", 0)])
def test_every_world_has_a_second_day_to_be_drawn(world, changes):
    first, second = (picture_of(world, day) for day in (1, 2))
    assert len(first.changes) == len(second.changes) == changes
    assert first.drive.start_ns < second.drive.start_ns
