"""How the benchmark accounts for what it ran."""

import json
import sys

import click
import pytest

from benchmarks.replay_hour import Cost, measured, report


def test_a_command_that_fails_is_no_measurement():
    with pytest.raises(click.ClickException, match="exit code 3"):
        measured([sys.executable, "-c", "raise SystemExit(3)"])


def test_processor_time_and_peak_memory_are_those_of_the_process():
    work = "import time\nheld = bytearray(100_000_000)\nwhile time.process_time() < 0.3: pass\nprint('done')"
    cost = measured([sys.executable, "-c", work])
    assert cost.output == "done\n"
    assert cost.cpu_s == pytest.approx(0.3, abs=0.2)
    assert cost.wall_s > 0.25
    assert cost.peak_mb > 100


def test_the_table_holds_medians_and_the_median_of_paired_ratios():
    made = json.dumps({"scans": {"read": 200, "used": 190}, "nodes": 120})
    replays = [Cost(2.0, 4.0, 100.0, made), Cost(9.0, 9.0, 100.0, made), Cost(3.0, 5.0, 100.0, made)]
    reads = [Cost(1.0, 2.0, 50.0, ""), Cost(3.0, 3.0, 50.0, ""), Cost(3.0, 5.0, 50.0, "")]
    lines = report(replays, reads).splitlines()
    assert lines[1].split()[-3:] == ["3.00", "3.00", "2.00"]
    assert lines[2].split()[-3:] == ["5.00", "3.00", "2.00"]
    assert lines[-2].endswith("190 of 200 (95.0%)")
    assert lines[-1].endswith("120")
