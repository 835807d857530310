import json
import os

import pytest

from tests.cli import result_files
from tests.cli.program import timemap
from tests.cli.result_files import NODE, SECOND, START, all_levels, write, written
from timemap_cli.model.nodes import Node


@pytest.fixture
def result(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return written(tmp_path / "r.timemap.mcap").name


def document(*args):
    ran = timemap("diff", *args, "--json")
    assert ran.code == 0, ran.err
    return json.loads(ran.out)


def sides(found):
    return [
        (side["level"], (int(side["stamp_ns"]) - START) // SECOND) for side in (found["from"], found["to"])
    ]


def test_what_the_faster_level_has_and_the_slower_has_not_has_appeared(result):
    found = document(result, "--level", "long", "mid")
    assert found["schema"] == "timemap.diff/1"
    assert sides(found) == [("long", 20), ("mid", 20)]
    (change,) = found["changes"]
    assert change["kind"] == "appeared"
    # The box stands 2 m to the left of the node, its chord is a little nearer.
    assert (change["x"], change["y"]) == pytest.approx((NODE.x, NODE.y + 2.0), abs=0.1)


def test_the_table_names_both_sides_and_the_change(result):
    ran = timemap("diff", result, "--level", "long", "mid")
    assert (ran.code, ran.err) == (0, "")
    assert "from" in ran.out
    assert "appeared" in ran.out
    assert result in ran.out


@pytest.mark.parametrize(
    "args",
    [
        "--level long mid",
        "--level mid long",
        "{r} --level long mid",
        "--level long mid {r}",
        "--level=long mid {r}",
        "--level long --level mid {r}",
        "{r} --level long mid --at end",
        "--at end --level long mid ./{r}",
    ],
)
def test_levels_and_result_come_in_any_order_and_the_slower_is_from(result, args):
    found = document(*args.format(r=result).split())
    assert sides(found) == [("long", 20), ("mid", 20)]
    assert [change["kind"] for change in found["changes"]] == ["appeared"]


def test_levels_are_compared_at_a_time(result):
    found = document(result, "--level", "long", "mid", "--at", "end-10s")
    assert sides(found) == [("long", 10), ("mid", 10)]
    assert found["changes"] == []


@pytest.mark.parametrize("times", [("start", "end"), ("end", "+0s"), (str(START), "2023-11-14T22:13:40Z")])
def test_the_earlier_time_is_from(result, times):
    found = document(result, "--level", "mid", "--between", *times)
    assert sides(found) == [("mid", 0), ("mid", 20)]
    assert [change["kind"] for change in found["changes"]] == ["appeared"]


def test_two_results_are_compared_at_their_ends_the_one_that_ends_earlier_first(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monday = write(tmp_path / "monday.mcap", [(0, all_levels(True))])
    tuesday = write(tmp_path / "tuesday.mcap", [(50, all_levels(False))])
    for args in ((monday, tuesday), (tuesday, monday)):
        found = document(*args, "--level", "long")
        assert sides(found) == [("long", 0), ("long", 50)]
        assert [change["kind"] for change in found["changes"]] == ["vanished"]
    assert found["from"]["result"] == str(monday)


def test_nodes_of_two_results_are_matched_by_their_place(tmp_path):
    one = write(tmp_path / "one.mcap", [(0, all_levels(True))], [Node(50.0, 0.0), NODE])
    two = write(tmp_path / "two.mcap", [(50, all_levels(False))], [NODE, Node(90.0, 0.0)])
    found = document(one, two, "--level", "long")
    assert [node["id"] for node in found["nodes"]] == [1]
    assert (found["nodes"][0]["x"], found["nodes"][0]["y"]) == (NODE.x, NODE.y)


def test_results_without_a_common_place_or_settings_cannot_be_compared(tmp_path):
    one = write(tmp_path / "one.mcap", [(0, all_levels(True))])
    for name, more, said in (
        ("far", {"nodes": [Node(50.0, 0.0)]}, "looked at no common place"),
        ("frame", {"map_frame": "odom"}, "map frame is map here and odom there"),
        ("radius", {"radius": 5.0}, "radius is 10.0 here and 5.0 there"),
    ):
        other = write(tmp_path / f"{name}.mcap", [(50, all_levels(False))], **more)
        ran = timemap("diff", one, other, "--level", "long")
        assert ran.code == 2
        assert said in ran.err
        assert "  try: " in ran.err
        assert "--force" not in ran.err  # nobody is led to replace a result


def test_without_a_result_the_newest_of_the_folder_is_taken_and_named(result, tmp_path):
    newer = write(tmp_path / "newer.timemap.mcap", [(0, all_levels(False))])
    os.utime(newer, (2e9, 2e9))
    ran = timemap("diff", "--level", "long", "mid")
    assert ran.err.splitlines()[0] == "using newer.timemap.mcap, the newest result in this folder"
    os.utime(newer, (1e9, 1e9))
    assert timemap("diff", "--level", "long", "mid").err.startswith(f"using {result}, ")


def test_without_any_result_it_is_a_usage_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = timemap("diff", "--level", "long", "mid")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("error: no result given, and no *.timemap.mcap in this folder\n  try: ")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        ("{r}", "--level is missing"),
        ("{r} --level long", "--level long alone compares nothing"),
        ("{r} --level long mid --between start end", "names two levels where one is compared"),
        ("{r} {r} --level long mid", "names two levels where one is compared"),
        ("{r} {r} {r} --level long", "3 results given"),
        ("{r} --level long mid --level short", "3 levels given: long, mid, short"),
        ("{r} --level mid --between start end --at end", "exclude each other"),
        ("{r} {r} --level mid --between start end", "two results are compared at their ends"),
        ("{r} --level mid --at end", "--at needs two levels"),
        ("{r} --level long slow", "has no level 'slow', only short, mid, long"),
        ("{r} --level long long", "cannot differ from itself"),
        ("{r} --level long mid --at soon", "'soon' is not a time"),
        (
            "{r} --level long mid --at 2d",
            "knows nothing at 2d: its estimates go from 2023-11-14T22:13:20Z to",
        ),
        ("{r} --level long mid --at 5", "'5' alone is nanoseconds since 1970"),
        ("{r} --level mid --between 5", "requires 2 arguments"),
        ("{r} --between +1s --level mid", "--between needs two times"),
        ("{r} --level long mid --at=", "'' is not a time"),
        ("{r} --level mid --at=", "--at needs two levels"),
    ],
)
def test_what_cannot_be_compared_is_one_error_with_something_to_try(result, args, said):
    ran = timemap("diff", *args.format(r=result).split())
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("error: ")
    assert said in ran.err.splitlines()[0]
    assert "\n  try: " in ran.err


def test_a_time_before_a_resumed_result_is_to_be_asked_of_the_one_it_goes_on_from(tmp_path):
    earlier = json.dumps({"name": "monday.timemap.mcap", "sha256": "0" * 64})
    boxes = [(0, all_levels(False)), (9, all_levels(False))]
    later = write(tmp_path / "r.timemap.mcap", boxes, metadata={"resumed_from": earlier})
    monday = tmp_path / "monday.timemap.mcap"
    ran = timemap("diff", later, "--level", "mid", "--between", "2023-11-14", "end")
    assert ran.code == 2
    assert ran.err.splitlines()[0].endswith(", it goes on from monday.timemap.mcap")
    assert ran.err.splitlines()[1] == f"  try: timemap diff {monday} {later} --level mid"
    ran = timemap("diff", later, "--level", "long", "mid", "--at", "1d")
    assert (
        ran.err.splitlines()[1] == f"  try: timemap diff {monday} --level long mid --at 2023-11-13T22:13:29Z"
    )


def test_a_missing_result_is_a_usage_error(tmp_path):
    ran = timemap("diff", tmp_path / "absent.mcap", "--level", "long", "mid")
    assert (ran.code, ran.out) == (2, "")
    assert "absent.mcap" in ran.err


def test_what_the_hint_proposes_for_a_wrong_level_works(result):
    ran = timemap("diff", result, "--level", "long", "slow")
    (proposed,) = [line.removeprefix("  try: timemap ") for line in ran.err.splitlines()[1:]]
    assert timemap(*proposed.split()).code == 0


def test_exit_code_tells_whether_there_are_differences(result):
    assert timemap("diff", result, "--level", "long", "mid", "--exit-code").code == 4
    assert timemap("diff", result, "--level", "mid", "short", "--exit-code").code == 0
    assert timemap("diff", result, "--level", "long", "mid").code == 0


# The box is a chord 2 m away and 30 degrees wide: 1.04 m across; the wall behind it stands at 4 m.
@pytest.mark.parametrize(
    ("wanted", "code"),
    [
        (("--min-size", "0.8"), 4),
        (("--min-size", "1.3"), 0),
        (("--min-shift", "1.9"), 4),
        (("--min-shift", "2.1"), 0),
        (("--min-size", "0.8", "--min-shift", "2.1"), 0),
    ],
)
def test_exit_code_tells_of_the_changes_that_are_large_enough(result, wanted, code):
    ran = timemap("diff", result, "--level", "long", "mid", "--exit-code", *wanted)
    assert ran.code == code
    assert ("1 smaller change left out." in ran.out) == (code == 0)
    summary = document(result, "--level", "long", "mid", *wanted)["summary"]
    assert (summary["changes"], summary["small"]) == ((1, 0) if code else (0, 1))


def test_a_negative_least_size_is_refused(result):
    ran = timemap("diff", result, "--level", "long", "mid", "--min-size", "-1")
    assert ran.code == 2
    assert "--min-size" in ran.err


def test_nodes_that_the_other_result_does_not_have_are_told(tmp_path):
    one = write(tmp_path / "one.mcap", [(0, all_levels(True))], [Node(50.0, 0.0), NODE])
    two = write(tmp_path / "two.mcap", [(50, all_levels(False))], [NODE, Node(90.0, 0.0), Node(95.0, 0.0)])
    ran = timemap("diff", two, one, "--level", "long")
    assert f"No partner in the other result: 1 node of {one} and 2 nodes of {two}." in ran.out
    assert document(two, one, "--level", "long")["summary"]["without_partner"] == {"from": 1, "to": 2}


def test_results_with_the_same_nodes_leave_none_without_partner(tmp_path):
    one = write(tmp_path / "one.mcap", [(0, all_levels(True))])
    two = write(tmp_path / "two.mcap", [(50, all_levels(False))])
    assert "No partner" not in timemap("diff", one, two, "--level", "long").out
    assert document(one, two, "--level", "long")["summary"]["without_partner"] == {"from": 0, "to": 0}


def test_levels_of_one_result_have_no_partners_to_tell_of(result):
    assert "without_partner" not in document(result, "--level", "long", "mid")["summary"]


def proposals(ran):
    return [line.removeprefix("  try: ") for line in ran.err.splitlines() if line.startswith("  try: ")]


def test_where_nothing_was_seen_again_the_ends_of_the_recordings_are_proposed(tmp_path):
    seen = [(0, all_levels(False)), (10, all_levels(False)), (20, all_levels(True)), (30, all_levels(True))]
    result = write(tmp_path / "r.timemap.mcap", seen, ends=(10, 30))
    ran = timemap("diff", result, "--level", "mid", "--between", "start", "+1s")
    assert ran.code == 0
    assert "Nothing could be compared" in ran.out
    (proposed,) = proposals(ran)
    assert proposed.endswith("--level mid --between 2023-11-14T22:13:30Z 2023-11-14T22:13:50Z")
    found = document(*proposed.removeprefix("timemap diff ").split())
    assert [change["kind"] for change in found["changes"]] == ["appeared"]


def test_of_a_single_recording_its_middle_and_its_end_are_proposed(result):
    ran = timemap("diff", result, "--level", "mid", "--between", "start", "start")
    (proposed,) = proposals(ran)
    assert proposed.endswith("--level mid --between 2023-11-14T22:13:30Z 2023-11-14T22:13:40Z")
    found = document(*proposed.removeprefix("timemap diff ").split())
    assert [change["kind"] for change in found["changes"]] == ["appeared"]


def test_where_no_node_was_ever_seen_again_the_span_of_the_estimates_is_named(tmp_path):
    result = write(tmp_path / "once.mcap", [(20, all_levels(False))], ends=(20,))
    ran = timemap("diff", result, "--level", "mid", "--between", "start", "end")
    assert proposals(ran) == [
        "--level mid --between TIME TIME; the first estimates are of 2023-11-14T22:13:40Z, "
        "the last of 2023-11-14T22:13:40Z"
    ]


def test_nothing_compared_is_not_taken_for_nothing_different(result):
    nothing = ("diff", result, "--level", "mid", "--between", "start", "start")
    assert timemap(*nothing, "--exit-code").code == 2
    assert timemap(*nothing, "--exit-code", "--json").code == 2
    assert timemap(*nothing).code == 0


def test_two_levels_that_agree_point_to_what_both_have_learnt(result):
    ran = timemap("diff", result, "--level", "mid", "short")
    assert "Nothing differs" in ran.out
    assert f"timemap changes {result}" in proposals(ran)
    assert "--between" in proposals(ran)[0]


@pytest.mark.parametrize(
    "args", [["--level", "long", "mid", "--at", "+1h"], ["--level", "mid", "--between", "start", "+1h"]]
)
def test_a_time_after_the_end_is_told(result, args):
    ran = timemap("diff", result, *args)
    assert ran.code == 0
    assert ran.err.startswith(f"warning: {result} ends at 2023-11-14T22:13:40Z: ")


def test_the_fixture_writes_what_it_says():
    assert (result_files.room("mid", 0, box=True).ranges == 2.0).sum() == 30
