"""Checks that come to no verdict: what is reported of them, and that the others do not suffer."""

import json
import os
from xml.etree import ElementTree as ET

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import all_levels, write
from tests.results.rewriting import rewritten
from timemap_cli import checking, suite
from timemap_cli.checking import Check
from timemap_cli.results import channels

PLAIN = ["plain.timemap.mcap", "--baseline", "b.yaml"]
BAD = {
    "a missing result": ("gone.timemap.mcap", "b.yaml", 2, "there is no file gone.timemap.mcap"),
    "a missing baseline": ("plain.timemap.mcap", "gone.yaml", 2, "there is no file gone.yaml"),
    "a baseline that is a folder": ("plain.timemap.mcap", "folder", 1, "cannot read folder: is a directory"),
    "a damaged baseline": ("plain.timemap.mcap", "cut.yaml", 1, "cut.yaml is damaged"),
    "a hostile baseline": ("plain.timemap.mcap", "alias.yaml", 1, "alias.yaml is damaged: it holds an alias"),
    "no baseline": ("plain.timemap.mcap", "plain.timemap.mcap", 2, "plain.timemap.mcap is not a baseline"),
    "a damaged result": ("cut.timemap.mcap", "b.yaml", 2, "cut.timemap.mcap"),
    "a hostile result": ("list.timemap.mcap", "b.yaml", 1, "list.timemap.mcap is damaged"),
    "a recording that is none": ("b.yaml", "b.yaml", 2, "b.yaml"),
    "a folder": ("folder", "b.yaml", 2, "folder"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder: a result, its baseline, and what is wrong with either."""
    monkeypatch.chdir(tmp_path)
    plain = write(tmp_path / "plain.timemap.mcap", [(0, all_levels(box=False))])
    assert timemap("check", *PLAIN, "--update-baseline").code == 0
    text = (tmp_path / "b.yaml").read_text()
    (tmp_path / "cut.yaml").write_text(text[:-9])
    (tmp_path / "alias.yaml").write_text(text.replace("settings:\n", "settings: *a\n"))
    (tmp_path / "cut.timemap.mcap").write_bytes(plain.read_bytes()[:-400])
    rewritten(plain, tmp_path / "list.timemap.mcap", attachments={channels.CONFIG: b"- a\n"})
    (tmp_path / "folder").mkdir()
    return tmp_path


def cases(path):
    """Of each suite in a JUnit file: tests, failures and errors, and the errors' messages."""
    return [
        (*(int(one.get(name)) for name in ("tests", "failures", "errors")),
         [error.get("message") for error in one.iter("error")])
        for one in ET.parse(path).getroot()
    ]  # fmt: skip


@pytest.mark.parametrize("bad", BAD)
def test_a_suite_of_good_bad_good_writes_two_passes_and_an_error(folder, bad):
    source, baseline, code, message = BAD[bad]
    rows = [
        {"name": "first", "result": "plain.timemap.mcap", "baseline": "b.yaml"},
        {"name": "bad", "logs": source, "baseline": baseline},
        {"name": "last", "result": "plain.timemap.mcap", "baseline": "b.yaml"},
    ]
    (folder / "s.yaml").write_text(json.dumps({"checks": rows}))
    ran = timemap("check", "--suite", "s.yaml", "--format", "junit=j.xml")
    assert (ran.code, ran.out) == (code, "")
    first, wrong, last = cases(folder / "j.xml")
    assert first == last == (first[0], 0, 0, [])
    assert wrong[:3] == (1, 0, 1)
    assert message in wrong[3][0]


@pytest.mark.parametrize("bad", BAD)
def test_a_single_check_that_comes_to_no_verdict_writes_its_junit_and_says_the_error(folder, bad):
    source, baseline, code, message = BAD[bad]
    ran = timemap("check", source, "--baseline", baseline, "--format", "junit=j.xml", "--format", "json")
    assert (ran.code, ran.err.startswith("error: ")) == (code, True)
    assert message in ran.err
    assert json.loads(ran.out)["checks"][0]["outcome"] == "error"
    ((*counts, messages),) = cases(folder / "j.xml")
    assert counts == [1, 0, 1]
    assert ran.err.splitlines()[0] == f"error: {messages[0]}"


def test_an_error_is_told_once_where_no_format_is_asked_for(folder):
    ran = timemap("check", "gone.mcap", "--baseline", "b.yaml")
    assert (ran.code, ran.out, ran.err.count("gone.mcap")) == (2, "", 1)


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (KeyError("x"), "timemap itself failed: KeyError in test_check_errors.py, line "),
        (MemoryError(), "there is not enough memory"),
        (OSError(28, "No space left on device", "/b"), "/b: no space left on device"),
        (
            RecursionError("deep" * 1000),
            "timemap itself failed: RecursionError in test_check_errors.py, line ",
        ),
    ],
)
def test_what_nobody_expected_is_an_error_of_its_check_alone(folder, monkeypatch, error, message):
    usual = checking.check

    def check(one, *more):
        if one.name == "bad":
            raise error
        return usual(one, *more)

    monkeypatch.setattr(checking, "check", check)
    names = ("first", "bad", "last")
    rows = [{"name": name, "result": "plain.timemap.mcap", "baseline": "b.yaml"} for name in names]
    (folder / "s.yaml").write_text(json.dumps({"checks": rows}))
    ran = timemap("check", "--suite", "s.yaml", "--format", "junit=j.xml")
    first, bad, last = cases(folder / "j.xml")
    assert (ran.code, first[1:3], bad[1:3], last[1:3]) == (1, (0, 0), (0, 1), (0, 0))
    assert bad[3][0].startswith(message)
    assert len(bad[3][0]) < 200


class Deadly:
    """Ends the process that it is handed over to."""

    def __reduce__(self):
        return os._exit, (9,)


def test_a_process_that_dies_takes_no_other_check_with_it(folder):
    def check(name, **more):
        return Check((folder / "plain.timemap.mcap",), folder / "b.yaml", name, **more)

    checks = [check("a"), check("b", config=Deadly()), check("c"), check("d")]
    found = suite.run(checks, 2)
    assert [one.name for one in found] == ["a", "b", "c", "d"]
    assert [one.verdict is not None for one in found] == [True, False, True, True]
    assert found[1].error.message.startswith("its process was ended from outside")


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"baseline": "a\0b"}, "checks[0] of s.yaml has no baseline"),
        ({"baseline": "b" * 5000}, "checks[0] of s.yaml has no baseline"),
        ({"logs": ["a\0b"]}, "logs in checks[0] of s.yaml is no list of recordings"),
        ({"config": "a\0b"}, "config in checks[0] of s.yaml is no file of settings"),
        ({"config": [1]}, "config in checks[0] of s.yaml is no file of settings"),
        ({"name": "n" * 5000}, "the name of checks[0] of s.yaml is no text"),
        ({"k" * 900: 1}, "unknown key kkkk"),
        ({"tolerances": {"t" * 900: 1}}, "unknown tolerance tttt"),
    ],
)
def test_names_that_no_file_can_have_are_refused_at_their_place(folder, row, message):
    one = {"logs": ["plain.timemap.mcap"], "baseline": "b.yaml"} | row
    (folder / "s.yaml").write_text(json.dumps({"checks": [one]}))
    ran = timemap("check", "--suite", "s.yaml")
    assert ran.code == 2
    assert ran.err.startswith(f"error: {message}")
    assert max(map(len, ran.err.splitlines())) < 600
