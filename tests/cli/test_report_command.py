import sys

import pytest

from tests.cli.program import timemap
from tests.reports.pages import write_page_result


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the result r.timemap.mcap, the current one."""
    monkeypatch.chdir(tmp_path)
    write_page_result(tmp_path / "r.timemap.mcap")
    return tmp_path


@pytest.fixture
def with_plotly():
    pytest.importorskip("plotly")


def test_the_page_takes_the_name_of_the_result_and_is_named_on_stdout(folder, with_plotly):
    ran = timemap("report", "r.timemap.mcap")
    assert (ran.code, ran.out, ran.err) == (0, "r.html\n", "")
    text = (folder / "r.html").read_text()
    assert text.startswith("<!doctype html>")
    assert "<title>r</title>" in text


def test_without_a_result_the_newest_is_taken_and_named(folder, with_plotly):
    ran = timemap("report", "-o", "page.html")
    assert (ran.code, ran.out) == (0, "page.html\n")
    assert ran.err == "using r.timemap.mcap, the newest result in this folder\n"


def test_the_same_result_gives_the_same_page(folder, with_plotly):
    for name in ("one.html", "two.html"):
        timemap("report", "r.timemap.mcap", "-o", name)
    assert (folder / "one.html").read_bytes() == (folder / "two.html").read_bytes()


def test_an_existing_page_is_replaced_only_by_force(folder, with_plotly):
    page = folder / "r.html"
    page.write_text("<!doctype html>old")
    ran = timemap("report", "r.timemap.mcap")
    assert ran.code == 2
    assert ran.err.startswith("error: r.html exists already\n  try: --force")
    assert page.read_text() == "<!doctype html>old"
    assert timemap("report", "r.timemap.mcap", "--force").code == 0
    assert page.stat().st_size > 1_000_000


def test_force_replaces_nothing_but_a_page(folder, with_plotly):
    mine = folder / "mine.html"
    mine.write_text("<p>mine</p>")
    ran = timemap("report", "r.timemap.mcap", "-o", "mine.html", "--force")
    assert ran.code == 2
    assert ran.err.startswith("error: mine.html exists and is not a page: it is not replaced\n")
    assert mine.read_text() == "<p>mine</p>"


def test_without_plotly_there_is_one_error_and_no_file(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly.offline", None)  # as if it were not there
    ran = timemap("report", "r.timemap.mcap")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == (
        "error: a page needs plotly, which is not installed\n  try: pip install 'timemap-cli[report]'\n"
    )
    assert sorted(path.name for path in folder.iterdir()) == ["r.timemap.mcap"]
