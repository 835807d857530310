"""How well a scan fits elsewhere: a robot that is beside its pose, or turned, is found; a changed room is not."""

import math

import numpy as np
import pytest

from tests.model.memories import codes
from tests.model.scenes import ROOM, cast, pillar, rectangle
from timemap_cli.model.contradiction import Bounds
from timemap_cli.model.misplaced import fits, turns, unmoved

REACH = 10_000  # [mm]


def seen_from(segments, x=0.0, y=0.0, turned=0.0, angle_bins=360):
    """What a robot at (x, y), turned, makes of a room (angle_bins,) if it believes itself at the node at (0, 0)."""
    middles = (np.arange(angle_bins) + 0.5) * (2 * math.pi / angle_bins)
    return codes(cast(segments, x, y, middles + turned)[None])[0]


def fitting(seen, held):
    return fits(seen, Bounds.around(held[None], REACH))


def test_a_scan_from_where_it_believes_to_be_fits_best_unmoved():
    held = seen_from(ROOM)
    found = fitting(held, held)
    assert found[unmoved(360)] == found.max() == 1


@pytest.mark.parametrize("angle_bins", [360, 120, 720])
@pytest.mark.parametrize(
    ("x", "y", "degrees"), [(0.5, 0.0, 0), (-0.3, 0.4, 0), (0.0, 0.0, 20), (0.0, 0.0, -13), (0.4, 0.3, 15)]
)
def test_a_scan_from_beside_its_pose_fits_elsewhere(x, y, degrees, angle_bins):
    held = seen_from(ROOM, angle_bins=angle_bins)
    found = fitting(seen_from(ROOM, x, y, math.radians(degrees), angle_bins), held)
    assert found.max() > 0.85
    assert found[unmoved(angle_bins)] < 0.7


def test_a_scan_of_a_room_that_was_refurnished_fits_nowhere_better():
    held = seen_from(np.concatenate((ROOM, pillar(1.2, 0.4, 0.9), pillar(-0.9, -1.2, 0.8))))
    seen = seen_from(np.concatenate((ROOM, pillar(-1.1, 0.5, 0.9), pillar(0.8, -1.1, 0.9))))
    found = fitting(seen, held)
    assert found.max() - found[unmoved(360)] < 0.1


def test_what_is_not_known_and_what_is_clear_fits_nothing():
    seen = seen_from(rectangle(-2, -2, 2, 2))
    assert fitting(seen, codes(np.full(360, np.nan))).max() == 0
    assert fitting(seen, codes(np.full(360, np.inf))).max() == 0


def test_few_hits_fit_little_wherever_they_fit():
    held = seen_from(rectangle(-2, -2, 2, 2))
    few = np.where(np.arange(360) < 12, held, codes(np.inf))
    assert 0 < fitting(few, held).max() <= 0.2 + 1e-9


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_scan_without_hits_fits_nowhere(value):
    held = seen_from(ROOM)
    assert fitting(codes(np.full(360, value)), held).max() == 0


@pytest.mark.parametrize(("angle_bins", "turned"), [(360, 13), (12, 3), (3, 1), (720, 13)])
def test_turns_are_whole_angle_bins_and_none_is_among_them(angle_bins, turned):
    assert len(turns(angle_bins)) == turned
    assert 0 in turns(angle_bins)
    assert (
        len(fitting(np.full(angle_bins, 2000, np.uint16), np.full(angle_bins, 2000, np.uint16))) % turned == 0
    )
