"""In how much of the circle virtual scans contradict each other."""

import numpy as np
import pytest

from tests.model.memories import codes
from timemap_cli.model.contradiction import Bounds, firm_ranges
from timemap_cli.model.estimates import Estimate

REACH = 10_000  # [mm]
INF, NAN = np.inf, np.nan


def contradiction(held, seen):
    """Of one angle bin or several, each repeated to make 12 [m]."""
    held, seen = (codes(np.resize(np.array(side, float), (1, 12))) for side in (held, seen))
    return float(Bounds.around(held, REACH).contradiction(seen)[0])


@pytest.mark.parametrize(
    ("held", "seen", "share"),
    [
        (2.0, 2.2, 0),  # 0.2 m is no contradiction ...
        (2.0, 2.201, 1),  # ... more is, farther ...
        (2.0, 1.799, 1),  # ... and nearer
        (2.0, 1.8, 0),
        (9.0, 9.27, 0),  # 3 % of 9 m
        (9.0, 9.271, 1),
        (0.1, 0.02, 0),  # 0.2 m nearer than that is behind the node
        (INF, INF, 0),
        (INF, 9.4, 0),  # within two steps, 2 * 3 % of 10 m, of the radius
        (INF, 9.39, 1),
        (2.0, INF, 1),
        (9.6, INF, 0),  # so close to the radius it may be clear at the next look
        (9.3, INF, 1),  # 9.3 m + 2 * 0.279 m is within the radius
        (9.6, 2.0, 1),
    ],
)
def test_what_contradicts_a_range(held, seen, share):
    assert contradiction(held, seen) == share


def test_the_share_counts_what_both_sides_know():
    held = [2, 2, 2, 2, NAN, NAN]
    seen = [2, 2, 3, NAN, 3, NAN]
    assert contradiction(held, seen) == pytest.approx(1 / 3)


def test_less_than_a_sixth_of_the_circle_decides_nothing():
    held = np.full(360, 2.0)
    for known, share in ((60, 1.0), (59, NAN)):
        seen = np.where(np.arange(360) < known, 3.0, NAN)
        found = Bounds.around(codes(held[None]), REACH).contradiction(codes(seen[None]))
        np.testing.assert_array_equal(found, [share])


def test_rows_that_were_never_set_contradict_nothing():
    bounds = Bounds.open(0, 12).with_rows(np.array([3]), Bounds.around(codes(np.full((1, 12), 2.0)), REACH))
    share = bounds.rows(np.arange(4)).contradiction(codes(np.full((4, 12), 5.0)))
    np.testing.assert_array_equal(share, [NAN, NAN, NAN, 1.0])


def estimate(ranges, support, known, samples):
    arrays = (np.array(values, np.float32) for values in (ranges, support, known))
    rest = np.zeros(len(samples), np.uint8), np.zeros(len(samples), np.int64)
    return Estimate(0, "long", 0, *arrays, np.array(samples, np.uint16), *rest)


def test_ranges_are_firm_with_samples_enough_and_half_of_what_is_known():
    found = estimate(
        [1.234, 1.234, 1.234, 1.234, INF, NAN],
        [0.9, 0.9, 0.5, 0.49, 0.9, 0.9],
        [1.0, 1.0, 0.3, 1.0, 1.0, 1.0],
        [15, 14, 15, 15, 15, 15],
    )
    expected = codes(np.array([[1.234, NAN, 1.234, NAN, INF, NAN]]))
    np.testing.assert_array_equal(firm_ranges([found], 15), expected)
