"""The whole benchmark on its first two days: the door opens, nothing else changes."""

import pytest

from benchmarks.changes.__main__ import recordings_folder, replay, report, unknown_share
from benchmarks.changes.patrols import make, patrols
from benchmarks.changes.truth import building_truth
from timemap_cli.results.reader import ResultReader


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    folder = tmp_path_factory.mktemp("building")
    path = folder / "two_days.timemap.mcap"
    replay(make(folder, patrols(2)), path)
    return path


def test_the_opened_door_is_told_by_the_fastest_level(result):
    text = report(result, building_truth(2))
    assert text.startswith("2 patrols, 5 minutes, ")
    (line,) = [line for line in text.splitlines() if line.startswith("  short ")]
    assert line.split()[1:4] == ["1/1", "1", "1.00"]


def test_little_is_unknown_after_two_patrols(result):
    with ResultReader(result) as reader:
        assert 0.0 < unknown_share(reader, "long") < 0.05


def test_recordings_of_the_same_scripts_stand_in_the_same_folder(tmp_path):
    assert recordings_folder(tmp_path) == recordings_folder(tmp_path)
    assert recordings_folder(tmp_path).parent == tmp_path
