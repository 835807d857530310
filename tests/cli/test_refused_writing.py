"""What the system may refuse a command that writes: one error, no traceback, and nothing lost or left behind."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import all_levels, write
from tests.conftest import ROOT

MONDAY = ROOT / "sample_logs" / "patrol_monday.mcap"
THURSDAY = ROOT / "sample_logs" / "patrol_thursday"
WRITERS = {
    "replay": (str(MONDAY), "out.mcap"),
    "report": ("room.mcap", "out.html"),
    "plot": ("room.mcap", "out.png"),
}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The current folder, with a result in it."""
    monkeypatch.chdir(tmp_path)
    write(Path("room.mcap"), [(0, all_levels(False)), (10, all_levels(True))])
    return tmp_path


def run(*args, limit=None, **more):
    def limited():
        if limit is not None:
            resource.setrlimit(limit[0], (limit[1], limit[1]))

    # Python does not notice when its own compiled files are cut by a limit, and would load them ever after.
    return subprocess.run(
        [sys.executable, "-B", "-m", "timemap_cli", *map(str, args)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        preexec_fn=limited,
        **more,
    )


def names():
    return sorted(path.name for path in Path().iterdir())


@pytest.mark.parametrize("command", WRITERS)
def test_a_disk_that_is_full_is_one_error_and_the_earlier_output_stays(command):
    given, output = WRITERS[command]
    head = {"out.html": b"<!doctype html>", "out.png": b"\x89PNG\r\n\x1a\n"}.get(output)
    Path(output).write_bytes(head + b"old") if head else shutil.copy("room.mcap", output)
    before, there = Path(output).read_bytes(), names()
    ran = run(command, given, "-o", output, "--force", limit=(resource.RLIMIT_FSIZE, 5000))
    assert (ran.returncode, ran.stderr) == (1, f"error: cannot write {output}: file too large\n")
    assert (Path(output).read_bytes(), names()) == (before, there)


@pytest.mark.skipif(os.getuid() == 0, reason="root may write everywhere")
@pytest.mark.parametrize("command", WRITERS)
def test_a_folder_that_may_not_be_written_to_is_one_error(command, folder):
    given, output = WRITERS[command]
    shut = folder / "shut"
    shut.mkdir(mode=0o500)
    told = timemap(command, given, "-o", shut / output)
    assert told.code == 1
    assert told.err == f"error: cannot write {shut / output}: permission denied\n"


@pytest.mark.parametrize("command", WRITERS)
def test_a_write_protected_output_is_not_replaced_with_force_either(command):
    given, output = WRITERS[command]
    if command == "replay":
        shutil.copy("room.mcap", output)
    else:
        assert timemap(command, given, "-o", output).code == 0
    Path(output).chmod(0o444)
    before, there = Path(output).read_bytes(), names()
    told = timemap(command, given, "-o", output, "--force")
    assert (told.code, told.err) == (
        2,
        f"error: {output} is write-protected: it is not replaced\n  try: chmod u+w {output}\n",
    )
    assert (Path(output).read_bytes(), names()) == (before, there)


@pytest.mark.parametrize("command", ["report", "plot"])
def test_an_interrupt_while_a_page_or_picture_is_made_leaves_nothing(command, monkeypatch):
    module, made = {"report": ("page", "page"), "plot": ("pictures", "level_picture")}[command]

    def interrupted(*_, **__):
        assert any(name.endswith(".part") for name in names())
        raise KeyboardInterrupt

    monkeypatch.setattr(f"timemap_cli.reports.{module}.{made}", interrupted)
    there = names()
    told = timemap(command, *WRITERS[command][:1], "-o", WRITERS[command][1])
    assert (told.code, told.err.strip()) == (130, "interrupted")
    assert names() == there


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_second_process_that_is_ended_ends_the_replay_with_one_error(number):
    there = names()
    with subprocess.Popen(
        [sys.executable, "-m", "timemap_cli", "replay", MONDAY, THURSDAY, "-o", "out.mcap"],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    ) as replay:
        children = Path(f"/proc/{replay.pid}/task/{replay.pid}/children")
        while replay.poll() is None and not children.read_text():
            time.sleep(0.005)
        if replay.poll() is not None:
            pytest.skip("with one processor there is no second process")
        os.kill(int(children.read_text()), number)
        _, said = replay.communicate(timeout=60)
    assert replay.returncode == 1
    assert said.startswith("error: the process that remembers was ended from outside\n")
    assert "Traceback" not in said
    assert names() == there


def test_too_little_memory_is_one_error(monkeypatch):
    def exhausted(*_, **__):
        raise MemoryError

    monkeypatch.setattr("timemap_cli.reports.pictures.occupancy_grid", exhausted)
    there = names()
    told = timemap("plot", "room.mcap", "-o", "out.png")
    assert (told.code, told.err) == (1, "error: there is not enough memory\n")
    assert names() == there


@pytest.mark.parametrize("args", [["config"], ["--help"], ["--version"], ["changes", "room.mcap"]])
def test_a_full_disk_behind_standard_output_is_one_error(args, monkeypatch):
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)  # nothing would be left to write at the end
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "timemap_cli", *args]
        ran = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    assert ran.returncode == 1
    assert ran.stderr.count("\n") == 1
    assert "no space left on device" in ran.stderr


@pytest.mark.parametrize(
    "args", [["config"], ["changes", "nowhere.mcap"], ["plot", "room.mcap", "-o", "a.png"]]
)
def test_a_full_disk_behind_standard_error_changes_no_exit_code(args):
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "timemap_cli", *args]
        ran = subprocess.run(command, stderr=full, stdout=subprocess.PIPE, timeout=60, check=False)
    assert ran.returncode == (2 if "nowhere.mcap" in args else 0)


def test_nothing_that_is_read_is_touched(folder):
    logs = folder / "logs"
    shutil.copytree(ROOT / "sample_logs", logs, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    given = [logs / name for name in ("patrol_monday.mcap", "patrol_tuesday.bag", "patrol_thursday")]
    before = {
        path: (path.stat().st_mtime_ns, path.read_bytes()) for path in logs.rglob("*") if path.is_file()
    }
    for path in logs.rglob("*"):
        path.chmod(0o555 if path.is_dir() else 0o444)
    assert timemap("info", *given).code == 0
    assert timemap("replay", *given, "--start", "end-60s", "-o", "out.mcap").code == 0
    result = Path("out.mcap")
    there = result.stat().st_mtime_ns, result.read_bytes()
    for args in (
        ["changes"],
        ["diff", "--level", "long", "mid"],
        ["report", "-o", "p.html"],
        ["plot", "-o", "p.png"],
    ):
        assert timemap(args[0], result, *args[1:]).code == 0
    assert (result.stat().st_mtime_ns, result.read_bytes()) == there
    after = {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in logs.rglob("*") if path.is_file()}
    assert after == before
