from dataclasses import replace

import pytest

from tests.reports.inspections import INTEL, LOG, SCAN, STUCK
from timemap_cli.logs.beams import BeamCounts
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.pose_quality import PoseReport
from timemap_cli.reports.info_text import info_text


def test_the_whole_text():
    assert info_text(INTEL).splitlines() == [
        "intel.mcap: ROS 2 mcap, 44 min 11 s from 2000-12-05T21:48:09.905Z",
        "  /scan     910 scans at 0.299 Hz in 'laser'",
        "            180 beams over 179 deg, 0.1 to 80 m",
        "            beams: 97.5 % hit, 2.55 % no return",
        "            no return: 81.83 m",
        "            905 of 910 scans have a pose",
        "  /pose     910 PoseWithCovarianceStamped in 'map'",
        "  /odom     2639 Odometry of 'base_link' in 'odom'",
        "  /tf       910 TFMessage",
        "            and 2 other topics",
        "  problems  /scan: stamps step back once, by up to 0.86 s",
        "            /scan: 1 gap without scans, up to 20.1 s",
        "",
        "A replay would use",
        "  scans      /scan",
        "  map frame  map",
        "  poses      tf (map > base_link > laser)",
        "  stamps     2000-12-05T21:48:09.859Z to 2000-12-05T22:32:20.7Z, the time that --start and --end mean",
        "  no return  no evidence: 67 % of those sampled pass through something solid (glass, mirrors, black surfaces)",
        "  warning    odometry drifts",
        "  problem    b.mcap has no scans of /scan",
    ]


def test_a_recording_without_messages_has_no_date():
    empty = replace(LOG, start_ns=0, end_ns=0, scans=(), poses=(), other_topics=0, problems=())
    assert info_text(replace(STUCK, logs=(empty,))).splitlines()[0] == (
        "intel.mcap: ROS 2 mcap, no message that can be read"
    )


@pytest.mark.parametrize(("posed", "said"), [(1, "it has a pose"), (0, "it has no pose")])
def test_a_single_scan_is_one(posed, said):
    log = replace(LOG, scans=(replace(SCAN, count=1, with_pose=posed),))
    assert f"            {said}" in info_text(replace(INTEL, logs=(log,))).splitlines()


def test_it_says_why_a_replay_would_stop_and_what_to_try():
    assert info_text(STUCK).splitlines()[-3:] == [
        "A replay would stop: 2 scan topics and none named: /a, /b",
        "  try: --scan-topic /a",
        "  try: --scan-topic /b",
    ]


@pytest.mark.parametrize(
    ("found", "no_return", "text"),
    [
        (
            MissingReturns(605, 0.145),
            "clear",
            "free space: 14 % of those sampled pass through something solid",
        ),
        (MissingReturns(12, None), "clear", "free space; 12 in the sample, too few to test"),
        (MissingReturns(0, None), "clear", "there is none"),
        (None, "clear", "free space, as set"),
        (None, "ignore", "no evidence, as set"),
    ],
)
def test_what_missing_returns_count_as(found, no_return, text):
    tests = {(0, "/scan"): found} if found else {}
    are_clear = {(0, "/scan"): no_return == "clear"}
    inspection = replace(INTEL, missing_returns=tests, missing_are_clear=are_clear, no_return=no_return)
    assert f"  no return  {text}\n" in info_text(inspection)


def test_of_several_recordings_each_says_what_its_missing_returns_count_as():
    tests = {(0, "/scan"): MissingReturns(900, 0.67), (1, "/scan"): MissingReturns(90, 0.22)}
    are_clear = dict.fromkeys(tests, False)
    logs = (LOG, replace(LOG, path="later.mcap"))
    told = info_text(replace(INTEL, logs=logs, missing_returns=tests, missing_are_clear=are_clear))
    assert "  no return  intel.mcap: no evidence: 67 % of those sampled pass" in told
    assert (
        "  no return  later.mcap: no evidence: 22 % of those sampled pass through something solid, "
        "but others of the recordings before it\n"
    ) in told


@pytest.mark.parametrize(
    ("jumps", "aside", "lines"),
    [
        (0, {"uncertain_pose": 0, "pose_jump": 0}, []),
        (
            1,
            {"uncertain_pose": 0, "pose_jump": 1},
            ["poses jump once, by 1.2 m at 2000-12-05T21:48:20Z", "1 scan would be set aside: pose_jump 1"],
        ),
        (
            3,
            {"uncertain_pose": 7, "pose_jump": 4},
            [
                "poses jump 3 times, by up to 1.2 m at 2000-12-05T21:48:20Z",
                "11 scans would be set aside: uncertain_pose 7, pose_jump 4",
            ],
        ),
    ],
)
def test_how_good_the_poses_are(jumps, aside, lines):
    report = PoseReport("/amcl_pose", 0.604, 0.25, jumps, 1.234, 976_052_900_000_000_001, aside)
    log = replace(LOG, scans=(replace(SCAN, pose_report=report),))
    told = info_text(replace(INTEL, logs=(log,))).splitlines()
    certain = "poses uncertain by up to 0.6 m and 14 deg (one standard deviation, /amcl_pose)"
    expected = ["905 of 910 scans have a pose", certain, *lines]
    assert told[5 : 6 + 1 + len(lines)] == [f"            {line}" for line in expected]


def test_poses_of_which_nothing_is_known_are_not_talked_about():
    report = PoseReport(None, None, None, 0, 0.0, 0, {"uncertain_pose": 0, "pose_jump": 0})
    log = replace(LOG, scans=(replace(SCAN, pose_report=report),))
    assert info_text(replace(INTEL, logs=(log,))) == info_text(INTEL)


def test_small_shares_are_not_rounded_to_nothing_nor_large_ones_to_all():
    beams = BeamCounts(hit=1_000_000, no_return=1, invalid=2)
    told = info_text(replace(INTEL, logs=(replace(LOG, scans=(replace(SCAN, beams=beams),)),)))
    assert "beams: > 99.9 % hit, < 0.1 % no return, < 0.1 % invalid" in told


def test_a_topic_whose_scans_cannot_be_read_is_told():
    scan = replace(SCAN, count=0, beams=BeamCounts(), with_pose=0)
    assert "  /scan     no scan that can be read\n" in info_text(
        replace(INTEL, logs=(replace(LOG, scans=(scan,)),))
    )


def test_a_line_feed_in_a_name_forges_no_line():
    text = info_text(
        replace(INTEL, logs=(replace(LOG, scans=(replace(SCAN, frame_id="laser'\nA replay would use"),)),))
    )
    assert "  /scan     910 scans at 0.299 Hz in 'laser'\\nA replay would use'" in text.splitlines()
    assert text.splitlines().count("A replay would use") == 1
