"""What the tests share."""

import importlib
import os
import pkgutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("timemap_cli", "sample_logs", "benchmarks")
PAGE_TESTS = "tests/interop/test_page_in_browser.py"


def module_names():
    """All modules of the project, without those that run when they are imported."""
    for package in PACKAGES:
        yield package
        for module in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
            if not module.name.endswith("__main__"):
                yield module.name


def pytest_sessionstart():
    """Import the whole project: hypothesis draws from the literals of all modules that were imported so far.

    Otherwise what it draws would depend on which tests this process ran before.
    """
    for name in module_names():
        importlib.import_module(name)


def skipped_page_tests(config):
    """Why tests of the page were skipped, a reason for each."""
    reporter = config.pluginmanager.getplugin("terminalreporter")
    skipped = reporter.stats.get("skipped", []) if reporter else []
    return [one.longrepr[2].removeprefix("Skipped: ") for one in skipped if one.nodeid.startswith(PAGE_TESTS)]


def pytest_sessionfinish(session):
    """Where a browser is said to be there, a page test that was skipped is a failure."""
    if os.environ.get("TIMEMAP_BROWSER") == "required" and skipped_page_tests(session.config):
        session.exitstatus = session.exitstatus or pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter, config):
    """Say in the last lines what was not tested and how to have it, and in what order the others ran."""
    seed = getattr(config.option, "randomly_seed", None)
    if seed is not None:
        terminalreporter.write_line(f"random order: make test RANDOM_SEED={seed} repeats it")
    reasons = skipped_page_tests(config)
    if reasons:
        terminalreporter.write_line(f"NOT TESTED: the report's page ({len(reasons)} tests): {reasons[0]}")
        terminalreporter.write_line("  try: apt-get install chromium chromium-driver")


def shared_data(name: str) -> Path:
    """Path of a real recording outside the project; the test is skipped where it is missing."""
    beside = ROOT.parent / "shared" / "data"
    path = Path(os.environ.get("TIMEMAP_SHARED_DATA", beside)) / name
    if not path.exists():
        pytest.skip(f"no recording {name} here")
    return path
