"""The rivals, worked out by hand on one surface."""

import numpy as np

from benchmarks.paper.rivals import HitsByPasses, LastScan, LogOdds, MarkovChains
from benchmarks.paper.scene import ANGLE_BINS
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

FAR, NEAR = 2020, 1020  # in the cells whose middles are 2025 and 1025


def learnt(rival, *stretches):
    for value, scans in stretches:
        rival.learn(np.full((scans, 1, ANGLE_BINS), value, np.uint16))
    return int(rival.ranges()[0, 0])


def test_the_last_scan_keeps_what_is_out_of_view():
    assert learnt(LastScan(1), (FAR, 5), (NEAR, 1), (UNSEEN, 3)) == NEAR


def test_hits_by_passes_shows_a_new_thing_at_a_ninth_of_the_old_scans():
    assert learnt(HitsByPasses(1, 4.0), (FAR, 90), (NEAR, 9)) == 2025
    assert learnt(HitsByPasses(1, 4.0), (FAR, 90), (NEAR, 11)) == 1025


def test_hits_by_passes_needs_nine_times_as_many_passes_to_forget():
    assert learnt(HitsByPasses(1, 4.0), (NEAR, 10), (FAR, 80)) == 1025
    assert learnt(HitsByPasses(1, 4.0), (NEAR, 10), (FAR, 91)) == 2025


def test_clamped_log_odds_forget_after_nine_passes():
    """From 3.5 in steps of 0.4: 8 passes leave 0.3, 9 are below 0. From -2 in steps of 0.85: 3 hits."""
    assert learnt(LogOdds(1, 4.0), (NEAR, 100), (FAR, 8)) == 1025
    assert learnt(LogOdds(1, 4.0), (NEAR, 100), (FAR, 9)) == 2025
    assert learnt(LogOdds(1, 4.0), (FAR, 100), (NEAR, 2)) == 2025
    assert learnt(LogOdds(1, 4.0), (FAR, 100), (NEAR, 3)) == 1025


def test_a_cell_that_never_changed_is_believed_longer_than_one_that_often_does():
    steady, lively = (MarkovChains(1, 4.0) for _ in range(2))
    learnt(steady, (FAR, 200))
    for _ in range(10):
        learnt(lively, (FAR, 10), (NEAR, 10))
    learnt(lively, (FAR, 10))
    assert learnt(steady, (NEAR, 3)) == 2025
    assert learnt(lively, (NEAR, 3)) == 1025


def test_open_space_clears_every_grid():
    for rival in (HitsByPasses(1, 4.0), LogOdds(1, 4.0), MarkovChains(1, 4.0)):
        assert learnt(rival, (CLEAR, 20)) == CLEAR
        assert int(type(rival)(1, 4.0).ranges()[0, 0]) == UNSEEN
