"""What a page shows is what the result holds."""

import base64
import json
import zlib

import numpy as np
import pytest

from tests.cli.result_files import BINS, SECOND, START, all_levels, write
from tests.reports.pages import CHANGES, INPUTS, NODES, REPORT, at, write_page_result
from timemap_cli.reports import page_data as module
from timemap_cli.reports.page_data import page_data
from timemap_cli.results.reader import ResultReader


@pytest.fixture
def data(tmp_path):
    with ResultReader(write_page_result(tmp_path / "r.timemap.mcap")) as reader:
        return page_data(reader)


def unpacked(text, kind):
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), kind)


def estimates(data, level):
    """Steps, nodes and ranges [cm] of a level, as the page's script reads them."""
    packed = data["estimates"][level]
    return (
        unpacked(packed["step"], "<u2").tolist(),
        unpacked(packed["node"], "<u4").tolist(),
        unpacked(packed["ranges"], "<u2").reshape(-1, data["angle_bins"]),
    )


def test_every_time_of_an_estimate_is_a_step_of_the_slider(data):
    assert data["times"] == [at(0), at(10), at(20)]


def test_every_node_and_time_has_a_row(data):
    steps, nodes, _ = estimates(data, "mid")
    assert list(zip(steps, nodes, strict=True)) == [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)]


@pytest.mark.parametrize(("level", "at_the_end"), [("short", 200), ("mid", 200), ("long", 400)])
def test_ranges_are_the_estimates_in_centimetres(data, level, at_the_end):
    ranges = estimates(data, level)[2]
    assert ranges.shape == (6, BINS)
    assert (ranges[:4] == 400).all()
    assert (ranges[4:, 75:105] == at_the_end).all()
    assert (np.delete(ranges[4:], np.s_[75:105], axis=1) == 400).all()


def test_clear_and_unknown_are_told_apart_and_are_no_range():
    ranges = np.array([[1.004, np.inf, np.nan, 655.33]], np.float32)
    estimate = type("Row", (), {"ranges": ranges[0], "node": 0})
    packed = module._packed([(0, estimate)], 4)
    assert unpacked(packed["ranges"], "<u2").tolist() == [100, 65534, 65535, 65533]


def test_where_there_are_more_times_than_steps_the_newest_of_each_step_are_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "MOST_STEPS", 3)
    path = write(tmp_path / "r.timemap.mcap", [(s, all_levels(s == 40)) for s in (0, 10, 20, 30, 40)])
    with ResultReader(path) as reader:
        data = page_data(reader)
    assert data["times"] == [at(0), at(20), at(40)]
    steps, _, ranges = estimates(data, "long")
    assert steps == [0, 1, 2]
    assert ranges[:, 90].tolist() == [400, 400, 200]


def test_coverage_counts_the_angle_bins_that_each_level_knows(data):
    assert data["coverage"] == {"nodes": [0, 1], "short": [BINS] * 2, "mid": [BINS] * 2, "long": [BINS] * 2}


def test_nodes_events_scans_recordings_and_settings_are_those_of_the_result(data):
    assert data["nodes"] == [[node.x, node.y] for node in NODES]
    assert data["changes"] == CHANGES
    assert data["report"] == REPORT
    assert data["inputs"] == INPUTS
    assert data["settings"] == "seed: 0\n"
    assert ["map_frame", "map"] in data["made"]


def test_the_data_are_json_without_numbers_that_json_lacks(data):
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert int(data["times"][0]) == START
    assert int(data["times"][-1]) - START == 20 * SECOND
