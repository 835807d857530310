"""Real recordings replay with no option given."""

import pytest

from tests.conftest import shared_data
from timemap_cli.config import load
from timemap_cli.replay import replay


@pytest.mark.parametrize(
    ("name", "read", "used"),
    [
        ("intel/intel.mcap", 910, 910),
        ("intel/intel.bag", 910, 910),
        ("intel/intel_db3", 910, 910),
        ("wean/wean_run1.mcap", 713, 700),
        ("wean/wean_run1.bag", 713, 700),
        ("olin_mac1", 357, 350),
        ("bham_pioneer/trace1.bag", 906, 890),
    ],
)
def test_a_recording_is_used_and_nothing_is_dropped_in_silence(tmp_path, name, read, used):
    summary = replay([shared_data(name)], tmp_path / "result.timemap.mcap", load(None))
    assert summary.scans_read == read
    assert summary.scans_used >= used
    assert summary.scans_used + sum(summary.dropped.values()) == read
    assert not summary.data_lost


def test_odometry_alone_works_with_a_warning(tmp_path):
    summary = replay([shared_data("olin_mac1")], tmp_path / "result.timemap.mcap", load(None))
    assert any("odometry drifts" in warning for warning in summary.warnings)
