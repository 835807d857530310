"""The program as the shell starts it: its streams, and signals at any moment."""

import os
import signal
import subprocess
import sys

import pytest

from tests.cli.program import python


def test_a_closed_pipe_ends_quietly():
    code = "from timemap_cli.cli.entry import run; import sys; sys.argv = ['timemap', 'config']; run()"
    read_end, write_end = os.pipe()
    os.close(read_end)
    ran = subprocess.run(
        [sys.executable, "-c", code], stdout=write_end, stderr=subprocess.PIPE, timeout=60, check=False
    )
    os.close(write_end)
    assert (ran.returncode, ran.stderr) == (0, b"")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_with_130_and_no_traceback(number):
    code = (
        "import os, sys, click\n"
        "from timemap_cli.cli import main\n"
        "@click.command()\n"
        f"def wait(): os.kill(os.getpid(), {int(number)}); import time; time.sleep(30)\n"
        "main.timemap.add_command(wait)\n"
        "from timemap_cli.cli.entry import run\n"
        "sys.argv = ['timemap', 'wait']\n"
        "run()\n"
    )
    ran = python(code)
    assert ran.returncode == 130
    assert "Traceback" not in ran.stderr
    assert ran.stderr.strip() == "interrupted"


def test_names_that_the_terminal_cannot_show_do_not_stop_the_program(tmp_path):
    settings = tmp_path / "settings.yaml"
    settings.write_text('input: {map_frame: "\N{GREEK SMALL LETTER MU}"}\n', encoding="utf-8")
    code = (
        "import sys\nfrom timemap_cli.cli.entry import run\n"
        f"sys.argv = ['timemap', 'config', '--config', {str(settings)!r}]\nrun()"
    )
    ran = python(code, env={"PYTHONIOENCODING": "ascii", "PATH": os.environ["PATH"]})
    assert ran.returncode == 0
    assert "\\u03bc" in ran.stdout


@pytest.mark.parametrize("args", [["config"], ["--help"], ["info", "absent.bag"]])
@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_closed_streams_change_no_exit_code_and_raise_nothing(args, closed, tmp_path):
    command = f'"$0" -m timemap_cli "$@" {closed}'
    ran = subprocess.run(
        ["sh", "-c", command, sys.executable, *args],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=60,
        check=False,
    )
    assert ran.returncode == (2 if args[0] == "info" else 0)
    assert "Traceback" not in ran.stderr
    assert bool(ran.stdout) == (args[0] != "info" and ">&-" not in closed.split())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("module", ["click", "timemap_cli.cli.main"])
def test_a_signal_while_the_program_is_being_imported_ends_with_130(number, module):
    code = (
        "import os, sys\n"
        "class Signaller:\n"
        "    def find_spec(self, name, *more):\n"
        f"        if name == {module!r}: os.kill(os.getpid(), {int(number)})\n"
        "sys.meta_path.insert(0, Signaller())\n"
        "from timemap_cli.cli.entry import run\n"
        "sys.argv = ['timemap', 'config']\n"
        "run()\n"
    )
    ran = python(code)
    assert (ran.returncode, ran.stdout, ran.stderr) == (130, "", "interrupted\n")


def test_an_interrupt_that_python_loses_stops_the_work_at_its_next_step():
    code = (
        "import os, signal, sys, click\n"
        "from timemap_cli.cli import main, progress\n"
        "class Loses:\n"
        "    def __del__(self): os.kill(os.getpid(), signal.SIGINT)\n"
        "@click.command()\n"
        "@click.pass_obj\n"
        "def work(terminal):\n"
        "    with progress.ProgressBar(terminal) as bar:\n"
        "        bar(0.1, 1)\n"
        "        Loses()\n"
        "        print('goes on', flush=True)\n"
        "        bar(0.2, 2)\n"
        "        print('ends')\n"
        "main.timemap.add_command(work)\n"
        "from timemap_cli.cli.entry import run\n"
        "sys.argv = ['timemap', 'work']\n"
        "run()\n"
    )
    ran = python(code)
    assert (ran.returncode, ran.stdout) == (130, "goes on\n")
    assert ran.stderr.endswith("interrupted\n")


def test_a_signal_within_an_exec_of_text_ends_with_130_too(tmp_path):
    """Python run with -m would end itself by SIGINT."""
    (tmp_path / "sitecustomize.py").write_text(
        "import dataclasses, os, signal\n"
        "whole = dataclasses.dataclass\n"
        "def interrupted(*args, **kwargs):\n"
        "    if signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:\n"
        "        exec('os.kill(os.getpid(), signal.SIGTERM)')\n"
        "    return whole(*args, **kwargs)\n"
        "dataclasses.dataclass = interrupted\n"
    )
    ran = subprocess.run(
        [sys.executable, "-m", "timemap_cli", "config"],
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (130, "", "interrupted\n")


def test_what_was_said_to_be_ignored_stays_ignored():
    code = (
        "import os, signal, sys, click\n"
        "from timemap_cli.cli import main\n"
        "@click.command()\n"
        "def hang_up(): os.kill(os.getpid(), signal.SIGHUP); print('goes on')\n"
        "main.timemap.add_command(hang_up)\n"
        "from timemap_cli.cli.entry import run\n"
        "sys.argv = ['timemap', 'hang-up']\n"
        "signal.signal(signal.SIGHUP, signal.SIG_IGN)  # nohup\n"
        "run()\n"
    )
    ran = python(code)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "goes on\n", "")


def test_signals_that_come_twice_do_not_disturb_the_clearing_up(tmp_path):
    code = (
        "import os, signal, sys, click\n"
        "from pathlib import Path\n"
        "from timemap_cli.cli import main\n"
        "from timemap_cli.results.atomic_file import AtomicFile\n"
        "class Slow(AtomicFile):\n"
        "    def discard(self): os.kill(os.getpid(), signal.SIGTERM); super().discard(); print('cleared')\n"
        "@click.command()\n"
        "def write():\n"
        f"    with Slow(Path({str(tmp_path / 'out.bin')!r})): os.kill(os.getpid(), signal.SIGTERM)\n"
        "main.timemap.add_command(write)\n"
        "from timemap_cli.cli.entry import run\n"
        "sys.argv = ['timemap', 'write']\n"
        "run()\n"
    )
    ran = python(code)
    assert (ran.returncode, ran.stdout, ran.stderr.strip()) == (130, "cleared\n", "interrupted")
    assert list(tmp_path.iterdir()) == []
