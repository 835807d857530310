"""What a release holds."""

import shutil
import subprocess
import sys
import tarfile

import pytest

from tests.conftest import ROOT

MADE = shutil.ignore_patterns(
    ".git", ".venv", ".*_cache", ".hypothesis", "build", "dist", "*.egg-info", "__pycache__"
)
FOLDERS = (".ci", "benchmarks", "docs", "sample_logs", "tests", "timemap_cli")
SINGLE = {
    "CHANGELOG.md",
    "LICENSE",
    "MANIFEST.in",
    "Makefile",
    "README.md",
    "constraints.txt",
    "pyproject.toml",
}


@pytest.fixture(scope="module")
def released(tmp_path_factory):
    """A copy of the project, and the names within its source distribution."""
    copy = tmp_path_factory.mktemp("project") / "project"
    shutil.copytree(ROOT, copy, ignore=MADE)
    setup = "from setuptools import setup; setup()"
    subprocess.run(
        [sys.executable, "-W", "ignore", "-c", setup, "-q", "sdist"],
        cwd=copy,
        check=True,
        capture_output=True,
    )
    (archive,) = (copy / "dist").iterdir()
    with tarfile.open(archive) as file:
        names = {name.partition("/")[2] for name in file.getnames() if file.getmember(name).isfile()}
    return copy, names


def test_the_source_distribution_holds_all_that_its_tests_need(released):
    copy, names = released
    there = {path.relative_to(copy).as_posix() for folder in FOLDERS for path in (copy / folder).rglob("*.*")}
    files = {name for name in there if (copy / name).is_file()}
    assert not files - names
    assert not SINGLE - names
    assert ".ci/run" in names


def test_and_nothing_that_was_made_by_running_them(released):
    _, names = released
    made = [name for name in names if "__pycache__" in name or name.endswith((".pyc", ".timemap.mcap"))]
    assert not [name for name in made if not name.startswith("tests/earlier/")]
