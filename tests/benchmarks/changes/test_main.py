"""The whole benchmark on its first two days: the door opens, nothing else changes."""

import pytest
from click.testing import CliRunner

from benchmarks.changes.__main__ import SCENES, main
from benchmarks.changes.recordings import make, replayed
from benchmarks.changes.scenes.building import recordings_folder, report, unknown_share
from benchmarks.changes.truth import building_truth
from benchmarks.changes.worlds.patrols import patrols
from timemap_cli.results.reader import ResultReader


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    folder = tmp_path_factory.mktemp("building")
    recordings = make(folder, {one.file: one.drive() for one in patrols(2)})
    return replayed(recordings, folder / "two_days.timemap.mcap")


def test_the_opened_door_is_told_by_the_fastest_level(result):
    text = report(result, building_truth(patrols(2)), patrols(2))
    assert text.startswith("2 patrols, 5 minutes, ")
    (line,) = [line for line in text.splitlines() if line.startswith("  short ")]
    assert line.split()[1:4] == ["1/1", "1", "1.00"]


def test_little_is_unknown_after_two_patrols(result):
    with ResultReader(result.result) as reader:
        assert 0.0 < unknown_share(reader, "long") < 0.05


def test_recordings_of_the_same_scripts_stand_in_the_same_folder(tmp_path):
    assert recordings_folder(tmp_path) == recordings_folder(tmp_path)
    assert recordings_folder(tmp_path).parent == tmp_path


def test_scenes_are_chosen_by_name(tmp_path):
    ran = CliRunner().invoke(
        main, ["--scene", "real", "--folder", str(tmp_path)], env={"TIMEMAP_RECORDINGS": None}
    )
    assert ran.exit_code == 0
    assert ran.output.split("\n\n")[0] == "== real"
    assert "not measured" in ran.output
    assert set(SCENES) == {"building", "lanes", "far_lanes", "hall", "pallets", "real"}
    assert CliRunner().invoke(main, ["--scene", "none"]).exit_code == 2
