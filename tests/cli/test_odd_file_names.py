"""Files of any name go through every command: names that are no UTF-8, that are formulas, markup or part of a URI."""

import json
import os
import warnings
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from rosbags.rosbag2 import StoragePlugin

from tests.cli.program import timemap
from tests.cli.result_files import NO_CHANGES, all_levels, write
from tests.logs import recorded
from tests.logs.recorded import ROS2
from timemap_cli.logs.fingerprint import sha256
from timemap_cli.logs.recordings import Recording

RAW = os.fsdecode(b"m\xff")  # as Python names a file whose name is no UTF-8
NAMES = [RAW, "$_$", "$^$ $\\frac$", "a<b>&\"c'", "*x* | `y`", "-", "--level", "%41?#"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The current folder."""
    monkeypatch.chdir(tmp_path)


def made(name):
    changes = NO_CHANGES | {"summary": {"events": 0, "open": 0}}
    write(Path(name), [(0, all_levels(False)), (10, all_levels(True))], changes=changes)


@pytest.fixture(params=NAMES, ids=ascii)
def result(request):
    """A result of an odd name, without a folder before it that would help."""
    made(f"{request.param}.timemap.mcap")
    return f"{request.param}.timemap.mcap"


def done(*args):
    """What a command prints that must succeed and have nothing to complain of; all of it can be written as UTF-8."""
    ran = timemap(*args)
    assert (ran.code, "error" in ran.err) == (0, False), ran.err
    ran.out.encode()
    return ran.out


def test_every_command_takes_a_result_of_any_name(result):
    for form in ((), ("--json",), ("--csv",), ("--geojson",)):
        done("changes", *form, "--", result)
    for form in ((), ("--json",)):
        done("info", *form, "--", result)
        done("diff", "--level", "long", "mid", *form, "--", result)
    done("report", "--", result)
    for form in ("png", "svg", "pdf"):
        done("plot", "-o", f"p.{form}", "--", result)
    done("plot", "-o", "n.png", "--node", 0, "--", result)


def test_every_format_of_a_check_takes_any_name(result):
    base = Path(result).stem + ".yaml"
    done("check", f"--baseline={base}", "--update-baseline", "--", result)
    formats = {"text": "t.txt", "json": "j.json", "junit": "j.xml", "github": "g.txt", "markdown": "m.md"}
    to_files = [f"--format={form}={file}" for form, file in formats.items()]
    done("check", f"--baseline={base}", *to_files, "--", result)
    for form, file in formats.items():
        assert Path(file).read_text(encoding="utf-8") == done(
            "check", f"--baseline={base}", f"--format={form}", "--", result
        )
    json.loads(Path("j.json").read_text())
    ET.parse("j.xml")
    done("check", f"--baseline={base}", "--html", "c.html", "--", result)


def test_a_name_that_is_no_utf8_is_shown_by_its_bytes():
    made(f"{RAW}.timemap.mcap")
    assert done("info", f"{RAW}.timemap.mcap").splitlines()[0] == r"m\xff.timemap.mcap"
    assert json.loads(done("diff", f"{RAW}.timemap.mcap", "--level", "long", "mid", "--json"))["from"][
        "result"
    ] == (r"m\xff.timemap.mcap")
    done("report", f"{RAW}.timemap.mcap")
    assert r"<title>m\xff" in Path(f"{RAW}.html").read_text(encoding="utf-8")
    assert timemap("info", f"{RAW}.mcap").err.startswith(r"error: there is no file m\xff.mcap")


def test_a_formula_in_a_name_is_drawn_as_it_is_written():
    made("$x$.timemap.mcap")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        done("plot", "$x$.timemap.mcap", "-o", "as_name.svg")
    assert "<!-- $x$: long -->" in Path("as_name.svg").read_text()  # the text, noted beside its outlines


@pytest.mark.parametrize("name", [RAW, "a%41?x=1#y"], ids=ascii)
@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_recording_of_any_name_is_read(tmp_path, name, plugin):
    bag = recorded.write_rosbag2(tmp_path / "bag", recorded.drive(ROS2), plugin)
    (file,) = (one for one in bag.iterdir() if one.name != "metadata.yaml")
    log = file.rename(tmp_path / f"{name}{file.suffix}")
    with Recording(log) as recording:
        found = recorded.rows([one for some in recording.batches(recorded.TOPICS) for one in some])
        assert recording.problems == ()
    assert found == recorded.drive_rows(ROS2)
    Path("any_pose.yaml").write_text("gate: {max_position_std: 0, max_yaw_std_deg: 0, max_jump: 0}")
    out = done("replay", log, "--json", "-o", "out.mcap", "--config", "any_pose.yaml")
    assert json.loads(out)["scans"]["used"] > 0
    assert json.loads(done("info", "out.mcap", "--json"))["results"][0]["inputs"][0]["name"].startswith(
        r"m\xff" if name == RAW else "a%41?x=1#y"
    )


def test_the_digest_of_a_folder_takes_any_name_in_it(tmp_path):
    (tmp_path / RAW).write_bytes(b"1")
    one = sha256(tmp_path)
    (tmp_path / RAW).rename(tmp_path / os.fsdecode(b"m\xfe"))
    assert sha256(tmp_path) != one
