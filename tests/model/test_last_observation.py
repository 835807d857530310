"""A window of one sample with a half-life of one scan: the last observation as it is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.model.memories import codes, learnt, recalled
from timemap_cli.config import load
from timemap_cli.model.estimator import estimate
from timemap_cli.model.levels import Level
from timemap_cli.model.paper_profile import estimate_as_in_paper
from timemap_cli.model.virtual_scan import UNSEEN

SCANS = st.lists(
    st.lists(st.sampled_from([0.5, 0.52, 1.4, 3.0, np.inf, np.nan]), min_size=6, max_size=6),
    min_size=1,
    max_size=30,
)


@given(SCANS, st.sampled_from([1.0, 0.7]))
def test_it_shows_in_each_angle_bin_what_was_seen_there_last(scans, half_life):
    expected = np.full(6, UNSEEN, np.uint16)
    for scan in codes(scans):
        expected = np.where(scan == UNSEEN, expected, scan)
    found = estimate(recalled(learnt(scans, 1, half_life)), state_width=0.1)
    assert found.ranges[0].tolist() == expected.tolist()


@given(SCANS)
def test_in_the_papers_profile_it_shows_the_last_scan_where_that_saw_all(scans):
    whole = [*scans, [0.5, 0.5, 1.4, 3.0, np.inf, 0.52]]
    found = estimate_as_in_paper(recalled(learnt(whole, 1, 1.0)), range_bin=0.1)
    assert found.ranges[0].tolist() == codes(whole)[-1].tolist()


def test_with_a_longer_half_life_it_takes_scans_at_random():
    assert Level("a", 1, 1.0).places_replaced(1.0) == 1.0
    assert Level("a", 1, 2.0).places_replaced(1.0) == pytest.approx(1 - 2**-0.5)


def test_it_may_stand_before_the_other_levels():
    levels = [
        {"name": "now", "window": 1, "half_life": "1obs"},
        {"name": "long", "window": 100, "half_life": "200obs"},
    ]
    assert [level.window for level in load(None, {"levels": levels}).levels] == [1, 100]
