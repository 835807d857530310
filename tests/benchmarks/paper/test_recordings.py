"""What is counted on recordings without a truth: changes that are undone, and objects half old and half new."""

import numpy as np

from benchmarks.paper import recordings
from benchmarks.paper.recorded import Followed
from benchmarks.paper.recordings import Counts, counted, differs
from benchmarks.paper.section import Scale
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

MINUTE = 60 * 10**9


def ranges(*rows):
    return np.array(rows, np.uint16)


def node(scans, estimates, stamps_ns=None):
    stamps = np.arange(len(scans)) * 10**8 if stamps_ns is None else np.array(stamps_ns)
    return Followed(stamps, ranges(*scans), {"it": ranges(*estimates)})


def test_ranges_differ_beyond_the_larger_of_20_cm_and_3_percent():
    a, b = ranges([1000, 1000, 9000, 9000, 5000, CLEAR]), ranges([1200, 1201, 9270, 9271, CLEAR, CLEAR])
    assert differs(a, b).tolist() == [[False, True, False, True, True, False]]


def test_a_change_that_is_undone_is_flicker_and_one_that_stays_is_not():
    estimates = [[2000, 2000], [3000, 3000], [2000, 3000], [2000, 3000]]
    found = counted(node(estimates, estimates), "it")
    assert (found.steps, found.changes, found.returns) == (6, 3, 1)


def test_what_is_unknown_before_or_after_is_no_step():
    estimates = [[UNSEEN], [2000], [UNSEEN], [3000]]
    assert counted(node(estimates, estimates), "it").steps == 0


def test_a_hit_is_judged_by_the_estimate_before_it():
    found = counted(node([[2000], [2100], [3000], [CLEAR]], [[2000], [2900], [2900], [2900]]), "it")
    assert (found.hits, found.right) == (2, 2)


def test_an_object_that_is_shown_half_in_its_old_and_half_in_its_new_place_is_counted():
    old, new = [3000] * 6 + [4000] * 6, [2000] * 6 + [4000] * 6
    mixed = [2000] * 3 + [3000] * 3 + [4000] * 6
    stamps = [0, 1, 2, MINUTE, MINUTE + 1, MINUTE + 2]
    found = counted(node([old] * 3 + [new] * 3, [old] * 3 + [old, mixed, new], stamps), "it")
    assert (found.objects, found.halves) == (3, 1)


def test_scans_of_one_visit_are_no_change():
    old, new = [3000] * 6 + [4000] * 6, [2000] * 6 + [4000] * 6
    assert counted(node([old] * 3 + [new] * 3, [old] * 6), "it").objects == 0


def test_counts_add_up():
    assert Counts(1, 2, 3, 4, 5, 6, 7) + Counts(steps=10, halves=1) == Counts(11, 2, 3, 4, 5, 6, 8)


def test_without_the_recordings_the_old_section_stays(monkeypatch, capsys):
    monkeypatch.delenv("TIMEMAP_SHARED_DATA", raising=False)
    assert recordings.run(Scale.full) is None
    assert "TIMEMAP_SHARED_DATA" in capsys.readouterr().err
