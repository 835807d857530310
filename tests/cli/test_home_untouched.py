"""Nothing is written but what was asked for, and nobody but timemap speaks on stderr."""

import os
import subprocess
import sys

import pytest

from tests.cli.result_files import written
from tests.conftest import ROOT

LOG = ROOT / "sample_logs" / "patrol_monday.mcap"

# A machine so slow that matplotlib says at once that it makes its list of fonts.
AT_ONCE = """
import threading

class Timer(threading.Timer):
    def __init__(self, interval, function):
        super().__init__(0, function)

    def start(self):
        super().start()
        self.join()

threading.Timer = Timer
from timemap_cli.cli.entry import run
run()
"""
COMMANDS = {
    "info": ["info", LOG],
    "replay": ["replay", LOG, "--end", "+20s", "-o", "made.mcap"],
    "changes": ["changes", "r.timemap.mcap"],
    "diff": ["diff", "r.timemap.mcap", "--level", "long", "mid"],
    "report": ["report", "r.timemap.mcap", "-o", "made.html"],
    "plot": ["plot", "r.timemap.mcap", "-o", "made.png"],
    "plot --node": ["plot", "r.timemap.mcap", "--node", "0", "-o", "made.png"],
    "check": ["check", "r.timemap.mcap", "--baseline", "made.yaml", "--update-baseline"],
    "config": ["config"],
}


@pytest.fixture
def room(tmp_path):
    """Empty folders of the user, and a working folder with a result."""
    for name in ("home", "cache", "settings", "temporary", "work"):
        (tmp_path / name).mkdir()
    written(tmp_path / "work" / "r.timemap.mcap")
    return tmp_path


def timemap(room, *args, program=("-m", "timemap_cli"), **environment):
    given = {"PATH": os.environ["PATH"], "HOME": str(room / "home"), "TMPDIR": str(room / "temporary")}
    return subprocess.run(
        [sys.executable, *program, *map(str, args)],
        env=given | {"PYTHONPATH": str(ROOT)} | environment,
        cwd=room / "work",
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def left(room):
    """What lies in the user's folders and is no output."""
    there = {path.relative_to(room).as_posix() for path in room.rglob("*") if path.is_file()}
    return {name for name in there if not name.startswith(("work/made.", "work/r."))}


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_writes_into_the_users_folders(room, command):
    ran = timemap(room, *COMMANDS[command])
    assert (ran.returncode, ran.stderr) == (0, "")
    assert not left(room)
    assert not any((room / "home").iterdir())


def test_nor_into_the_folders_that_a_desktop_names(room):
    names = {"XDG_CACHE_HOME": str(room / "cache"), "XDG_CONFIG_HOME": str(room / "settings")}
    ran = timemap(room, *COMMANDS["plot"], **names)
    assert (ran.returncode, ran.stderr) == (0, "")
    assert not left(room)
    assert [path for path in room.glob("*/*") if path.parent.name != "work"] == []


def test_a_first_picture_on_a_slow_machine_comes_without_a_word_of_matplotlib(room):
    ran = timemap(room, *COMMANDS["plot"], program=("-c", AT_ONCE))
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "made.png\n", "")


def test_no_word_is_said_of_a_home_that_cannot_be_written_to(room):
    ran = timemap(room, *COMMANDS["plot"], HOME="/proc/nobody")
    assert (ran.returncode, ran.stderr) == (0, "")


def test_no_word_is_said_of_letters_that_no_font_has(room):
    result = room / "work" / "r.timemap.mcap"
    result.rename(result.with_name("r.仓库.timemap.mcap"))
    ran = timemap(room, "plot", "r.仓库.timemap.mcap", "-o", "made.png", LC_ALL="C.UTF-8")
    assert (ran.returncode, ran.stderr) == (0, "")


def test_settings_of_matplotlib_that_lie_about_change_no_picture(room):
    assert timemap(room, *COMMANDS["plot"]).returncode == 0
    picture = room / "work" / "made.png"
    before = picture.read_bytes()
    (room / "work" / "matplotlibrc").write_text("figure.facecolor: red\nno such key: 1\n")
    ran = timemap(room, *COMMANDS["plot"], "--force")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert picture.read_bytes() == before
