"""The same scans give the same result: whatever file they come from, however often."""

import numpy as np
import pytest

from tests.conftest import ROOT, shared_data
from timemap_cli.config import load
from timemap_cli.replay import replay
from timemap_cli.results.reader import ResultReader


def all_estimates(result):
    with ResultReader(result) as reader:
        return {level: reader.estimates(level) for level in reader.levels}


def assert_same(one, other):
    assert one.keys() == other.keys()
    for level in one:
        assert one[level].keys() == other[level].keys()
        for node, estimate in one[level].items():
            twin = other[level][node]
            assert estimate.stamp_ns == twin.stamp_ns
            for field in ("ranges", "support", "known", "samples", "status", "last_seen_ns"):
                assert np.array_equal(
                    getattr(estimate, field), getattr(twin, field), equal_nan=field == "ranges"
                )


def test_three_formats_of_one_recording_give_the_same_estimates_to_the_bit(tmp_path):
    found = []
    for name in ("intel.mcap", "intel.bag", "intel_db3"):
        summary = replay([shared_data(f"intel/{name}")], tmp_path / f"{name}.timemap.mcap", load(None))
        found.append(all_estimates(summary.result))
        assert summary.scans_used == 910
    assert_same(found[0], found[1])
    assert_same(found[0], found[2])


@pytest.mark.parametrize("processors", [{0}, {0, 1}])
def test_two_runs_give_the_same_bytes_with_one_process_or_two(tmp_path, monkeypatch, processors):
    log = "sample_logs/patrol_tuesday.bag"
    results = []
    for number in range(2):
        results.append(tmp_path / f"{number}.timemap.mcap")
        replay([ROOT / log], results[-1], load(None), end="+150s")
        monkeypatch.setattr("timemap_cli.second_process._usable_processors", lambda: processors)
    assert results[0].read_bytes() == results[1].read_bytes()
