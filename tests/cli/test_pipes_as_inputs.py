"""A pipe given as any input is refused at once: to open one is to wait until somebody writes into it."""

import os
import signal
import socket
from pathlib import Path

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import written
from tests.conftest import ROOT

MONDAY = str(ROOT / "sample_logs" / "patrol_monday.mcap")
SUITE = "checks: [{name: one, logs: [pipe], baseline: base.yaml}]"
INPUTS = {
    "info": ("info", "pipe"),
    "replay": ("replay", "pipe"),
    "replay --config": ("replay", MONDAY, "--config", "pipe"),
    "replay --nodes": ("replay", MONDAY, "--nodes", "pipe"),
    "replay --resume": ("replay", MONDAY, "--resume", "pipe"),
    "info --config": ("info", MONDAY, "--config", "pipe"),
    "config": ("config", "--config", "pipe"),
    "changes": ("changes", "pipe"),
    "diff": ("diff", "pipe", "--level", "long", "mid"),
    "diff OTHER": ("diff", "room.mcap", "pipe", "--level", "long"),
    "report": ("report", "pipe"),
    "plot": ("plot", "pipe"),
    "check": ("check", "pipe", "--baseline", "base.yaml"),
    "check --baseline": ("check", "room.mcap", "--baseline", "pipe"),
    "check --update-baseline": ("check", "room.mcap", "--baseline", "pipe", "--update-baseline"),
    "check --config": ("check", MONDAY, "--baseline", "base.yaml", "--config", "pipe"),
    "check --suite": ("check", "--suite", "pipe"),
}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The current folder, with a pipe, a result and a baseline in it."""
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    written(Path("room.mcap"))
    assert timemap("check", "room.mcap", "--baseline", "base.yaml", "--update-baseline").code == 0


@pytest.fixture(autouse=True)
def patience():
    """A wait for somebody to write ends after a while."""

    def give_up(*_):
        raise TimeoutError("it waits")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(60)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("name", INPUTS)
def test_a_pipe_is_refused(name):
    ran = timemap(*INPUTS[name])
    assert ran.code == 2
    assert ran.err == (
        "error: pipe is a pipe, not a file\n  try: write what comes from it into a file first\n"
    )


def test_a_pipe_in_a_suite_is_the_trouble_of_one_check():
    Path("suite.yaml").write_text(SUITE)
    ran = timemap("check", "--suite", "suite.yaml")
    assert ran.code == 2
    assert "pipe is a pipe, not a file" in ran.out


def test_a_folder_whose_metadata_is_a_pipe_is_refused():
    Path("bag").mkdir()
    os.mkfifo("bag/metadata.yaml")
    ran = timemap("info", "bag")
    assert (ran.code, ran.err.splitlines()[0]) == (
        2,
        "error: bag/metadata.yaml is a pipe, not a file",
    )


def test_a_summary_of_a_job_that_is_a_pipe_changes_no_verdict():
    call = ("check", "room.mcap", "--baseline", "base.yaml", "--format", "github")
    ran = timemap(*call, variables={"GITHUB_STEP_SUMMARY": "pipe"})
    assert (ran.code, ran.err) == (
        0,
        "warning: cannot write the job's summary: pipe is a pipe, not a file\n",
    )


def test_sockets_and_devices_are_refused_and_the_null_device_is_an_empty_file():
    with socket.socket(socket.AF_UNIX) as one:
        one.bind("socket")
        assert "socket is a socket, not a file" in timemap("info", "socket").err
    assert "/dev/zero is a device, not a file" in timemap("config", "--config", "/dev/zero").err
    assert timemap("config", "--config", "/dev/null").out == timemap("config").out
