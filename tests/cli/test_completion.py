"""Completion by the shells themselves, as far as they are installed, and what they ask the program."""

import os
import pty
import re
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.program import python, timemap

SHELLS = ("bash", "zsh", "fish")
PATIENCE_S = 60
_ESCAPES = re.compile(r"\x1b(\[[0-?]*[ -/]*[@-~]|[()][A-Z0-9]|[=>])|[\x07\x08\r]")


@pytest.fixture
def home(tmp_path, monkeypatch):
    """A folder with two files in it that are a home and the current folder, and a program `timemap` on the path."""
    programs = tmp_path / "bin"
    programs.mkdir()
    program = programs / "timemap"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m timemap_cli "$@"\n')
    program.chmod(0o755)
    folder = tmp_path / "home"
    folder.mkdir()
    (folder / "monday.mcap").touch()
    (folder / "tuesday.mcap").touch()
    monkeypatch.chdir(folder)
    for name in ("COMP_WORDS", "COMP_CWORD", "ZDOTDIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setenv("TERM", "dumb")
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2]))
    return folder


def needs(shell):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")


class Screen:
    """A shell that believes in a person at its keyboard."""

    def __init__(self, *words):
        self.pid, self.keyboard = pty.fork()
        if self.pid == 0:
            os.execvp(words[0], words)
        self.seen = ""

    def type(self, keys):
        os.write(self.keyboard, keys.encode())

    def until(self, words):
        """Wait until these words have come since the last time; all that came, without what steers a terminal."""
        end = time.monotonic() + PATIENCE_S
        while words not in self.seen:
            assert time.monotonic() < end, f"{words!r} did not come, but {self.seen!r}"
            if select.select([self.keyboard], [], [], 0.2)[0]:
                self.seen += _ESCAPES.sub("", os.read(self.keyboard, 65536).decode(errors="replace"))
        seen, self.seen = self.seen, ""
        return seen

    def close(self):
        os.close(self.keyboard)
        os.kill(self.pid, 9)
        os.waitpid(self.pid, 0)


STARTS = {
    "bash": (("bash", "--norc", "--noprofile", "-i"), 'eval "$(_TIMEMAP_COMPLETE=bash_source timemap)"'),
    "zsh": (
        ("zsh", "-f", "-i"),
        'autoload -Uz compinit && compinit -D -u; eval "$(_TIMEMAP_COMPLETE=zsh_source timemap)"',
    ),
}


@pytest.mark.parametrize("shell", STARTS)
def test_a_tab_completes_commands_options_choices_and_files(home, shell):
    needs(shell)
    words, lines = STARTS[shell]
    screen = Screen(*words)
    try:
        screen.type(f"PS1='> '; {lines}; echo rea''dy\n")
        screen.until("ready")
        for typed, completed in [
            ("timemap repl", "timemap replay "),
            ("timemap diff --exit", "timemap diff --exit-code "),
            ("timemap changes --kind van", "timemap changes --kind vanished "),
            ("timemap diff --level long mid --at", "timemap diff --level long mid --at "),
            ("timemap info mon", "timemap info monday.mcap "),
            ("timemap replay --resume tue", "timemap replay --resume tuesday.mcap "),
        ]:
            screen.type(f"{typed}\t")
            screen.until(completed)
            screen.type("\x15")  # forget the line
    finally:
        screen.close()


def test_fish_completes_commands_options_choices_and_files(home):
    needs("fish")
    asked = {
        "timemap repl": "replay",
        "timemap diff --exit": "--exit-code",
        "timemap changes --kind van": "vanished",
        "timemap info mon": "monday.mcap",
    }
    questions = "; ".join(f"complete -C '{typed}'" for typed in asked)
    ran = subprocess.run(
        ["fish", "--no-config", "-c", f"_TIMEMAP_COMPLETE=fish_source timemap | source; {questions}"],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=True,
    )
    assert [line.partition("\t")[0] for line in ran.stdout.splitlines()] == list(asked.values())


@pytest.mark.parametrize("shell", SHELLS)
def test_the_lines_for_a_shell_are_printed(shell):
    told = timemap(variables={"_TIMEMAP_COMPLETE": f"{shell}_source"})
    assert (told.code, told.err) == (0, "")
    assert f"_TIMEMAP_COMPLETE={shell}_complete" in told.out


def test_another_shell_is_one_error():
    told = timemap(variables={"_TIMEMAP_COMPLETE": "tcsh_source"})
    assert (told.code, told.err.splitlines()[0]) == (
        2,
        "error: _TIMEMAP_COMPLETE is tcsh_source: there is completion for bash, zsh and fish",
    )


def test_a_question_without_words_is_one_error(monkeypatch):
    monkeypatch.delenv("COMP_WORDS", raising=False)
    told = timemap(variables={"_TIMEMAP_COMPLETE": "bash_complete"})
    assert (told.code, told.err.splitlines()[0]) == (
        2,
        "error: what the shell wants completed is not in COMP_WORDS and COMP_CWORD",
    )


@pytest.mark.parametrize(
    ("words", "place", "answer"),
    [
        ("timemap re", 1, ["plain,replay", "plain,report"]),
        ("timemap diff --between a ", 4, []),  # a value that is missing yet is no error
        ("timemap plot --level '' --no", 4, ["plain,--node"]),
        ("timemap info 'mon", 2, ["file,mon"]),
        ("timemap nothing --x", 2, []),
    ],
)
def test_what_is_not_whole_yet_is_no_error(monkeypatch, words, place, answer):
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(place))
    told = timemap(variables={"_TIMEMAP_COMPLETE": "bash_complete"})
    assert (told.code, told.out.split(), told.err) == (0, answer, "")


def test_completion_imports_nothing_that_takes_time(monkeypatch):
    monkeypatch.setenv("COMP_WORDS", "timemap replay --")
    monkeypatch.setenv("COMP_CWORD", "2")
    ran = python(
        "import sys; from timemap_cli.cli.main import main; from timemap_cli.cli.terminal import Terminal; "
        "main([], Terminal(variables={'_TIMEMAP_COMPLETE': 'bash_complete'})); sys.exit('numpy' in sys.modules)"
    )
    assert (ran.returncode, ran.stderr) == (0, "")
