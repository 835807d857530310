"""The README's commands do what it says."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"```console\n(.*?)```", re.DOTALL)
README = (ROOT / "README.md").read_text()


def lines_that_stay(output):
    """All but how long it took."""
    return [line.rstrip() for line in output.splitlines() if not re.match(r"  time +[0-9.]+ s", line)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the sample recordings in it, for all commands one after another."""
    folder = tmp_path_factory.mktemp("tour")
    (folder / "sample_logs").symlink_to(ROOT / "sample_logs")
    return folder


@pytest.mark.parametrize("block", BLOCK.findall(README), ids=lambda block: block.split("\n")[0][2:40])
def test_a_command_of_the_tour_prints_what_the_readme_says(folder, block):
    command, expected = block.split("\n", 1)
    program, *arguments = shlex.split(command.removeprefix("$ "))
    assert program == "timemap"
    done = subprocess.run(
        [sys.executable, "-m", "timemap_cli", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert lines_that_stay(done.stdout) == lines_that_stay(expected)


def test_every_setting_stands_in_the_readme():
    done = subprocess.run(
        [sys.executable, "-m", "timemap_cli", "config"], capture_output=True, text=True, check=True
    )
    for name in re.findall(r"^ *(\w+):", done.stdout, re.MULTILINE):
        assert f"`{name}" in README or f".{name}`" in README or f"`{name}`" in README, name


def test_every_file_that_the_readme_links_to_is_there():
    for target in re.findall(r"\]\(([^)]+)\)", README):
        assert target.startswith("http") or (ROOT / target).exists(), target
