"""What a run of the tests promises: examples that depend on no order, and a word for what was not tested."""

import os
import subprocess
import sys

import pytest

from tests.conftest import PACKAGES, PAGE_TESTS, ROOT


@pytest.mark.parametrize("package", PACKAGES)
def test_all_modules_whose_literals_hypothesis_may_draw_are_imported_before_it_draws(package):
    paths = (path.relative_to(ROOT).with_suffix("") for path in (ROOT / package).rglob("*.py"))
    names = {".".join(path.parts).removesuffix(".__init__") for path in paths if path.stem != "__main__"}
    assert not names - set(sys.modules)


def page_tests(**environment):
    """A run of the page's tests where no browser is to be found."""
    given = {"PATH": "/nowhere", "HOME": os.environ.get("HOME", "/"), "PYTHONPATH": str(ROOT)}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-q", PAGE_TESTS, "--randomly-seed=7"],
        cwd=ROOT,
        env=given | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.fixture(scope="module")
def without_browser():
    return page_tests()


def test_without_a_browser_the_last_lines_say_what_was_not_tested_and_how_to_have_it(without_browser):
    assert without_browser.returncode == 0
    told, hint, _ = without_browser.stdout.splitlines()[-3:]
    assert told.startswith("NOT TESTED: the report's page (")
    assert told.endswith(" tests): no Chromium with its chromedriver here")
    assert hint == "  try: apt-get install chromium chromium-driver"


def test_where_a_browser_is_required_a_skipped_test_of_the_page_is_a_failure():
    assert page_tests(TIMEMAP_BROWSER="required").returncode == 1


def test_the_seed_of_the_order_is_told(without_browser):
    assert "random order: make test RANDOM_SEED=7 repeats it\n" in without_browser.stdout
