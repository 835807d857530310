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


BLOCKS = BLOCK.findall(README)


def run(folder, block):
    program, *arguments = shlex.split(block.split("\n", 1)[0].removeprefix("$ "))
    assert program == "timemap"
    return subprocess.run(
        [sys.executable, "-m", "timemap_cli", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def tour(tmp_path_factory):
    """All commands one after another, as in the README, in a folder with the sample recordings in it."""
    folder = tmp_path_factory.mktemp("tour")
    (folder / "sample_logs").symlink_to(ROOT / "sample_logs")
    return [run(folder, block) for block in BLOCKS]


@pytest.mark.parametrize("place", range(len(BLOCKS)), ids=lambda place: BLOCKS[place].split("\n")[0][2:40])
def test_a_command_of_the_tour_prints_what_the_readme_says(tour, place):
    done, expected = tour[place], BLOCKS[place].split("\n", 1)[1]
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
