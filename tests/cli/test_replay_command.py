import json
import sys
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import pytest

import timemap_cli
from tests.cli.program import timemap
from timemap_cli.cli.replay import default_output
from timemap_cli.config import load
from timemap_cli.errors import UsageError


@dataclass
class Replays:
    """Stands in for the replay: remembers how it was called and returns what it was told."""

    calls: list[SimpleNamespace] = field(default_factory=list)
    summary: dict[str, object] = field(default_factory=dict)
    failure: BaseException | None = None

    def replay(self, logs, output, settings, *, force, nodes, start, end, resume, progress):
        self.calls.append(SimpleNamespace(**{k: v for k, v in locals().items() if k != "self"}))
        progress(0.5, 100)
        if self.failure:
            raise self.failure
        return SimpleNamespace(
            **{
                "result": output,
                "nodes": 12,
                "levels": ("short", "long"),
                "scans_read": 100,
                "scans_used": 97,
                "dropped": {"late": 2, "no_pose": 1, "malformed": 0},
                "seconds": 1.25,
                "warnings": (),
                "data_lost": False,
            }
            | self.summary
        )

    @property
    def call(self):
        (call,) = self.calls
        return call


@pytest.fixture
def replays(monkeypatch):
    stand_in = Replays()
    monkeypatch.setitem(sys.modules, "timemap_cli.replay", stand_in)
    monkeypatch.setattr(timemap_cli, "replay", stand_in, raising=False)
    return stand_in


def test_without_options_everything_is_left_to_the_defaults(replays):
    ran = timemap("replay", "logs/monday.mcap", "tuesday.bag")
    assert ran.code == 0
    call = replays.call
    assert tuple(call.logs) == (Path("logs/monday.mcap"), Path("tuesday.bag"))
    assert call.output == Path("monday.timemap.mcap")
    assert call.settings == load(None)
    assert (call.force, call.nodes, call.start, call.end) == (False, None, None, None)


def test_every_option_reaches_its_place(replays, tmp_path):
    config = tmp_path / "settings.yaml"
    config.write_text("map: {radius: 7}\nseed: 3\ninput: {map_frame: odom}\n")
    ran = timemap(
        *("replay", "a.mcap", "-o", "out.mcap", "--force", "--config", config),
        *("--scan-topic", "/front", "--scan-topic", "/rear", "--map-frame", "world", "--poses", "/amcl_pose"),
        *("--max-dropped", "0.25"),
        *("--no-return", "ignore", "--start", "+10s", "--end", "end-5s", "--nodes", "n.mcap", "--seed", "5"),
    )
    assert ran.code == 0, ran.err
    call = replays.call
    assert (call.output, call.force, call.nodes) == (Path("out.mcap"), True, Path("n.mcap"))
    assert (call.start, call.end) == ("+10s", "end-5s")
    assert call.settings.map.radius == 7.0
    assert call.settings.seed == 5
    assert call.settings.input.scan_topics == ("/front", "/rear")
    assert call.settings.input.map_frame == "world"
    assert call.settings.input.max_dropped == 0.25
    assert (call.settings.input.poses, call.settings.input.no_return) == ("/amcl_pose", "ignore")


def test_the_paper_profile_can_be_asked_for(replays):
    timemap("replay", "a.mcap", "--profile", "paper")
    assert replays.call.settings == load(None, {"profile": "paper"})


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        ("monday.mcap", "monday.timemap.mcap"),
        ("logs/monday.bag", "monday.timemap.mcap"),
        ("monday.db3", "monday.timemap.mcap"),
        ("monday.mcap.zstd", "monday.timemap.mcap"),
        ("monday", "monday.timemap.mcap"),
        ("monday/", "monday.timemap.mcap"),
        ("2024.05.01_run", "2024.05.01_run.timemap.mcap"),
        ("bag", "bag.timemap.mcap"),
    ],
)
def test_the_result_is_named_after_the_first_log_and_stands_in_the_current_folder(log, expected):
    assert default_output(Path(log)) == Path(expected)


def test_the_result_of_a_folder_named_by_dots_has_the_folders_name(tmp_path, monkeypatch):
    inner = tmp_path / "run7" / "inner"
    inner.mkdir(parents=True)
    monkeypatch.chdir(inner)
    assert default_output(Path()) == Path("inner.timemap.mcap")
    assert default_output(Path("..")) == Path("run7.timemap.mcap")


def test_a_result_never_takes_the_place_of_a_recording(replays, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("bag").mkdir()
    for log, output in (("a.mcap", "a.mcap"), ("a.mcap", "./bag/../a.mcap"), ("bag", "bag/out.mcap")):
        ran = timemap("replay", log, "-o", output, "--force")
        assert ran.code == 2
        assert f"would stand where the recording {log} is" in ran.err
    assert replays.calls == []


@pytest.mark.parametrize(("option", "what"), [("--config", "settings file"), ("--nodes", "nodes")])
def test_a_result_never_takes_the_place_of_another_input(replays, tmp_path, monkeypatch, option, what):
    monkeypatch.chdir(tmp_path)
    mine = Path("mine")
    mine.write_text("seed: 1\n")
    Path("link").symlink_to(mine)
    for output in (mine, tmp_path / mine, "link"):
        ran = timemap("replay", "a.mcap", option, mine, "-o", output, "--force")
        assert (ran.code, ran.out) == (2, "")
        assert f"would stand where the {what} mine " in ran.err
    assert replays.calls == []
    assert mine.read_text() == "seed: 1\n"


def test_a_result_does_not_go_to_standard_output(replays):
    ran = timemap("replay", "a.mcap", "-o", "-")
    assert (ran.code, replays.calls) == (2, [])
    assert ran.err == ("error: a result is a file: it does not go to standard output\n  try: -o OUT.mcap\n")


def test_the_summary_says_what_became_of_every_scan(replays):
    ran = timemap("replay", "a.mcap")
    assert ran.out.splitlines() == [
        "a.timemap.mcap",
        "  nodes   12",
        "  levels  short, long",
        "  scans   100 read, 97 used, 3 dropped (late 2, no_pose 1)",
        "  time    1.2 s",
    ]
    assert ran.err == ""


def test_json_has_the_promised_fields(replays):
    ran = timemap("replay", "a.mcap", "--json")
    assert json.loads(ran.out) == {
        "schema": "timemap.replay/1",
        "result": "a.timemap.mcap",
        "nodes": 12,
        "levels": ["short", "long"],
        "scans": {"read": 100, "used": 97, "dropped": {"late": 2, "no_pose": 1}},
        "seconds": 1.25,
        "warnings": [],
    }


def test_quiet_prints_nothing_but_json_that_was_asked_for(replays):
    assert timemap("replay", "a.mcap", "-q").out == ""
    assert timemap("replay", "a.mcap", "--quiet", "--json").out.startswith("{")


def test_warnings_go_to_stderr(replays):
    replays.summary = {"warnings": ("poses are odometry, which drifts", "more")}
    ran = timemap("replay", "a.mcap", "--json")
    assert ran.err == "warning: poses are odometry, which drifts\nwarning: more\n"
    assert json.loads(ran.out)["warnings"] == ["poses are odometry, which drifts", "more"]


def test_lost_data_is_exit_code_3_and_still_a_summary(replays):
    replays.summary = {"data_lost": True}
    ran = timemap("replay", "a.mcap")
    assert ran.code == 3
    assert "scans   100 read" in ran.out


def test_what_the_replay_refuses_is_one_error(replays):
    replays.failure = UsageError("no pose for /scan", hint="timemap replay a.mcap --map-frame world")
    ran = timemap("replay", "a.mcap")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == "error: no pose for /scan\n  try: timemap replay a.mcap --map-frame world\n"


def test_wrong_settings_are_found_before_anything_is_read(replays, tmp_path):
    config = tmp_path / "settings.yaml"
    config.write_text("map: {radius: 99}\n")
    for args in (("--config", config), ("--seed", "-1"), ("--map-frame", ""), ("--no-return", "free")):
        assert timemap("replay", "a.mcap", *args).code == 2
    assert replays.calls == []


def test_a_progress_bar_shows_on_a_terminal_only(replays):
    assert "0 scans" in timemap("replay", "a.mcap", screen=True).err
    assert timemap("replay", "a.mcap").err == ""
    assert timemap("replay", "a.mcap", "-q", screen=True).err == ""


def test_the_progress_bar_is_gone_after_a_failure(replays):
    replays.failure = UsageError("no")
    ran = timemap("replay", "a.mcap", screen=True)
    assert ran.err.splitlines()[-1].endswith("error:\x1b[0m no")
