"""The commands together, on the sample recordings."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.program import timemap

SAMPLES = Path(__file__).parents[2] / "sample_logs"
MONDAY, TUESDAY = SAMPLES / "patrol_monday.mcap", SAMPLES / "patrol_tuesday.bag"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder in which Monday was replayed with no option but --json; its exit code, output and complaints."""
    folder = tmp_path_factory.mktemp("monday")
    args = [sys.executable, "-m", "timemap_cli", "replay", str(MONDAY), "--json"]
    ran = subprocess.run(args, cwd=folder, capture_output=True, text=True, check=False)
    (folder / "replay.json").write_text(ran.stdout)
    assert (ran.returncode, ran.stderr) == (0, "")
    return folder


def test_a_replay_writes_one_result_and_tells_of_every_scan(folder):
    told = json.loads((folder / "replay.json").read_text())
    assert told["result"] == "patrol_monday.timemap.mcap"
    assert told["levels"] == ["short", "mid", "long"]
    assert told["nodes"] > 5
    scans = told["scans"]
    assert scans["read"] == scans["used"] + sum(scans["dropped"].values()) == 2049
    assert sorted(path.name for path in folder.iterdir()) == ["patrol_monday.timemap.mcap", "replay.json"]


def test_the_result_in_the_current_folder_can_be_compared_at_once(folder, monkeypatch):
    monkeypatch.chdir(folder)
    ran = timemap("diff", "--level", "long", "mid", "--json")
    assert ran.code == 0
    assert "patrol_monday.timemap.mcap" in ran.err
    assert json.loads(ran.out)["schema"] == "timemap.diff/1"


def test_an_existing_result_is_refused_without_force_and_left_alone(folder, monkeypatch):
    monkeypatch.chdir(folder)
    before = Path("patrol_monday.timemap.mcap").read_bytes()
    ran = timemap("replay", MONDAY)
    assert (ran.code, ran.out) == (2, "")
    assert "patrol_monday.timemap.mcap" in ran.err
    assert "--force" in ran.err
    assert Path("patrol_monday.timemap.mcap").read_bytes() == before


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["absent.bag"], "absent.bag"),
        ([MONDAY, "--scan-topic", "/nope"], "/nope"),
        ([MONDAY, "--map-frame", "nowhere"], "nowhere"),
        ([MONDAY, "--start", "soon"], "soon"),
        ([MONDAY, "-o", "absent/out.mcap"], "absent"),
    ],
)
def test_what_cannot_be_replayed_is_one_error_and_leaves_no_file(tmp_path, monkeypatch, args, said):
    monkeypatch.chdir(tmp_path)
    ran = timemap("replay", *args)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("error: ")
    assert said in ran.err
    assert list(tmp_path.iterdir()) == []


def test_results_and_recordings_are_told_apart(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = timemap("replay", folder / "patrol_monday.timemap.mcap")
    assert (ran.code, "result" in ran.err) == (2, True)
    ran = timemap("diff", MONDAY, "--level", "long", "mid")
    assert (ran.code, "recording" in ran.err) == (2, True)
    assert list(tmp_path.iterdir()) == []
