"""Half-lives that went by at a node."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.changes.visits import Pace, offered_scans, paces
from benchmarks.changes.worlds.building import LANE
from benchmarks.changes.worlds.patrols import patrols
from tests.benchmarks.changes.making import S
from tests.cli.program import timemap
from timemap_cli.spans import Span


def stamps(*seconds: float) -> np.ndarray:
    return np.array([round(s * S) for s in seconds])


def test_scans_are_counted_with_both_ends():
    pace = Pace(Span(2.0, "obs"), {7: stamps(1, 2, 3, 4)}, {})
    assert pace.half_lives([7], 2 * S, 4 * S) == 1.5


def test_observed_time_leaves_absences_out():
    """1 s, then a day of which 10 s count, then 1 s: 12 s."""
    pace = Pace(Span(6.0, "s"), {7: stamps(0, 1, 86401, 86402)}, {})
    assert pace.half_lives([7], 0, 90000 * S) == pytest.approx(2.0)


def test_of_several_nodes_the_median_counts():
    pace = Pace(Span(1.0, "obs"), {1: stamps(1), 2: stamps(1, 2, 3), 3: stamps(*range(10))}, {})
    assert pace.half_lives([1, 2, 3], 0, 10 * S) == 3.0


def test_at_a_node_without_scans_nothing_went_by():
    pace = Pace(Span(1.0, "obs"), {}, {})
    assert pace.half_lives([4], 0, S) == 0.0
    assert pace.half_lives_before([4], 0, S) == 0.0


def test_before_means_up_to_the_estimate_before():
    """Estimates of scans up to 2, 5 and 8 s: at 6 s the newest is that of 5 s, the one before that of 2 s."""
    pace = Pace(Span(1.0, "obs"), {7: stamps(*range(1, 10))}, {7: stamps(2, 5, 8)})
    assert pace.half_lives_before([7], 0, 6 * S) == 2.0
    assert pace.half_lives_before([7], 0, 8 * S) == 5.0
    assert pace.half_lives_before([7], 0, 3 * S) == 0.0


def test_slower_levels_are_offered_every_second_scan_of_a_robot_that_drives():
    """At 0.8 m/s and 10 Hz: 0.08 m and 0.1 s from scan to scan, against 0.05 m and 0.15 s."""
    settings = {
        "map": {"node_spacing": 1.0},
        "gate": {"min_travel": 0.05, "min_turn_deg": 5.0, "min_interval": "0.15s"},
    }
    every, gated = offered_scans(patrols(1), [(6.0, LANE), (40.0, 40.0)], settings)
    assert len(every[0]) == pytest.approx(2 * 2.0 / 0.08, abs=3)  # 2 m there, 2 m back
    assert len(gated[0]) == pytest.approx(len(every[0]) / 2, abs=2)
    assert len(every[1]) == len(gated[1]) == 0


def test_a_result_tells_its_levels_paces(tmp_path):
    """Half a minute of the sample patrol, estimated every 10 s and at the end."""
    sample = Path(__file__).parents[3] / "sample_logs" / "patrol_monday.mcap"
    settings, result = tmp_path / "settings.yaml", tmp_path / "half.timemap.mcap"
    settings.write_text("estimate: {every: 10s}\nlevels: [{name: fast, window: 7, half_life: 10s}]\n")
    assert timemap("replay", sample, "--end", "+30s", "--config", settings, "-o", result, "--quiet").code == 0
    found = paces(result, patrols(1))
    assert found.keys() == {"fast"}
    assert found["fast"].half_life == Span(10.0, "s")
    estimated = found["fast"].estimated
    assert sorted(estimated) == list(range(len(estimated)))
    assert 1 <= len(estimated[0]) <= 4
    assert all(np.all(np.diff(stamps) > 0) for stamps in estimated.values())
