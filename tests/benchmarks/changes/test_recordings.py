"""Recordings that are made once, and results that are kept."""

import os

import pytest
from rosbags.highlevel import AnyReader

from benchmarks.changes.recordings import Replayed, folder_of, known_as, make, replayed
from benchmarks.changes.worlds import lanes, open_hall
from benchmarks.changes.worlds.open_hall import LAYOUTS, hall


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hall")
    (first, _) = hall(LAYOUTS[0]).drives().items()
    return make(folder, dict([first]))


def test_a_recording_is_made_once(made):
    (path,) = made
    drives = {"run_1": hall(LAYOUTS[0]).drives()["run_1"]}
    with AnyReader([path]) as reader:
        counts = {c.topic: c.msgcount for c in reader.connections}
    assert counts["/scan"] == pytest.approx(8 * (drives["run_1"].motion.duration - 0.6), abs=2)
    written = (path / "metadata.yaml").stat().st_mtime_ns
    assert make(path.parent, drives) == [path]
    assert (path / "metadata.yaml").stat().st_mtime_ns == written


def test_a_result_is_kept_until_it_is_wanted_again(made, tmp_path, capsys):
    result = tmp_path / "one.timemap.mcap"
    first = replayed(made, result)
    assert first.read > 300
    os.utime(result, (0, 0))
    assert replayed(made, result) == first
    assert "kept" in capsys.readouterr().err
    assert result.stat().st_mtime == 0
    assert replayed(made, result, again=True) == first
    assert result.stat().st_mtime > 0


def test_a_replay_that_fails_says_why(tmp_path):
    with pytest.raises(RuntimeError, match=r"timemap replay ended with 2: .*none\.mcap"):
        replayed([tmp_path / "none.mcap"], tmp_path / "one.timemap.mcap")


def test_dropped_scans_are_told_as_shares(tmp_path):
    assert Replayed(tmp_path, 200, {"lost": 3, "no_pose": 0}).lost == "200 scans, dropped: lost 1.50%"
    assert Replayed(tmp_path, 200, {}).lost == "200 scans, dropped: none"


def test_the_same_scripts_make_recordings_in_the_same_folder(tmp_path):
    assert folder_of(tmp_path, "hall", [open_hall]) == folder_of(tmp_path, "hall", [open_hall])
    assert folder_of(tmp_path, "hall", [open_hall]) != folder_of(tmp_path, "hall", [open_hall, lanes])


def test_recordings_of_others_are_known_by_bytes_and_options(tmp_path):
    log = tmp_path / "log.mcap"
    log.write_bytes(b"one")
    name = known_as([log])
    assert name == known_as([log])
    assert name != known_as([log], "--map-frame", "odom")
    log.write_bytes(b"two")
    assert name != known_as([log])
