import json

import pytest

from tests.cli.program import python, timemap
from tests.cli.result_files import NODE, all_levels, write
from tests.conftest import ROOT

BOTH = ["plain.timemap.mcap", "box.timemap.mcap"]
PLAIN = ["plain.timemap.mcap", "--baseline", "b.yaml"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder: two results, without and with a box, and the baseline of the first."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "plain.timemap.mcap", [(0, all_levels(box=False))])
    write(tmp_path / "box.timemap.mcap", [(0, all_levels(box=True))])
    assert timemap("check", "plain.timemap.mcap", "--baseline", "b.yaml", "--update-baseline").code == 0
    return tmp_path


def test_the_result_that_the_baseline_was_made_of_passes(folder):
    ran = timemap("check", "plain.timemap.mcap", "--baseline", "b.yaml", "--exact")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.startswith("passed  plain against b.yaml: ")


def test_a_result_out_of_tolerance_ends_with_4(folder):
    ran = timemap("check", "box.timemap.mcap", "--baseline", "b.yaml")
    assert ran.code == 4
    assert ran.out.startswith("failed  box against b.yaml: ")
    assert "ranges.places (long)" in ran.out


def test_tolerances_of_an_option_count_and_stay_in_a_baseline_that_is_written_with_them(folder):
    wide = ("--tolerance", "ranges.moved=1", "--tolerance", "ranges.places=9")
    wide += ("--tolerance", "ranges.step=9")
    assert timemap("check", "box.timemap.mcap", "--baseline", "b.yaml", *wide).code == 0
    timemap("check", "plain.timemap.mcap", "--baseline", "b.yaml", "--update-baseline", *wide)
    assert timemap("check", "box.timemap.mcap", "--baseline", "b.yaml").code == 0
    timemap("check", "plain.timemap.mcap", "--baseline", "b.yaml", "--update-baseline")
    assert "  ranges.moved: 1.0\n" in (folder / "b.yaml").read_text()


def test_an_update_tells_what_is_new(folder):
    ran = timemap("check", "box.timemap.mcap", "--baseline", "b.yaml", "--update-baseline")
    assert ran.code == 0
    assert ran.out.startswith("b.yaml: 1 node, 3 levels, 0 change events\n")
    assert "differs: level short at node 0" in ran.out
    again = timemap("check", "box.timemap.mcap", "--baseline", "b.yaml", "--update-baseline")
    assert again.out.splitlines()[1] == "  nothing differs from the baseline that was there"


def test_an_update_replaces_nothing_but_a_baseline(folder):
    for name, content in (("notes.yaml", b"a: 1\n"), ("r.mcap", (folder / "box.timemap.mcap").read_bytes())):
        (folder / name).write_bytes(content)
        ran = timemap("check", "plain.timemap.mcap", "--baseline", name, "--update-baseline")
        assert (ran.code, (folder / name).read_bytes()) == (2, content)
        assert ran.err.startswith(f"error: {name} is not a baseline")


def test_several_formats_go_to_their_files_and_one_to_stdout(folder):
    ran = timemap(
        "check", "box.timemap.mcap", "--baseline", "b.yaml",
        "--format", "junit=j.xml", "--format", "json=j.json", "--format", "github",
    )  # fmt: skip
    assert ran.code == 4
    assert ran.out.startswith("::error file=b.yaml,title=timemap check box%3A ")
    assert (folder / "j.xml").read_text().startswith("<?xml")
    assert json.loads((folder / "j.json").read_text())["exit_code"] == 4


def test_outputs_give_way_to_newer_ones_and_nothing_else_does(folder):
    for form in ("text", "json", "junit", "github", "markdown"):
        (folder / "notes").write_text("mine")
        assert timemap("check", *PLAIN, "--format", f"{form}=notes").code == 2
        assert (folder / "notes").read_text() == "mine"
        for result, code in (("plain", 0), ("box", 4), ("plain", 0)):
            ran = timemap(
                "check", f"{result}.timemap.mcap", "--baseline", "b.yaml", "--format", f"{form}=out.{form}"
            )
            assert (ran.code, ran.out, ran.err) == (code, "", "")


def test_a_file_that_cannot_be_written_is_told_before_anything_is_read(folder):
    (folder / "j.xml").write_text("mine")
    ran = timemap("check", "no.mcap", "--baseline", "b.yaml", "--format", "junit=j.xml")
    assert (ran.code, (folder / "j.xml").read_text()) == (2, "mine")
    assert ran.err.startswith("error: j.xml exists and is not the junit of a check")


def test_a_damaged_baseline_is_not_written_anew_over_what_a_reviewer_may_want_to_see(folder):
    (folder / "b.yaml").write_text(text := (folder / "b.yaml").read_text()[:-9])
    ran = timemap("check", *PLAIN, "--update-baseline")
    assert (ran.code, (folder / "b.yaml").read_text()) == (1, text)
    assert "try: remove it, or name another file" in ran.err


def test_the_github_format_appends_to_the_summary_of_the_job(folder):
    summary = folder / "summary.md"
    summary.write_text("before\n")
    variables = {"GITHUB_STEP_SUMMARY": str(summary)}
    timemap("check", "box.timemap.mcap", "--baseline", "b.yaml", "--format", "github", variables=variables)
    text = summary.read_text()
    assert text.startswith("before\n### ❌ box: failed\n")


def test_a_summary_that_cannot_be_written_changes_no_verdict(folder):
    variables = {"GITHUB_STEP_SUMMARY": "no/summary.md"}
    args = ("--format", "github", "--format", "junit=j.xml")
    ran = timemap("check", "box.timemap.mcap", "--baseline", "b.yaml", *args, variables=variables)
    assert (ran.code, (folder / "j.xml").exists()) == (4, True)
    assert "cannot write the job's summary no/summary.md: no such file or directory" in ran.err


def test_what_has_no_node_in_common_ends_with_2(folder):
    far = [type(node)(node.x + 50, node.y) for node in (NODE,)]
    write(folder / "far.timemap.mcap", [(0, all_levels(box=False))], far)
    ran = timemap("check", "far.timemap.mcap", "--baseline", "b.yaml")
    assert ran.code == 2
    assert ran.err.startswith("error: nothing can be compared with b.yaml: they have no node in common\n")


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["plain.timemap.mcap"], "--baseline is missing"),
        (["--baseline", "b.yaml"], "no recording or result is named"),
        (["plain.timemap.mcap", "--baseline", "no.yaml"], "there is no file no.yaml"),
        (["no.mcap", "--baseline", "b.yaml"], "there is no file no.mcap"),
        ([*BOTH, "--baseline", "b.yaml"], "plain.timemap.mcap is a result: it is checked alone"),
        ([*PLAIN, "--format", "xml"], "unknown format xml"),
        ([*PLAIN, "--format", "json", "--format", "github"], "standard output takes one format"),
        ([*PLAIN, "--format", "junit="], "--format junit= names no file"),
        ([*PLAIN, "--format", "junit=out", "--format", "json=out"], "two formats go to out"),
        (["no.mcap", "--baseline", "b.yaml", "--format", "junit=no/j.xml"], "cannot write no/j.xml: there is no"),
        ([*PLAIN, "--tolerance", "x=1"], "unknown tolerance x in --tolerance"),
        ([*PLAIN, "--suite", "s.yaml"], "plain.timemap.mcap does not go with --suite: s.yaml says it for each"),
        ([*PLAIN, "--update-baseline", "--format", "json"], "--format does not go with --update-baseline"),
        (["--suite", "s.yaml"], "no suite file s.yaml"),
    ],
)  # fmt: skip
def test_a_call_that_cannot_be_carried_out_ends_with_2(folder, args, message):
    ran = timemap("check", *args)
    assert ran.code == 2
    assert ran.err.startswith(f"error: {message}")


def test_without_a_baseline_it_is_said_how_to_make_one_and_what_is_called_much_like_it(folder):
    ran = timemap("check", "plain.timemap.mcap", "--baseline", "bb.yaml")
    assert ran.err.splitlines()[1:] == ["  try: --update-baseline makes it", "  try: b.yaml"]


SUITE = """
tolerances: {scans.used: 0.5}
checks:
- {result: plain.timemap.mcap, baseline: b.yaml}
- {name: box, result: box.timemap.mcap, baseline: b.yaml, tolerances: {settings.changed: 3}}
- {name: gone, result: gone.timemap.mcap, baseline: b.yaml}
"""


def test_a_suite_runs_all_its_checks_whatever_becomes_of_one(folder):
    sub = folder / "sub"
    sub.mkdir()
    (sub / "s.yaml").write_text(SUITE.replace(": b.yaml", ": ../b.yaml").replace("result: ", "result: ../"))
    ran = timemap("check", "--suite", "sub/s.yaml", "--format", "json")
    document = json.loads(ran.out)
    assert ran.code == 4
    assert [(one["name"], one["outcome"]) for one in document["checks"]] == [
        ("b", "passed"),
        ("box", "failed"),
        ("gone", "error"),
    ]
    allowed = {one["name"]: one["allowed"] for one in document["checks"][1]["measures"]}
    assert (allowed["scans.used"], allowed["settings.changed"]) == (0.5, 3)


def test_a_suite_says_which_check_a_warning_is_about(folder):
    (folder / "cut.mcap").write_bytes((ROOT / "sample_logs/patrol_monday.mcap").read_bytes()[:400_000])
    nodes = "{name: cut, logs: [cut.mcap], baseline: c.yaml}"
    (folder / "s.yaml").write_text(f"checks: [{nodes}, {{result: plain.timemap.mcap, baseline: b.yaml}}]")
    written = timemap("check", "--suite", "s.yaml", "--update-baseline")
    checked = timemap("check", "--suite", "s.yaml")
    assert (written.code, checked.code) == (3, 3)
    assert written.err.startswith("warning: c.yaml: cut.mcap: it is cut off at byte ")
    assert checked.err.startswith("warning: cut: cut.mcap: it is cut off at byte ")


def test_a_suite_tells_the_same_with_any_number_of_jobs(folder):
    (folder / "s.yaml").write_text(SUITE)
    for form in ("text", "junit"):
        one, two = (timemap("check", "--suite", "s.yaml", "--jobs", n, "--format", form) for n in (1, 2))
        assert one == two


def test_a_suite_writes_all_its_baselines_and_keeps_its_tolerances_to_itself(folder):
    (folder / "s.yaml").write_text(
        "tolerances: {scans.used: 0.5}\nchecks: [{result: box.timemap.mcap, baseline: new.yaml}]"
    )
    ran = timemap("check", "--suite", "s.yaml", "--update-baseline")
    assert (ran.code, ran.out) == (0, "new.yaml: 1 node, 3 levels, 0 change events\n")
    assert "\ntolerances: {}\n" in (folder / "new.yaml").read_text()


def test_a_tolerance_of_an_option_stays_in_every_baseline_that_a_suite_writes(folder):
    (folder / "s.yaml").write_text("checks: [{result: box.timemap.mcap, baseline: new.yaml}]")
    timemap("check", "--suite", "s.yaml", "--update-baseline", "--tolerance", "scans.used=0.5")
    assert "\ntolerances:\n  scans.used: 0.5\n" in (folder / "new.yaml").read_text()


def test_two_checks_of_a_suite_do_not_write_one_baseline(folder):
    rows = (
        "{name: a, result: box.timemap.mcap, baseline: x.yaml}",
        "{name: b, result: plain.timemap.mcap, baseline: ./x.yaml}",
    )
    (folder / "s.yaml").write_text(f"checks: [{', '.join(rows)}]")
    ran = timemap("check", "--suite", "s.yaml", "--update-baseline")
    assert (ran.code, (folder / "x.yaml").exists()) == (2, False)
    assert ran.err.startswith("error: x.yaml is the baseline of more than one check\n")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("checks: []", "s.yaml lists no checks"),
        ("cheks: []", "unknown key cheks in s.yaml"),
        ("- a", "s.yaml holds no suite"),
        ("checks: [a]", "checks[0] of s.yaml is no check"),
        ("checks: [{logs: [a.mcap]}]", "checks[0] of s.yaml has no baseline"),
        ("checks: [{logs: a, baseline: ''}]", "checks[0] of s.yaml has no baseline"),
        ("checks: [{name: null, logs: a, baseline: b.yaml}]", "the name of checks[0] of s.yaml is no text"),
        ("checks: " + "[" * 2000, "s.yaml is nested too deeply"),
        ('checks: !!int ""', "s.yaml is not YAML"),
        ("checks: [{baseline: b.yaml}]", "checks[0] of s.yaml needs logs or a result, one of the two"),
        ("checks: [{logs: [3], baseline: b.yaml}]", "logs in checks[0] of s.yaml is no list of recordings"),
        ("checks: [{log: [a], baseline: b.yaml}]", "unknown key log in checks[0] of s.yaml"),
        (
            "checks: [{logs: a, baseline: b.yaml, tolerances: {x: 1}}]",
            "unknown tolerance x in checks[0] of s.yaml",
        ),
        (
            "checks: [{logs: a, baseline: b.yaml}, {logs: c, baseline: b.yaml}]",
            "two checks of s.yaml have the name b",
        ),
    ],
)
def test_a_suite_that_makes_no_sense_is_refused_at_its_place(folder, text, message):
    (folder / "s.yaml").write_text(text)
    ran = timemap("check", "--suite", "s.yaml")
    assert ran.code == 2
    assert ran.err.startswith(f"error: {message}")


def test_a_recording_far_from_every_node_of_the_baseline_cannot_be_compared(folder):
    far = [type(node)(node.x + 500, node.y) for node in (NODE,)]
    write(folder / "far.timemap.mcap", [(0, all_levels(box=False))], far)
    timemap("check", "far.timemap.mcap", "--baseline", "far.yaml", "--update-baseline")
    ran = timemap("check", ROOT / "sample_logs/patrol_tuesday.bag", "--baseline", "far.yaml")
    assert ran.code == 2
    assert ran.err.startswith(
        "error: nothing can be compared with far.yaml: no scan comes near one of its nodes\n"
    )
    assert sorted(path.name for path in folder.iterdir() if path.suffix == ".part") == []


def test_help_needs_no_numpy():
    done = python(
        "import sys; from timemap_cli.cli.main import main; main(['check', '--help']); "
        "assert 'numpy' not in sys.modules"
    )
    assert done.returncode == 0, done.stderr
