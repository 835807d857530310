"""Every command on what earlier versions wrote: it is read, or one error names both versions and what to do."""

import shutil
from pathlib import Path

import pytest

from tests.cli.program import timemap
from tests.conftest import ROOT
from tests.results.rewriting import rewritten
from timemap_cli import __version__
from timemap_cli.config import Settings, load
from timemap_cli.results import channels, documents, state_messages
from timemap_cli.results.reader import ResultReader

HERE = Path(__file__).parent
VERSIONS = sorted(folder.name for folder in HERE.glob("v*"))
RESULTS = sorted(path.relative_to(HERE) for path in HERE.glob("v*/*.mcap"))
THURSDAY = ROOT / "sample_logs/patrol_thursday"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with all the files in it: whatever is written, they stay as they are."""
    shutil.copytree(HERE, tmp_path / "earlier")
    monkeypatch.chdir(tmp_path / "earlier")
    return tmp_path / "earlier"


@pytest.mark.parametrize("result", RESULTS, ids=str)
@pytest.mark.parametrize(
    "command",
    [
        ["info"],
        ["info", "--json"],
        ["changes"],
        ["changes", "--json"],
        ["changes", "--csv"],
        ["changes", "--geojson"],
        ["diff", "--level", "long", "mid", "--json"],
        ["diff", "--level", "mid", "--between", "+0s", "end"],
        ["report", "-o", "page.html"],
        ["plot", "--level", "long", "-o", "picture.png"],
        ["check", "--baseline", "new.yaml", "--update-baseline"],
    ],
    ids=" ".join,
)
def test_every_command_reads_the_results_of_earlier_versions(folder, result, command):
    ran = timemap(command[0], result, *command[1:])
    assert (ran.code, ran.err.count("error")) == (0, 0), ran.err


@pytest.mark.parametrize("result", RESULTS, ids=str)
def test_two_results_one_of_which_is_of_an_earlier_version_are_compared(folder, result):
    nodes = ("--nodes", result, "--config", result.with_name("settings.yaml"))
    assert timemap("replay", THURSDAY, *nodes, "-o", "new.timemap.mcap").code == 0
    ran = timemap("diff", result, "new.timemap.mcap", "--level", "mid", "--json")
    assert (ran.code, ran.err) == (0, "")


@pytest.mark.parametrize("version", VERSIONS)
def test_results_and_recordings_are_checked_against_the_baselines_of_earlier_versions(folder, version):
    baseline = Path(version, "building.yaml")
    ran = timemap("check", Path(version, "building.timemap.mcap"), "--baseline", baseline, "--exact")
    assert (ran.code, ran.err) == (0, ""), ran.out
    logs = [ROOT / "sample_logs" / name for name in ("patrol_monday.mcap", "patrol_tuesday.bag")]
    again = ["check", *logs, "--config", Path(version, "settings.yaml"), "--baseline", baseline]
    assert timemap(*again).code in (0, 4)  # a later version may well see more; it compares
    assert timemap(*again, "--update-baseline").code == 0


@pytest.mark.parametrize("version", VERSIONS)
def test_settings_of_earlier_versions_are_read(version):
    assert isinstance(load(HERE / version / "all_settings.yaml"), Settings)


@pytest.mark.parametrize("version", VERSIONS)
def test_going_on_from_an_earlier_version_gives_its_map_or_one_error_that_names_both(folder, version):
    result = Path(version, "building.timemap.mcap")
    ran = timemap("replay", THURSDAY, "--resume", result, "-o", "on.timemap.mcap")
    with ResultReader(result) as reader:
        if reader.can_be_resumed:
            assert ran.code == 0
            return
        named = f"{result} holds {reader.metadata['state']} of timemap {reader.version}; this is timemap {__version__}"
    assert (ran.code, Path("on.timemap.mcap").exists()) == (2, False)
    assert ran.err.startswith(f"error: {named}")
    assert "  try: " in ran.err


@pytest.mark.skipif(state_messages.FORMAT != "timemap.state/2", reason="the state has another format now")
def test_0_1_0_is_gone_on_from_to_the_bit(folder):
    result = Path("v0_1_0/building.timemap.mcap")
    assert timemap("replay", THURSDAY, "--resume", result, "-o", "on.timemap.mcap").code == 0
    with (
        ResultReader(Path("on.timemap.mcap")) as new,
        ResultReader(Path("v0_1_0/thursday.timemap.mcap")) as old,
    ):
        assert (new.nodes, new.changes["events"]) == (old.nodes, old.changes["events"])
        for level in old.levels:
            ours, theirs = new.estimates(level), old.estimates(level)
            assert {n: e.ranges.tobytes() for n, e in ours.items()} == {
                n: e.ranges.tobytes() for n, e in theirs.items()
            }


LATER = "timemap 9.0 reads it; or "


@pytest.mark.parametrize(
    ("changes", "command", "named"),
    [
        ({"metadata": {"format": "timemap.result/1"}}, ["changes"], (channels.FORMAT, "timemap.result/1")),
        ({"metadata": {"format": "timemap.result/9"}}, ["info"], (channels.FORMAT, "timemap.result/9")),
        (
            {"metadata": {"state": "timemap.state/9"}},
            ["replay", THURSDAY, "-o", "on.timemap.mcap", "--resume"],
            (state_messages.FORMAT, "timemap.state/9"),
        ),
        (
            {"attachments": {channels.CHANGES: b'{"schema": "timemap.changes/9"}'}},
            ["report"],
            (documents.CHANGES_FORMAT, "timemap.changes/9"),
        ),
        (
            {"attachments": {channels.REPORT: b'{"schema": "timemap.report/9"}'}},
            ["check", "--baseline", "v0_1_0/building.yaml"],
            (documents.REPORT_FORMAT, "timemap.report/9"),
        ),
    ],
    ids=["older result", "newer result", "state", "changes", "report"],
)
def test_what_no_version_of_ours_can_read_is_one_error_that_names_both(folder, changes, command, named):
    metadata = changes.pop("metadata", {}) | {"version": "9.0"}
    other = rewritten(folder / RESULTS[0], folder / "other.timemap.mcap", metadata=metadata, **changes)
    ran = timemap(*command, other)
    message, *hints = ran.err.splitlines()
    reads, found = named
    assert ran.code == 2
    assert (
        message
        == f"error: {other} holds {found} of timemap 9.0; this is timemap {__version__}, which reads {reads}"
    )
    assert [hint.startswith(f"  try: {LATER}") for hint in hints] == [True]


def test_a_baseline_of_another_version_is_one_error_that_names_both_and_stays(folder):
    text = (
        Path("v0_1_0/building.yaml").read_text().replace("baseline/1", "baseline/9").replace("0.1.0", "9.0")
    )
    Path("b.yaml").write_text(text)
    for update in ([], ["--update-baseline"]):
        ran = timemap("check", RESULTS[0], "--baseline", "b.yaml", *update)
        assert (ran.code, Path("b.yaml").read_text()) == (2, text)
        told = f"error: b.yaml holds timemap.baseline/9 of timemap 9.0; this is timemap {__version__}, which reads "
        assert ran.err.startswith(told)
        assert ran.err.splitlines()[1].startswith(f"  try: {LATER}")
