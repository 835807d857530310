"""Codes that drivers put where ranges belong: each test is named after what the driver does."""

import numpy as np
import pytest

from timemap_cli.logs.batches import BeamLayout, ScanBatch
from timemap_cli.logs.beams import BeamCounts, settle

INF, NAN = np.inf, np.nan


def batch(ranges, range_max=30.0, range_min=0.1):
    ranges = np.asarray(ranges, np.float32)
    count = len(ranges)
    stamps = np.arange(count, dtype=np.int64)
    layout = BeamLayout(-1.5, float(np.radians(1.0)), ranges.shape[1], range_min)
    maxima = np.broadcast_to(np.asarray(range_max, np.float32), (count,))
    return ScanBatch("/scan", "laser", layout, stamps, stamps, ranges, maxima, np.zeros(count, np.float32))


def room(n_scans=40, n_beams=180, seed=0):
    """Ranges between 1 and 6 m, rounded to a centimetre as a SICK does."""
    rng = np.random.default_rng(seed)
    walls = 3.5 + 2.5 * np.sin(np.linspace(0, 7, n_beams))[None, :] * rng.uniform(0.8, 1, (n_scans, 1))
    return np.round(walls + rng.normal(0, 0.02, (n_scans, n_beams)), 2).clip(0.5)


def with_code(code, every=9):
    ranges = room()
    ranges[:, ::every] = code
    return ranges


def resolved(scans):
    beams = settle([scans])
    return beams.resolve(scans.ranges, scans.range_max)


def assert_code_is_no_return(scans, every=9):
    out = resolved(scans)
    assert np.isposinf(out[:, ::every]).all()
    others = np.delete(out, np.s_[::every], axis=1)
    np.testing.assert_array_equal(others, np.delete(scans.ranges, np.s_[::every], axis=1))


def test_plus_inf_is_no_return_as_rep_117_has_it():
    assert_code_is_no_return(batch(with_code(INF)))


def test_nan_is_no_evidence():
    assert np.isnan(resolved(batch(with_code(NAN)))[:, ::9]).all()


def test_minus_inf_is_too_close_and_no_evidence():
    scans = batch(with_code(-INF))
    assert np.isnan(resolved(scans)[:, ::9]).all()
    assert settle([scans]).count(scans.ranges, scans.range_max) == BeamCounts(40 * 160, 0, 0, 40 * 20)


def test_zero_is_no_evidence():
    scans = batch(with_code(0.0))
    assert np.isnan(resolved(scans)[:, ::9]).all()
    assert settle([scans]).found == ("invalid: 0 (no evidence)",)


def test_the_constant_range_max_is_no_return():
    assert_code_is_no_return(batch(with_code(30.0), range_max=30.0))


def test_range_max_plus_one_is_no_return():
    assert_code_is_no_return(batch(with_code(31.0), range_max=30.0))


def test_the_constant_range_max_is_no_return_even_where_ranges_come_close_to_it():
    ranges = with_code(6.0, every=9).clip(None, 5.99)
    ranges[:, ::9] = 6.0
    assert_code_is_no_return(batch(ranges, range_max=6.0))


def test_65_533_is_no_return():
    assert_code_is_no_return(batch(with_code(65.533), range_max=20.0))


@pytest.mark.parametrize("code", [81.83, 81.87, 81.91])
def test_the_numbers_of_a_sick_lms_are_no_return(code):
    assert_code_is_no_return(batch(with_code(code), range_max=80.0))


def test_several_numbers_of_a_sick_lms_are_all_no_return():
    ranges = with_code(81.91)
    ranges[::2, ::9] = 81.87
    scans = batch(ranges, range_max=80.0)
    assert_code_is_no_return(scans)
    assert settle([scans]).found == ("no return: 81.87, 81.91 m (the scanner's own code)",)


def test_a_rare_number_of_a_sick_lms_is_no_return():
    ranges = room()
    ranges[3, 50] = 81.91
    assert np.isposinf(resolved(batch(ranges, range_max=80.0))[3, 50])


def test_a_large_number_that_repeats_all_around_is_no_return_though_no_one_knows_it():
    assert_code_is_no_return(batch(with_code(16.0), range_max=40.0))


def test_a_far_wall_seen_by_a_standing_scanner_is_a_hit():
    ranges = np.broadcast_to(room(n_scans=1), (40, 180)).copy()
    ranges[:, 60:66] = 12.0
    np.testing.assert_array_equal(resolved(batch(ranges)), np.float32(ranges))


def test_a_range_max_that_is_the_largest_of_each_scan_is_a_hit():
    ranges = room()
    scans = batch(ranges, range_max=ranges.max(axis=1))
    np.testing.assert_array_equal(resolved(scans), scans.ranges)
    beams = settle([scans])
    assert beams.found == ("range_max is the largest range of each scan: not used",)
    assert 5 < beams.clear_range < 7


def test_a_range_max_that_differs_from_scan_to_scan_and_is_shown_by_many_beams_is_no_return():
    ranges, limits = room(), 20 + np.arange(40) / 10
    ranges[:, ::9] = limits[:, None]
    assert_code_is_no_return(batch(ranges, range_max=limits))


@pytest.mark.parametrize("range_max", [0.0, NAN, INF])
def test_without_a_range_max_the_scanner_sees_as_far_as_it_was_seen_to(range_max):
    beams = settle([batch(with_code(INF), range_max=range_max)])
    assert beams.clear_range == pytest.approx(room().max(), abs=0.2)
    assert "range_max is not given" in beams.found


def test_ranges_beyond_range_max_are_hits_and_told():
    ranges = room()
    ranges[:, 10] = np.linspace(12.1, 24.8, 40)
    scans = batch(ranges, range_max=12.0)
    np.testing.assert_array_equal(resolved(scans), scans.ranges)
    beams = settle([scans])
    assert beams.clear_range == 12.0
    assert beams.found == ("0.56 % of the hits lie beyond range_max 12 m",)


def test_a_range_max_that_many_ranges_exceed_is_not_the_scanners():
    beams = settle([batch(room(), range_max=2.0)])
    assert beams.clear_range > 5


def test_blind_beams_below_range_min_are_no_evidence():
    scans = batch(with_code(0.019), range_min=0.02)
    assert np.isnan(resolved(scans)[:, ::9]).all()
    beams = settle([scans])
    assert beams.found == ("blind: 0.019 m in 11 % of the beams",)
    assert beams.count(scans.ranges, scans.range_max).too_close == 40 * 20


def test_error_codes_in_millimetres_are_no_evidence_where_range_min_is_zero():
    assert np.isnan(resolved(batch(with_code(0.006), range_min=0.0))[:, ::9]).all()


def test_the_range_min_itself_is_a_hit():
    ranges = room()
    ranges[:, 5] = 0.1
    np.testing.assert_array_equal(resolved(batch(ranges))[:, 5], np.full(40, np.float32(0.1)))


def test_missing_returns_can_be_taken_as_no_evidence():
    scans = batch(with_code(INF))
    beams = settle([scans]).ignoring_missing()
    assert np.isnan(beams.resolve(scans.ranges, scans.range_max)[:, ::9]).all()
    assert beams.count(scans.ranges, scans.range_max).no_return == 40 * 20


def test_the_kinds_of_beams_add_up():
    ranges = room()
    ranges[:, :5] = [INF, NAN, 0.0, -INF, 0.05]
    beams = settle([batch(ranges)])
    counted = beams.count(np.float32(ranges), np.full(40, 30, np.float32))
    assert counted == BeamCounts(hit=40 * 175, no_return=40, invalid=80, too_close=80)
    assert counted.total == ranges.size


def test_what_was_recorded_is_not_changed():
    scans = batch(with_code(30.0))
    before = scans.ranges.copy()
    resolved(scans)
    np.testing.assert_array_equal(scans.ranges, before)


def test_scans_that_hold_nothing_can_be_settled():
    for code in (INF, NAN, 0.0, 30.0):
        scans = batch(np.full((10, 180), code))
        assert not np.isfinite(resolved(scans)).any()


def test_scans_without_beams_can_be_settled():
    scans = batch(np.empty((3, 0)))
    assert resolved(scans).shape == (3, 0)
