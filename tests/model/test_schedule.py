"""When the nodes that changed are estimated."""

import numpy as np
import pytest

from timemap_cli.model.schedule import Period, Schedule

SECOND = 10**9


def cuts(period, stamps, block=None):
    """Numbers of scans learnt before each time that estimates were due."""
    schedule, learnt, found = Schedule(period), 0, []
    for start in range(0, len(stamps), block or len(stamps)):
        part_stamps = np.asarray(stamps[start : start + (block or len(stamps))], np.int64)
        position = 0
        for part, due in schedule.parts(part_stamps):
            assert part.start == position
            position = part.stop
            learnt += part.stop - part.start
            found += [learnt] if due else []
        assert position == len(part_stamps)
    return found


def test_estimates_are_due_after_so_many_scans():
    assert cuts(Period(10, in_scans=True), range(35)) == [10, 20, 30]


def test_estimates_are_due_before_the_first_scan_of_a_new_period():
    stamps = [0, 3 * SECOND, 10 * SECOND - 1, 10 * SECOND, 12 * SECOND, 20 * SECOND]
    assert cuts(Period(10 * SECOND, in_scans=False), stamps) == [3, 5]


def test_periods_count_from_the_first_scan():
    stamps = [7 * SECOND, 16 * SECOND, 17 * SECOND, 26 * SECOND, 27 * SECOND]
    assert cuts(Period(10 * SECOND, in_scans=False), stamps) == [2, 4]


def test_a_long_absence_is_one_period():
    stamps = [0, 1 * SECOND, 604_800 * SECOND, 604_801 * SECOND, 604_812 * SECOND]
    assert cuts(Period(10 * SECOND, in_scans=False), stamps) == [2, 4]


@pytest.mark.parametrize("period", [Period(7, in_scans=True), Period(3 * SECOND, in_scans=False)])
@pytest.mark.parametrize("block", [1, 2, 7, 50])
def test_what_is_due_does_not_depend_on_blocks(period, block):
    stamps = np.cumsum(np.random.default_rng(1).integers(0, SECOND, 200))
    assert cuts(period, stamps, block) == cuts(period, stamps)


def test_no_scans_are_never_due():
    for period in (Period(7, in_scans=True), Period(SECOND, in_scans=False)):
        assert list(Schedule(period).parts(np.zeros(0, np.int64))) == []
