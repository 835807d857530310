"""Half-lives that went by at a node."""

import numpy as np
import pytest

from benchmarks.changes.building import LANE
from benchmarks.changes.patrols import patrols
from benchmarks.changes.visits import Pace, paces
from tests.benchmarks.changes.making import S
from timemap_cli.spans import Span

SETTINGS = """
map: {node_spacing: 1.0}
gate: {min_travel: 0.05, min_turn_deg: 5.0, min_interval: 0.15s}
levels: [{name: short, half_life: 5obs}, {name: long, half_life: 10min}]
"""


def stamps(*seconds: float) -> np.ndarray:
    return np.array([round(s * S) for s in seconds])


def test_scans_are_counted_with_both_ends():
    pace = Pace(Span(2.0, "obs"), {7: stamps(1, 2, 3, 4)})
    assert pace.half_lives([7], 2 * S, 4 * S) == 1.5


def test_observed_time_leaves_absences_out():
    """1 s, then a day of which 10 s count, then 1 s: 12 s."""
    pace = Pace(Span(6.0, "s"), {7: stamps(0, 1, 86401, 86402)})
    assert pace.half_lives([7], 0, 90000 * S) == pytest.approx(2.0)


def test_of_several_nodes_the_median_counts():
    pace = Pace(Span(1.0, "obs"), {1: stamps(1), 2: stamps(1, 2, 3), 3: stamps(*range(10))})
    assert pace.half_lives([1, 2, 3], 0, 10 * S) == 3.0


def test_an_event_without_nodes_has_no_delay_and_a_node_without_scans_none_passed():
    pace = Pace(Span(1.0, "obs"), {})
    assert pace.half_lives([], 0, S) is None
    assert pace.half_lives([4], 0, S) == 0.0


def test_slower_levels_are_offered_every_second_scan_of_a_robot_that_drives():
    """At 0.8 m/s and 10 Hz: 0.08 m and 0.1 s from scan to scan, against 0.05 m and 0.15 s."""
    found = paces(patrols(1), [(6.0, LANE), (40.0, 40.0)], SETTINGS)
    assert found["short"].half_life == Span(5.0, "obs")
    assert found["long"].half_life == Span(600.0, "s")
    every, gated = found["short"].offered[0], found["long"].offered[0]
    assert len(every) == pytest.approx(2 * 2.0 / 0.08, abs=3)  # 2 m there, 2 m back
    assert len(gated) == pytest.approx(len(every) / 2, abs=2)
    assert len(found["short"].offered[1]) == 0
