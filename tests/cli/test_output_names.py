"""The suffix of an output says its format, `-` is standard output, and what is neither is refused before any work."""

import io
import json
from pathlib import Path

import pytest

from tests.cli.program import Screen, timemap
from tests.cli.result_files import written
from tests.conftest import ROOT
from timemap_cli.cli.main import main
from timemap_cli.cli.terminal import Terminal

MONDAY = str(ROOT / "sample_logs" / "patrol_monday.mcap")
HEADS = {
    ".png": b"\x89PNG\r\n\x1a\n",
    ".svg": b'<?xml version="1.0" encoding="utf-8" standalone="no"?>\n<!DOCTYPE svg ',
    ".pdf": b"%PDF-",
}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The current folder, with a result in it."""
    monkeypatch.chdir(tmp_path)
    written(Path("room.mcap"))
    assert timemap("check", "room.mcap", "--baseline", "base.yaml", "--update-baseline").code == 0


def to_pipe(*args):
    """Exit code and the bytes that go to standard output, where a program reads them."""
    out, err = io.TextIOWrapper(io.BytesIO(), encoding="utf-8"), io.StringIO()
    code = main(list(args), Terminal(out, err, {}))
    return code, out.buffer.getvalue(), err.getvalue()


@pytest.mark.parametrize("suffix", HEADS)
@pytest.mark.parametrize("what", [(), ("--level", "long", "mid"), ("--node", "0")])
def test_a_picture_is_of_the_format_that_its_name_says(suffix, what):
    for name in (f"p{suffix}", f"P{suffix.upper()}"):
        assert timemap("plot", "room.mcap", *what, "-o", name).out == f"{name}\n"
        assert Path(name).read_bytes().startswith(HEADS[suffix])
    assert Path(f"p{suffix}").read_bytes() == Path(f"P{suffix.upper()}").read_bytes()  # every time the same


@pytest.mark.parametrize("suffix", HEADS)
def test_with_force_a_picture_of_the_same_format_gives_way_and_nothing_else(suffix):
    output = f"p{suffix}"
    assert timemap("plot", "room.mcap", "-o", output).code == 0
    assert timemap("plot", "room.mcap", "-o", output).code == 2
    assert timemap("plot", "room.mcap", "-o", output, "--force").code == 0
    Path(output).write_bytes(b"mine")
    told = timemap("plot", "room.mcap", "-o", output, "--force")
    assert (told.code, Path(output).read_bytes()) == (2, b"mine")
    assert f"is not a {suffix[1:].upper()} picture" in told.err


@pytest.mark.parametrize(
    ("call", "told", "tried"),
    [
        (
            ("plot", "room.mcap", "-o", "p.jpg"),
            "p.jpg is no name of a picture, which ends in .png, .svg or .pdf",
            "-o p.png",
        ),
        (
            ("plot", "room.mcap", "-o", "p"),
            "p is no name of a picture, which ends in .png, .svg or .pdf",
            "-o p.png",
        ),
        (
            ("report", "room.mcap", "-o", "r.pdf"),
            "r.pdf is no name of a page, which ends in .html or .htm",
            "-o r.html",
        ),
        (
            ("replay", MONDAY, "-o", "out.bag"),
            "out.bag is no name of a result, which ends in .mcap",
            "-o out.mcap",
        ),
        (("replay", MONDAY, "-o", "out"), "out is no name of a result, which ends in .mcap", "-o out.mcap"),
        (
            ("replay", MONDAY, "-o", "-"),
            "a result is a file: it does not go to standard output",
            "-o OUT.mcap",
        ),
        (
            ("check", MONDAY, "--baseline", "base.yaml", "-o", "out.bag"),
            "out.bag is no name of a result, which ends in .mcap",
            "-o out.mcap",
        ),
        (
            ("check", MONDAY, "--baseline", "base.yaml", "-o", "-"),
            "a result is a file: it does not go to standard output",
            "-o OUT.mcap",
        ),
        (
            ("check", "room.mcap", "--baseline", "base.yaml", "--html", "c.pdf"),
            "c.pdf is no name of a page, which ends in .html or .htm",
            "--html c.html",
        ),
        (
            ("check", "room.mcap", "--baseline", "base.yaml", "--html", "-"),
            "the page of a check is a file: it does not go to standard output",
            "--html CHECK.html",
        ),
        (
            ("check", "room.mcap", "--baseline", "-", "--update-baseline"),
            "a baseline is a file: it does not go to standard output",
            "--baseline BASELINE.yaml",
        ),
        (
            ("check", "room.mcap", "--baseline", "base.yaml", "--format", "junit=j.json"),
            "j.json is no name of a file of junit, which ends in .xml",
            "--format junit=j.xml",
        ),
        (
            ("check", "room.mcap", "--baseline", "base.yaml", "--format", "json=j.html"),
            "j.html is no name of a file of json, which ends in .json",
            "--format json=j.json",
        ),
    ],
)
def test_a_name_of_another_format_is_refused_before_anything_is_written(call, told, tried):
    there = sorted(Path().iterdir())
    ran = timemap(*call)
    assert (ran.code, ran.err) == (2, f"error: {told}\n  try: {tried}\n")
    assert sorted(Path().iterdir()) == there


@pytest.mark.parametrize("name", ["verdict", "j.out", "t.txt"])
def test_the_file_of_a_format_may_have_any_name_that_says_no_other_format(name):
    assert timemap("check", "room.mcap", "--baseline", "base.yaml", f"--format=markdown={name}").code == 0
    assert Path(name).read_text(encoding="utf-8").startswith("### ")


def test_a_page_goes_to_standard_output_as_it_would_into_a_file():
    assert timemap("report", "room.mcap", "-o", "r.html").code == 0
    assert to_pipe("report", "room.mcap", "-o", "-") == (0, Path("r.html").read_bytes(), "")


def test_a_picture_goes_to_standard_output_as_png():
    assert timemap("plot", "room.mcap", "-o", "p.png").code == 0
    assert to_pipe("plot", "room.mcap", "-o", "-") == (0, Path("p.png").read_bytes(), "")


@pytest.mark.parametrize("command", ["report", "plot"])
def test_a_terminal_is_not_flooded(command):
    out, err = Screen(), Screen()
    assert main([command, "room.mcap", "-o", "-"], Terminal(out, err, {"NO_COLOR": "1"})) == 2
    assert (out.getvalue(), err.getvalue().splitlines()[0]) == (
        "",
        "error: standard output is a terminal, and what comes is not for people to read",
    )


def test_the_verdict_of_a_check_goes_to_standard_output():
    call = ("check", "room.mcap", "--baseline", "base.yaml")
    assert timemap(*call, "--format", "json=-").out == timemap(*call, "--format", "json").out
    assert json.loads(timemap(*call, "--format", "json=-", "--format", "junit=j.xml").out)["exit_code"] == 0
    told = timemap(*call, "--format", "json=-", "--format", "text")
    assert (told.code, told.err.splitlines()[0]) == (2, "error: standard output takes one format")
    assert not Path("-").exists()
