from importlib.metadata import entry_points

import click
import pytest

from tests.cli.program import python, timemap
from timemap_cli import __version__
from timemap_cli.cli import main as main_module
from timemap_cli.errors import ExitCode, TimemapError


@pytest.fixture
def failing(monkeypatch):
    """Add a command `fail` that raises what it is told."""

    def add(error):
        @click.command("fail")
        def fail():
            raise error

        monkeypatch.setitem(main_module.timemap.commands, "fail", fail)

    return add


def test_help_lists_the_commands_on_stdout():
    for flag in ("--help", "-h"):
        ran = timemap(flag)
        assert ran.code == 0
        assert [word for word in ("info", "replay", "diff", "config") if f"\n  {word} " not in ran.out] == []
        assert ran.err == ""


@pytest.mark.parametrize("command", ["info", "replay", "diff", "config"])
def test_every_command_has_a_help_without_holes(command):
    ran = timemap(command, "--help")
    assert ran.code == 0
    options = ran.out.split("Options:")[1].splitlines()
    assert all(len(line.split("  ")) > 1 for line in options if line.startswith("  -"))


def test_the_version_is_that_of_the_package():
    assert timemap("--version").out == f"timemap {__version__}\n"


def test_no_command_is_a_usage_error_that_shows_the_help():
    ran = timemap()
    assert ran.code == 2
    assert ran.out == ""
    assert ran.err.startswith("Usage: timemap ")


def test_a_wrong_option_or_command_is_one_error_with_a_hint():
    ran = timemap("replay", "--colour", "log.mcap")
    assert ran.code == 2
    assert ran.err.startswith("error: no such option '--colour'")
    assert ran.err.endswith("\n  try: timemap replay --help\n")
    ran = timemap("repaly")
    assert ran.code == 2
    assert ran.err.startswith("error: no such command 'repaly'")
    assert "  try: timemap --help\n" in ran.err


def test_a_missing_argument_is_a_usage_error():
    ran = timemap("replay")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == "error: missing argument 'LOG...'\n  try: timemap replay --help\n"


@pytest.mark.parametrize(
    "args",
    [
        ["info", ""],
        ["replay", "a.bag", ""],
        ["replay", "a.bag", "-o", ""],
        ["replay", "a.bag", "--nodes", ""],
        ["diff", "--level", "long", "mid", ""],
        ["changes", ""],
        ["config", "--config", ""],
    ],
)
def test_an_empty_name_is_not_the_current_folder(args):
    ran = timemap(*args)
    assert (ran.code, ran.out) == (2, "")
    where = f" behind {args[-2].replace('-o', '--output')}" if args[-2].startswith("-") else ""
    assert ran.err == f"error: the name of a file{where} is empty\n  try: timemap {args[0]} --help\n"


@pytest.mark.parametrize("code", list(ExitCode))
def test_an_expected_failure_ends_with_its_own_exit_code(failing, code):
    failing(TimemapError("the scanner is upside down", hint="turn it", exit_code=code))
    ran = timemap("fail")
    assert (ran.code, ran.out) == (code, "")
    assert ran.err == "error: the scanner is upside down\n  try: turn it\n"


def test_an_interrupt_ends_with_130(failing):
    failing(KeyboardInterrupt())
    ran = timemap("fail")
    assert (ran.code, ran.err.strip()) == (130, "interrupted")


def test_what_the_system_refuses_is_an_error_without_traceback(failing):
    failing(PermissionError(13, "Permission denied", "/root/out.mcap"))
    ran = timemap("fail")
    assert (ran.code, ran.err) == (1, "error: /root/out.mcap: permission denied\n")


def test_a_bug_is_not_hidden(failing):
    failing(ZeroDivisionError())
    with pytest.raises(ZeroDivisionError):
        timemap("fail")


@pytest.mark.parametrize("args", [["--help"], ["config"], ["replay", "--help"], ["diff", "--level", "long"]])
def test_help_config_and_usage_errors_import_no_heavy_library(args):
    ran = python(
        "import sys\n"
        "from timemap_cli.cli.main import main\n"
        f"main({args!r})\n"
        "heavy = {'numpy', 'rosbags', 'mcap', 'tqdm'} & set(sys.modules)\n"
        "sys.exit(f'imported {heavy}' if heavy else 0)\n"
    )
    assert ran.returncode == 0, ran.stderr


def test_importing_the_command_line_imports_no_numpy():
    ran = python("import sys, timemap_cli.cli, timemap_cli.cli.main; sys.exit('numpy' in sys.modules)")
    assert ran.returncode == 0


def test_the_installed_command_is_this_program():
    (entry,) = entry_points(group="console_scripts", name="timemap")
    assert entry.value == "timemap_cli.cli.entry:run"


def test_a_cut_file_of_the_program_itself_is_no_interrupt(monkeypatch):
    def cut(*_args, **_more):
        raise EOFError("marshal data too short")

    monkeypatch.setattr("timemap_cli.config.dump", cut)
    monkeypatch.setattr("timemap_cli.cli.config.dump", cut, raising=False)
    ran = timemap("config")
    assert ran.code == 1
    assert "a file of the program itself ends too early: marshal data too short" in ran.err
