"""Recordings that are damaged at random, a few hundred of them; `make damage` does thousands."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from benchmarks.damage import trial
from benchmarks.damage.damages import damaged
from benchmarks.damage.recordings import FORMATS
from benchmarks.damage.table import table
from benchmarks.damage.trial import BAD, Bench, Outcome, Trial, Verdict, sentence
from benchmarks.damage.workers import run

EACH = 20  # cases of a format


@pytest.fixture(autouse=True)
def one_process(monkeypatch):
    monkeypatch.setattr("timemap_cli.second_process._usable_processors", lambda: {0})


@pytest.mark.parametrize("name", FORMATS)
def test_no_damage_ends_in_a_traceback_or_in_a_result_that_only_looks_complete(name, tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "peak_mb", lambda: 0.0)  # that of all tests before
    bench = Bench(name, tmp_path)
    found = [bench.trial(number, seed=1) for number in range(EACH)]
    assert not [one for one in found if one.verdict in BAD]
    assert {one.verdict for one in found} > {Verdict.TOLD}


def test_the_undamaged_recordings_hold_the_same(tmp_path):
    digests = set()
    for name in FORMATS:
        (tmp_path / name).mkdir()
        bench = Bench(name, tmp_path / name)
        assert (bench.expected.used, bench.expected.words.count("damaged")) == (60, 0)
        digests.add(bench.expected.digest)
    assert len(digests) == 1


def test_a_case_is_the_same_each_time(tmp_path):
    bench = Bench("bag", tmp_path)
    one, other = (bench.trial(7, seed=3) for _ in range(2))
    assert one == other


def test_every_damage_changes_the_content_and_the_seed_decides():
    content = bytes(range(256)) * 40
    found = [damaged(content, np.random.default_rng(seed)) for seed in range(60)]
    assert len({one.kind for one in found}) == 7
    assert sum(one.content != content for one in found) > 55
    assert found[5] == damaged(content, np.random.default_rng(5))


@pytest.mark.parametrize(
    ("outcome", "verdict"),
    [
        (Outcome(1, "error: no"), Verdict.REFUSED),
        (Outcome(3, "warning: cut off", 50, 1), Verdict.TOLD),
        (Outcome(3, "", 50, 1), Verdict.SILENT),
        (Outcome(0, "", 59, 1), Verdict.SILENT),
        (Outcome(0, "", 60, 1), Verdict.VALUES),
    ],
)
def test_a_result_with_fewer_scans_must_say_so(outcome, verdict, tmp_path):
    assert Bench("mcap", tmp_path)._judge(outcome)[0] == verdict


def test_the_undamaged_result_is_whole(tmp_path):
    bench = Bench("mcap", tmp_path)
    assert bench._judge(bench.expected)[0] == Verdict.WHOLE


def test_a_traceback_and_a_warning_of_numpy_are_crashes(tmp_path, monkeypatch):
    bench = Bench("mcap", tmp_path)

    def replay(*_):
        warnings.warn("overflow", RuntimeWarning, stacklevel=1)

    monkeypatch.setattr(trial, "replay", replay)
    assert bench.trial(0, seed=0).verdict == Verdict.CRASH


def test_a_process_that_ends_is_told_and_the_cases_behind_it_are_done(monkeypatch):
    monkeypatch.setattr("benchmarks.damage.workers.Bench", _Ending)
    found = run("bag", range(5), seed=0, workers=1)
    assert [one.verdict for one in found] == [
        Verdict.WHOLE, Verdict.WHOLE, Verdict.HANG, Verdict.WHOLE, Verdict.WHOLE,
    ]  # fmt: skip


class _Ending:
    """A bench whose third case ends its process."""

    def __init__(self, *_):
        pass

    def trial(self, number, seed):
        if number == 2:
            raise SystemExit(0)
        return Trial(number, "", Verdict.WHOLE, "")


def test_the_table_counts_by_format_and_verdict():
    told, whole = Trial(0, "a cut", Verdict.TOLD, ""), Trial(1, "a cut", Verdict.WHOLE, "")
    lines = table({"bag": [told, whole], "mcap": [told]}).splitlines()
    assert lines[0].startswith("| format | cases | refused | told | whole |")
    assert lines[2] == "| bag | 2 | 0 | 1 | 1 | 0 | 0 | 0 | 0 | 0 |"
    assert lines[4] == "| all | 3 | 0 | 2 | 1 | 0 | 0 | 0 | 0 | 0 |"


def test_sentences_are_the_same_whatever_the_place():
    words = "warning: /tmp/x/run.bag: it is cut off at byte 17 of 20"
    assert sentence(words) == "warning: run.bag: it is cut off at byte N of N"
