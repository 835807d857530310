"""A baseline that is made of a result expects what a replay of its recordings gives, to the digest."""

from dataclasses import replace

import pytest

from tests.conftest import ROOT, shared_data
from tests.logs.recorded import write_mcap
from tests.simulated import in_order, moving, scanner, scans, static
from timemap_cli.checking import Check, check, update
from timemap_cli.checks import baseline_file
from timemap_cli.config import load
from timemap_cli.replay import replay

SAMPLES = [ROOT / "sample_logs" / n for n in ("patrol_monday.mcap", "patrol_tuesday.bag", "patrol_thursday")]


def made_of_a_result(folder, logs, nodes=None):
    result = replay(logs, folder / "one.timemap.mcap", load(None), nodes=nodes).result
    update(Check((result,), folder / "one.yaml", "one"))
    return Check(tuple(logs), folder / "one.yaml", "one", exact=True)


def assert_same(one):
    verdict = check(one).verdict
    assert verdict.unequal == ()
    assert not verdict.failures


def wean():
    return [shared_data(f"wean/wean_run{run}.mcap") for run in (1, 3, 4)]


@pytest.mark.parametrize("logs", [lambda: SAMPLES, wean], ids=["sample_logs", "wean"])
def test_its_own_recordings_pass(tmp_path, logs):
    assert_same(made_of_a_result(tmp_path, logs()))


def test_its_own_recordings_pass_where_the_nodes_were_given(tmp_path):
    places = tmp_path / "nodes.csv"
    places.write_text("2 2\n8 2\n5 5\n")
    assert_same(made_of_a_result(tmp_path, SAMPLES[:1], places))


def test_written_anew_from_recordings_it_keeps_its_nodes_and_the_way_they_came(tmp_path):
    one = made_of_a_result(tmp_path, SAMPLES[:1])
    before = (tmp_path / "one.yaml").read_text()
    update(one)
    assert (tmp_path / "one.yaml").read_text() == before


def drives(folder, begin):
    laser = scanner(step_deg=3.0, beams=120)
    messages = in_order([static((laser, "laser"))], moving(), scans(laser, begin=begin))
    return write_mcap(folder / f"{begin}.mcap", messages)


def test_a_drive_along_the_same_way_lays_the_same_nodes(tmp_path):
    """Its scans are taken half a period later, so that it would lay its own some centimetres beside."""
    log, later = drives(tmp_path, 0.5), drives(tmp_path, 0.55)
    one = made_of_a_result(tmp_path, [log])
    update(Check((later,), tmp_path / "later.yaml", "later"))
    found = check(replace(one, sources=(later,), exact=False)).verdict
    own, expected = (
        baseline_file.read(tmp_path / name).expected.nodes for name in ("later.yaml", "one.yaml")
    )
    assert set(own) != set(expected)
    nodes = {measure.name: measure.value for measure in found.measures if measure.name.startswith("nodes.")}
    assert nodes["nodes.missing"] == nodes["nodes.new"] == 0


def test_a_result_whose_nodes_came_in_another_way_is_told_to_be_one(tmp_path):
    """A baseline that is made of recordings lays the nodes first and replays with all of them from the start."""
    logs = wean()
    update(Check(tuple(logs), tmp_path / "one.yaml", "one"))
    result = replay(logs, tmp_path / "one.timemap.mcap", load(None)).result
    verdict = check(Check((result,), tmp_path / "one.yaml", "one")).verdict
    assert verdict.failures
    assert any("known from the start" in cause for cause in verdict.causes)
    assert not any(
        "known from the start" in cause
        for cause in check(Check(tuple(logs), tmp_path / "one.yaml", "one")).verdict.causes
    )
