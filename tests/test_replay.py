"""Whole replays of small recordings: what is told, what is refused, which times are meant."""

import numpy as np
import pytest

from tests.conftest import ROOT
from tests.logs.recorded import ROS1, ROS2, START_NS, Message, drive, scan, transforms, write_bag, write_mcap
from timemap_cli.config import load
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.model.observer import Observations
from timemap_cli.replay import replay
from timemap_cli.results.reader import ResultReader

DAY_NS = 86_400_000_000_000
BEARINGS = np.radians(np.arange(-60.0, 61.0))
STILL = (0, 0, 0, 1)
SETTINGS = load(None)
NO_GATE = {"min_travel": 0, "min_turn_deg": 0, "min_interval": "0s"}


def standing_log(path, n_scans=100, start_ns=START_NS, log_later_ns=0, world="map", hole=False, wall=2.0):
    """Ten scans a second of a wall 2 m away, and nothing moves."""
    mount = transforms(ROS2, (start_ns, "base_link", "laser", (0, 0, 0.2, *STILL)))
    messages = [Message("/tf_static", start_ns + log_later_ns, mount)]
    ranges = np.full_like(BEARINGS, np.nan) if hole else wall / np.cos(BEARINGS)
    for i in range(n_scans):
        now, log_ns = start_ns + i * 100_000_000, start_ns + i * 100_000_000 + log_later_ns
        messages.append(
            Message("/tf", log_ns, transforms(ROS2, (now, world, "base_link", (0, 0, 0, *STILL))))
        )
        shape = {"angle_min": float(BEARINGS[0]), "angle_increment": float(np.radians(1.0))}
        messages.append(Message("/scan", log_ns, scan(ROS2, now, ranges, **shape)))
    return write_mcap(path, messages)


def replayed(tmp_path, *logs, settings=SETTINGS, **options):
    return replay(logs, tmp_path / "out.timemap.mcap", settings, **options)


@pytest.mark.parametrize("log_later_ns", [0, 40 * DAY_NS])
def test_times_count_from_the_first_scan_whenever_it_was_logged(tmp_path, log_later_ns):
    log = standing_log(tmp_path / "a.mcap", log_later_ns=log_later_ns)
    summary = replayed(tmp_path, log, start="+2s", end="end-3s")
    assert summary.dropped == {"outside_time": 20 + 31}  # the end itself, 6.9 s, is out
    assert not summary.data_lost


def test_a_bare_span_is_the_last_of_the_recording_and_a_bare_number_is_refused(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    assert replayed(tmp_path, log, start="3s").dropped == {"outside_time": 69}  # 6.9 s to 9.9 s are in
    assert replayed(tmp_path, log, start="2023-11-14T22:13Z", force=True).scans_used == 100
    with pytest.raises(UsageError, match="'10' alone is nanoseconds since 1970"):
        replayed(tmp_path, log, start="10", force=True)


def test_an_empty_stretch_of_time_is_refused(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    with pytest.raises(UsageError, match=r"--start \+5s is not before --end \+5s") as raised:
        replayed(tmp_path, log, start="+5s", end="+5s")
    assert raised.value.hint == "the recordings go from 2023-11-14T22:13:20Z to 2023-11-14T22:13:29.9Z"
    assert list(tmp_path.iterdir()) == [log]


def test_a_replay_that_used_no_scan_fails_and_leaves_no_file(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    with pytest.raises(TimemapError, match="no scan could be used: outside_time 100"):
        replayed(tmp_path, log, start="+60s")
    with pytest.raises(UsageError, match=r"outside_time 100 \(--start \+60s\)") as raised:
        replayed(tmp_path, log, start="+60s")
    assert raised.value.hint == "the recordings go from 2023-11-14T22:13:20Z to 2023-11-14T22:13:29.9Z"
    blind = standing_log(tmp_path / "b.mcap", hole=True)
    with pytest.raises(TimemapError, match="no scan could be used: node_not_seen 100"):
        replayed(tmp_path, blind)
    assert sorted(tmp_path.iterdir()) == [log, blind]


def test_stamps_that_begin_anew_are_told(tmp_path):
    first = standing_log(tmp_path / "a.mcap")
    again = standing_log(tmp_path / "b.mcap", start_ns=START_NS + 1, log_later_ns=DAY_NS)
    assert not [w for w in replayed(tmp_path, first).warnings if "begin before" in w]
    summary = replayed(tmp_path, first, again, force=True)
    assert [w for w in summary.warnings if "begin before" in w]
    assert summary.scans_used == 200


def test_a_half_life_that_the_window_cannot_keep_is_told(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    level = {
        "name": "slow",
        "window": 100,
        "half_life": "1s",
    }  # 7 places of the window each scan, and 1 can be had
    settings = load(None, {"levels": [level], "gate": NO_GATE})
    found = replayed(tmp_path, log, settings=settings).warnings
    assert [w for w in found if "level slow forgets more slowly than its half-life says" in w]
    assert not replayed(tmp_path, log, force=True).warnings


def test_too_many_dropped_scans_are_told_with_their_reasons(tmp_path):
    blind = standing_log(tmp_path / "b.mcap", start_ns=START_NS + 10**10, hole=True)
    logs = [standing_log(tmp_path / "a.mcap"), blind]
    summary = replayed(tmp_path, *logs)
    assert summary.data_lost
    assert summary.warnings == (
        "50 % of the scans were dropped (node_not_seen 100), more than input.max_dropped allows (5 %)",
    )
    allowed = load(None, {"input": {"max_dropped": 0.5}})
    summary = replayed(tmp_path, *logs, settings=allowed, force=True)
    assert (summary.data_lost, summary.warnings) == (False, ())


def test_a_recording_of_which_the_cut_left_nothing_is_said_to_be_cut_off(tmp_path):
    log = write_bag(tmp_path / "a.bag", drive(ROS1, 200), "bz2", chunk_bytes=10**9)
    log.write_bytes(log.read_bytes()[: log.read_bytes().index(b"BZh") + 100])
    with pytest.raises(UsageError, match=r"no laser scans in .*a\.bag: it is cut off at byte \d+ of \d+"):
        replayed(tmp_path, log)


def test_scans_that_were_not_wanted_are_not_lost(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    assert not replayed(tmp_path, log, start="+9s").data_lost


def test_what_is_odd_and_costs_no_data_is_told_and_done(tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    standing_log(folder / "run_0.mcap")
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: [")
    summary = replayed(tmp_path, folder)
    assert not summary.data_lost
    assert summary.warnings == (f"{folder}: metadata.yaml cannot be read; all files beside it are",)


def test_a_profile_with_other_numbers_is_told(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    settings = load(None, {"profile": "paper", "map": {"radius": 4}})
    assert replayed(tmp_path, log, settings=settings).warnings == (
        "profile paper with other numbers than its own: map.radius 4.0 instead of 1.5",
    )


def test_a_map_frame_that_the_robot_carries_is_told(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    carried = replayed(tmp_path, log, settings=load(None, {"input": {"map_frame": "base_link"}}))
    assert carried.warnings == (
        "'laser' never moves in 'base_link': that frame moves with the robot, and so would the map",
    )
    assert replayed(tmp_path, log, force=True).warnings == ()


def test_nodes_that_are_nowhere_near_are_named(tmp_path):
    log, nodes = standing_log(tmp_path / "a.mcap"), tmp_path / "nodes.csv"
    nodes.write_text("900 900\n")
    with pytest.raises(UsageError, match=r"no_node 100 \(--nodes .*nodes\.csv: none is near") as raised:
        replayed(tmp_path, log, nodes=nodes)
    assert "'map'" in raised.value.hint


def test_nodes_that_are_nowhere_near_are_named_where_some_scans_have_no_pose(tmp_path):
    log, nodes = standing_log(tmp_path / "a.mcap"), tmp_path / "nodes.csv"
    nodes.write_text("900 900\n")
    lost = standing_log(tmp_path / "b.mcap", start_ns=START_NS + DAY_NS, world="elsewhere")
    with pytest.raises(UsageError, match=r"no_node 100, no_pose 100 \(--nodes .*: none is near"):
        replayed(tmp_path, log, lost, nodes=nodes)


def test_scans_that_contradict_what_was_long_held_are_counted_as_lost_and_told(tmp_path):
    logs = [
        standing_log(tmp_path / "a.mcap"),
        standing_log(tmp_path / "b.mcap", start_ns=START_NS + DAY_NS, wall=2.8),
    ]
    summary = replayed(tmp_path, *logs, settings=load(None, {"gate": NO_GATE}))
    assert (summary.scans_read, summary.scans_used, summary.dropped) == (200, 100, {"lost": 100})
    assert summary.data_lost
    assert [
        w for w in summary.warnings if "100 scans contradict nearly all that their place has long been" in w
    ]
    off = load(None, {"gate": NO_GATE | {"max_contradiction": 1}})
    summary = replayed(tmp_path, *logs, settings=off, force=True)
    assert (summary.scans_used, summary.dropped, summary.warnings) == (200, {}, ())


def test_nodes_of_another_frame_are_refused(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    nodes = tmp_path / "nodes.timemap.mcap"
    replay([standing_log(tmp_path / "b.mcap", world="odom")], nodes, SETTINGS)
    with pytest.raises(UsageError, match="stand in 'odom', the poses are in 'map'"):
        replayed(tmp_path, log, nodes=nodes)


def test_recordings_that_end_together_write_the_maps_once(tmp_path):
    logs = [standing_log(tmp_path / f"{name}.mcap") for name in "ab"]
    summary = replayed(tmp_path, *logs)
    assert summary.dropped == {"duplicate": 100}
    assert not summary.data_lost
    with ResultReader(summary.result) as reader:
        assert len(list(reader._file.messages(["/timemap/mid/map"], None))) == 1


def test_the_parts_of_a_drive_write_the_maps_once_each(tmp_path):
    logs = [standing_log(tmp_path / f"{i}.mcap", start_ns=START_NS + i * 10**10) for i in range(3)]
    summary = replayed(tmp_path, *logs)
    with ResultReader(summary.result) as reader:
        assert len(list(reader._file.messages(["/timemap/mid/map"], None))) == 3


def test_a_scan_recorded_twice_is_not_lost(tmp_path):
    logs = [standing_log(tmp_path / f"{name}.mcap") for name in "ab"]
    summary = replayed(tmp_path, *logs)
    assert (summary.scans_used, summary.dropped, summary.data_lost) == (100, {"duplicate": 100}, False)


def test_scans_of_before_1970_are_counted(tmp_path):
    log = standing_log(tmp_path / "a.mcap", start_ns=-2_000_000_000, log_later_ns=START_NS)
    summary = replayed(tmp_path, log)
    assert (summary.scans_used, summary.dropped) == (80, {"malformed": 20})


def two_scanner_log(path, n_scans=300):
    """Two scanners in turn, on a robot that drives 3 m/s along a wall and so makes nodes quickly."""
    edges = [(START_NS, "base_link", frame, (0, 0, 0.2, *STILL)) for frame in ("front", "rear")]
    messages = [Message("/tf_static", START_NS, transforms(ROS2, *edges))]
    shape = {"angle_min": float(BEARINGS[0]), "angle_increment": float(np.radians(1.0))}
    for i in range(n_scans):
        now = START_NS + i * 50_000_000
        messages.append(
            Message("/tf", now, transforms(ROS2, (now, "map", "base_link", (0, 0.15 * i, 0, *STILL))))
        )
        frame = ("front", "rear")[i % 2]
        ranges = (2.0 + i % 2 / 10) / np.cos(BEARINGS)
        messages.append(Message(f"/{frame}", now, scan(ROS2, now, ranges, frame, **shape)))
    return write_mcap(path, messages)


def test_small_blocks_are_learnt_together_and_it_does_not_show(tmp_path, monkeypatch):
    log = two_scanner_log(tmp_path / "a.mcap")
    settings = load(None, {"input": {"scan_topics": ["/front", "/rear"]}, "gate": NO_GATE})
    learnt = []

    def counted(make, items):
        work = make()
        for item in items:
            learnt.extend([len(item)] if isinstance(item, Observations) else [])
            yield work(item)

    monkeypatch.setattr("timemap_cli.replay.mapped", counted)
    together = replayed(tmp_path, log, settings=settings)
    assert learnt == [128, 128, 44]
    content = together.result.read_bytes()
    monkeypatch.setattr("timemap_cli.stages.LEAST_SCANS", 1)
    apart = replayed(tmp_path, log, settings=settings, force=True)
    assert learnt[3:] == [1] * 300
    assert together.nodes > 30
    assert apart.result.read_bytes() == content


def test_a_level_of_the_last_observation_changes_nothing_of_the_others_nor_of_the_events(tmp_path):
    log = ROOT / "sample_logs" / "patrol_monday.mcap"
    levels = [
        {"name": one.name, "window": one.window, "half_life": str(one.half_life)} for one in SETTINGS.levels
    ]
    with_now = load(None, {"levels": [{"name": "now", "window": 1, "half_life": "1obs"}, *levels]})
    plain = replay([log], tmp_path / "plain.timemap.mcap", SETTINGS).result
    more = replay([log], tmp_path / "more.timemap.mcap", with_now).result
    with ResultReader(plain) as one, ResultReader(more) as other:
        assert one.changes == other.changes
        for level in one.levels:
            assert digests(one, level) == digests(other, level)
        assert {estimate.samples.max() for estimate in other.estimates("now").values()} == {1}


def digests(reader, level):
    return {node: found.ranges.tobytes() for node, found in reader.estimates(level).items()}
