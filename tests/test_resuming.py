"""A replay that goes on from an earlier result gives what a replay of all recordings in one go gives."""

import shutil
import sqlite3
from itertools import pairwise

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Reader as BagReader
from rosbags.rosbag1 import Writer as BagWriter

from sample_logs.laser import Mount
from tests.cases.test_untrusted_poses import resetting
from tests.conftest import ROOT, shared_data
from tests.logs.recorded import START_NS, Message, write_mcap
from tests.simulated import in_order, moving, scanner, scans, stamp, static
from tests.test_replay import standing_log
from timemap_cli.config import load
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.replay import replay
from timemap_cli.results import channels, writer
from timemap_cli.results.channels import LevelTopic
from timemap_cli.results.container import ResultFile
from timemap_cli.results.reader import ResultReader
from timemap_cli.results.state_messages import Part
from timemap_cli.resuming import Earlier

SETTINGS = load(None)
SAMPLES = [ROOT / "sample_logs" / n for n in ("patrol_monday.mcap", "patrol_tuesday.bag", "patrol_thursday")]
DAY_NS = 86_400_000_000_000
SMALL = {"step_deg": 12.0, "beams": 30}


def one_after_the_other(tmp_path, logs, settings=SETTINGS):
    result = None
    for number, log in enumerate(logs):
        resumed, result = result, tmp_path / f"{number}.timemap.mcap"
        replay([log], result, settings, resume=resumed)
    return result


def in_one_go(tmp_path, logs, settings=SETTINGS):
    return replay(logs, tmp_path / "whole.timemap.mcap", settings).result


def plain(state):
    """A state in a form that can be compared, to the bit."""
    return {
        name: (value.dtype.str, value.shape, value.tobytes()) if isinstance(value, np.ndarray) else value
        for name, value in state.items()
    }


def end_of(path):
    """All that a result says of the end: nodes, estimates, maps, changes, and what a later replay needs."""
    with ResultReader(path) as result, ResultFile(path) as file:
        estimates = {
            (level, node): plain(estimate.kept())
            for level in result.levels
            for node, estimate in result.estimates(level).items()
        }
        maps = {
            topic.of(level): file.last_message(topic.of(level))
            for level in result.levels
            for topic in (LevelTopic.POINTS, LevelTopic.MAP)
        }
        state = {(kept.part, kept.node): plain(kept.state) for kept in result.state()}
        return result.nodes, estimates, maps, result.changes, state


def assert_same_end(one, other):
    for mine, theirs in zip(end_of(one), end_of(other), strict=True):
        assert mine == theirs


def test_days_in_three_formats_resumed_are_the_days_in_one_go(tmp_path):
    resumed = one_after_the_other(tmp_path, SAMPLES)
    assert_same_end(resumed, in_one_go(tmp_path, SAMPLES))
    with ResultReader(resumed) as result:
        assert len(result.changes["events"]) > 2


def test_a_recording_cut_within_its_drive_is_the_recording_in_one_go(tmp_path):
    parts = cut_mcap(SAMPLES[0], tmp_path, [0.31, 0.64])
    assert_same_end(one_after_the_other(tmp_path, parts), in_one_go(tmp_path, parts))


def test_seconds_and_the_papers_profile_go_on_too(tmp_path):
    overrides = {
        "profile": "paper",
        "estimate": {"every": "50obs"},
        "levels": [
            {"name": "fast", "window": 5, "half_life": "4s"},
            {"name": "slow", "window": 30, "half_life": "60s"},
        ],
    }
    settings, parts = load(None, overrides), cut_mcap(SAMPLES[0], tmp_path, [0.2, 0.4])[:2]
    assert_same_end(one_after_the_other(tmp_path, parts, settings), in_one_go(tmp_path, parts, settings))


def test_intel_cut_in_three_formats_is_intel_in_one_go(tmp_path):
    cuts = [0.33, 0.71]
    parts = [
        cut_mcap(shared_data("intel/intel.mcap"), tmp_path, cuts)[0],
        cut_bag(shared_data("intel/intel.bag"), tmp_path, cuts)[1],
        cut_db3(next(shared_data("intel/intel_db3").glob("*.db3")), tmp_path, cuts)[2],
    ]
    assert_same_end(one_after_the_other(tmp_path, parts), in_one_go(tmp_path, parts))
    with ResultReader(tmp_path / "whole.timemap.mcap") as result:
        assert result.report["scans"]["used"] == 910


def test_the_wean_runs_resumed_are_the_runs_in_one_go(tmp_path):
    runs = [shared_data(f"wean/{name}") for name in ("wean_run1.bag", "wean_run3.mcap", "wean_run4.mcap")]
    assert_same_end(one_after_the_other(tmp_path, runs), in_one_go(tmp_path, runs))


def test_a_resumed_result_holds_the_whole_map_and_only_its_own_time(tmp_path):
    first, second = (
        standing_log(tmp_path / f"{n}.mcap", n_scans=900, start_ns=n * 200 * DAY_NS) for n in (1, 2)
    )
    one = replay([first], tmp_path / "one.timemap.mcap", SETTINGS)
    two = replay([second], tmp_path / "two.timemap.mcap", SETTINGS, resume=one.result)
    assert (two.scans_read, two.scans_used, dict(two.dropped)) == (900, 900, {})
    assert not any("Foxglove" in warning for warning in two.warnings)
    with ResultReader(two.result) as result:
        assert 400 * DAY_NS <= result.start_ns <= result.end_ns < 400 * DAY_NS + 91 * 10**9
        assert set(result.estimates("long", result.start_ns)) == {0}
        assert result.metadata["resumed_from"].startswith('{"name": "one.timemap.mcap", "sha256": "')


def test_the_result_does_not_grow_from_day_to_day(tmp_path):
    result, sizes = None, []
    for day in range(6):
        log = standing_log(tmp_path / f"{day}.mcap", n_scans=300, start_ns=(day + 1) * DAY_NS)
        resumed, result = result, tmp_path / f"{day}.timemap.mcap"
        replay([log], result, SETTINGS, resume=resumed)
        sizes.append(result.stat().st_size)
    assert sizes[-1] < 1.05 * sizes[2]


def test_settings_that_differ_are_refused_by_name(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    one = replay([log], tmp_path / "one.timemap.mcap", SETTINGS).result
    levels = [
        {"name": "short", "window": 7, "half_life": "5obs"},
        {"name": "slow", "window": 9, "half_life": "9obs"},
    ]
    for overrides, said in [
        ({"seed": 3}, "seed 3 instead of 0"),
        ({"map": {"radius": 5}}, "map.radius 5.0 instead of 10.0"),
        ({"levels": levels}, "levels.long.window none instead of 100"),
        ({"input": {"no_return": "ignore"}}, "input.no_return ignore instead of auto"),
        ({"input": {"scan_topics": ["/front"]}}, r"input.scan_topics \[/front\] instead of \[/scan\]"),
    ]:
        with pytest.raises(UsageError, match=said):
            replay([log], tmp_path / "two.timemap.mcap", load(None, overrides), resume=one)
    assert not (tmp_path / "two.timemap.mcap").exists()


def test_what_was_found_or_changes_nothing_may_be_stated(tmp_path):
    log, later = standing_log(tmp_path / "a.mcap"), standing_log(tmp_path / "b.mcap", start_ns=2 * 10**18)
    one = replay([log], tmp_path / "one.timemap.mcap", SETTINGS).result
    stated = load(None, {"input": {"scan_topics": ["/scan"], "poses": "tf", "max_dropped": 0.5}})
    replay([later], tmp_path / "two.timemap.mcap", stated, resume=one)


def test_a_mount_that_only_the_first_day_tells_holds_on_the_second(tmp_path):
    first = standing_log(tmp_path / "a.mcap")
    later = standing_log(tmp_path / "b.mcap", start_ns=2 * 10**18)
    bare = copied(later, tmp_path / "bare.mcap", lambda topic, _: topic != "/tf_static")
    with pytest.raises(UsageError, match="laser"):
        replay([bare], tmp_path / "alone.timemap.mcap", SETTINGS)
    one = replay([first], tmp_path / "one.timemap.mcap", SETTINGS).result
    assert replay([bare], tmp_path / "two.timemap.mcap", SETTINGS, resume=one).scans_used == 100


def test_a_result_of_a_timemap_that_kept_other_things_is_refused(tmp_path, monkeypatch):
    log = standing_log(tmp_path / "a.mcap")
    monkeypatch.setattr(writer.state_messages, "FORMAT", "timemap.state/0")
    old = replay([log], tmp_path / "old.timemap.mcap", SETTINGS).result
    with pytest.raises(
        TimemapError, match=r"holds timemap\.state/0 of timemap .* which reads timemap\.state/3"
    ):
        Earlier.of(old)


def test_what_is_known_already_is_refused_and_may_be_cut_off(tmp_path):
    log = standing_log(tmp_path / "a.mcap", n_scans=600)
    one = replay([log], tmp_path / "one.timemap.mcap", SETTINGS, end="+30s").result
    with pytest.raises(
        UsageError, match=r"begin at 2023-11-14T22:13:20Z, before .*one\.timemap\.mcap ends"
    ) as raised:
        replay([log], tmp_path / "two.timemap.mcap", SETTINGS, resume=one)
    assert raised.value.hint is not None
    begin = raised.value.hint.rpartition("--start ")[2]
    assert begin == "2023-11-14T22:13:50Z"
    two = replay([log], tmp_path / "two.timemap.mcap", SETTINGS, resume=one, start=begin).result
    assert_same_end(two, replay([log], tmp_path / "whole.timemap.mcap", SETTINGS).result)


@pytest.mark.parametrize("cut", ["+4s", "+24s"])
def test_two_drives_cut_anywhere_go_on_with_the_rest_of_both(tmp_path, cut):
    """Within the first, and within the second, for which the laser was mounted elsewhere."""
    lasers = scanner(**SMALL), scanner(Mount(-0.2, 0, 0.2, 90.0), **SMALL)
    logs = []
    for made, begin, end in zip(lasers, (0, 19), (8, 32), strict=True):
        parts = [m for m in in_order(moving(), scans(made)) if stamp(begin) <= m.log_ns < stamp(end)]
        mount = Message("/tf_static", stamp(begin), static((made, "laser")).content)
        logs.append(write_mcap(tmp_path / f"{begin}.mcap", [mount, *parts]))
    settings = load(None, {"input": {"no_return": "ignore"}})
    one = replay(logs, tmp_path / "one.timemap.mcap", settings, end=cut).result
    two = replay(logs, tmp_path / "two.timemap.mcap", settings, start=cut, resume=one).result
    assert_same_end(two, in_one_go(tmp_path, logs, settings))


def test_given_nodes_stay_all_there_are(tmp_path):
    places = tmp_path / "nodes.csv"
    places.write_text("2 2\n8 2\n5 5\n")
    first, second, _ = cut_mcap(SAMPLES[0], tmp_path, [0.3, 0.6])
    one = replay([first], tmp_path / "one.timemap.mcap", SETTINGS, nodes=places).result
    two = replay([second], tmp_path / "two.timemap.mcap", SETTINGS, resume=one).result
    whole = replay([first, second], tmp_path / "whole.timemap.mcap", SETTINGS, nodes=places).result
    assert_same_end(two, whole)
    assert len(end_of(two)[0]) == 3


def test_a_scanner_may_be_silent_on_a_later_day(tmp_path):
    front, rear = scanner(Mount(0.3, 0, 0.2, 0.0), **SMALL), scanner(Mount(-0.3, 0, 0.2, 180.0), **SMALL)
    both = scans(front, "/front", "front"), scans(rear, "/rear", "rear", begin=0.55)
    messages = in_order([static((front, "front"), (rear, "rear"))], moving(), *both)
    begun = [one for one in messages if one.log_ns < stamp(8)]
    heard = [one for one in begun if one.topic != "/rear" or not stamp(3) < one.log_ns < stamp(6)]
    settings = load(None, {"input": {"scan_topics": ["/front", "/rear"]}})
    parts = cut_messages(heard, tmp_path, [3.5, 5.5])
    assert_same_end(one_after_the_other(tmp_path, parts, settings), in_one_go(tmp_path, parts, settings))


def test_three_cuts_around_a_jump_leave_out_the_same_scans_though_one_part_has_no_map_frame(tmp_path):
    """Corrections come every 0.25 s: the third part has none, and the fourth goes on with those of the second."""
    laser = scanner(**SMALL)
    messages = in_order([static((laser, "laser"))], resetting(11.3, 0.7), scans(laser))
    parts = cut_messages(messages, tmp_path, [11.1, 11.38, 11.5])
    whole = replay(parts, tmp_path / "whole.timemap.mcap", SETTINGS)
    assert whole.dropped["pose_jump"] > 0
    assert_same_end(one_after_the_other(tmp_path, parts), whole.result)


def test_nodes_that_are_new_on_the_second_day_are_counted_at_its_first_estimates(tmp_path):
    laser, settings = scanner(**SMALL), load(None, {"estimate": {"every": "10000obs"}})
    messages = in_order([static((laser, "laser"))], moving(), scans(laser))
    one, _, two = cut_messages(messages, tmp_path, [8, 19])
    assert_same_end(
        one_after_the_other(tmp_path, [one, two], settings), in_one_go(tmp_path, [one, two], settings)
    )


def test_a_day_that_renews_no_estimate_has_the_maps_of_the_day_before(tmp_path):
    levels = [{"name": n, "window": 3, "half_life": f"{h}obs"} for n, h in (("a", 40), ("b", 400))]
    days = [
        standing_log(tmp_path / f"{day}.mcap", n, START_NS + day * DAY_NS) for day, n in ((0, 200), (1, 1))
    ]
    settings = load(None, {"levels": levels})
    resumed = one_after_the_other(tmp_path, days, settings)
    assert_same_end(resumed, in_one_go(tmp_path, days, settings))
    with ResultFile(resumed) as file:
        assert file.last_message(LevelTopic.MAP.of("a")) is not None


def test_a_day_without_the_frame_of_the_map_is_refused_and_leaves_nothing(tmp_path):
    one = replay([standing_log(tmp_path / "a.mcap")], tmp_path / "one.timemap.mcap", SETTINGS).result
    odometry = standing_log(tmp_path / "b.mcap", start_ns=START_NS + DAY_NS, world="odom")
    with pytest.raises(TimemapError, match="no scan could be used: no_pose 100") as raised:
        replay([odometry], tmp_path / "two.timemap.mcap", SETTINGS, resume=one)
    assert raised.value.hint == f"{odometry} has no poses in 'map' for /scan"
    assert not (tmp_path / "two.timemap.mcap").exists()


def test_an_earlier_day_is_refused_also_where_the_last_recording_had_no_scans(tmp_path):
    log, later = (standing_log(tmp_path / f"{d}.mcap", start_ns=START_NS + d * DAY_NS) for d in (0, 1))
    silent = copied(later, tmp_path / "silent.mcap", lambda topic, _: topic != "/scan")
    with pytest.raises(UsageError, match="no laser scans in"):
        replay(
            [silent],
            tmp_path / "two.timemap.mcap",
            SETTINGS,
            resume=replay([log], tmp_path / "o", SETTINGS).result,
        )
    one = replay([log, silent], tmp_path / "one.timemap.mcap", SETTINGS).result
    earlier = standing_log(tmp_path / "earlier.mcap", start_ns=START_NS - DAY_NS)
    with pytest.raises(UsageError, match=r"before .*one\.timemap\.mcap ends \(2023-11-14T22:13:29\.9Z\)"):
        replay([earlier], tmp_path / "two.timemap.mcap", SETTINGS, resume=one)


def test_a_recording_or_nothing_cannot_be_resumed(tmp_path):
    log = standing_log(tmp_path / "a.mcap")
    for path in (log, tmp_path / "absent.timemap.mcap"):
        with pytest.raises(UsageError):
            replay([log], tmp_path / "two.timemap.mcap", SETTINGS, resume=path)
    assert sorted(tmp_path.iterdir()) == [log]


def test_every_part_of_the_state_stands_once_and_nodes_one_by_one(tmp_path):
    result = replay(SAMPLES[:1], tmp_path / "one.timemap.mcap", SETTINGS).result
    with ResultReader(result) as reader:
        parts = [(kept.part, kept.node) for kept in reader.state()]
        nodes = [(Part.NODE, number) for number in range(len(reader.nodes))]
        assert parts == [(Part.READING, 0), (Part.LEARNING, 0), (Part.CHANGES, 0), *nodes]
        assert reader.count(channels.STATE_TOPIC) == len(parts)


def cut_messages(messages, folder, cuts):
    """Recordings of messages, cut at so many seconds."""
    times = [0, *map(stamp, cuts), 2**62]
    return [
        write_mcap(folder / f"part{i}.mcap", [one for one in messages if begin <= one.log_ns < end])
        for i, (begin, end) in enumerate(pairwise(times))
    ]


def borders(start_ns, end_ns, cuts):
    return [start_ns, *(start_ns + int((end_ns - start_ns) * cut) for cut in cuts), end_ns + 1]


def copied(source, target, wanted):
    """An MCAP file with those messages that are wanted, by topic and log time."""
    with source.open("rb") as file, target.open("wb") as out:
        mcap = McapWriter(out)
        mcap.start(profile="ros2", library="test")
        schemas, topics = {}, {}
        for schema, channel, message in make_reader(file).iter_messages():
            if not wanted(channel.topic, message.log_time):
                continue
            if schema.name not in schemas:
                schemas[schema.name] = mcap.register_schema(schema.name, schema.encoding, schema.data)
            if channel.topic not in topics:
                topics[channel.topic] = mcap.register_channel(
                    channel.topic, channel.message_encoding, schemas[schema.name], channel.metadata
                )
            mcap.add_message(topics[channel.topic], message.log_time, message.data, message.publish_time)
        mcap.finish()
    return target


def cut_mcap(source, folder, cuts):
    with source.open("rb") as file:
        statistics = make_reader(file).get_summary().statistics
    times = borders(statistics.message_start_time, statistics.message_end_time, cuts)
    return [
        copied(source, folder / f"part{begin}.mcap", lambda _, now, begin=begin, end=end: begin <= now < end)
        for begin, end in pairwise(times)
    ]


def cut_bag(source, folder, cuts):
    parts = []
    with BagReader(source) as reader:
        for begin, end in pairwise(borders(reader.start_time, reader.end_time - 1, cuts)):
            parts.append(folder / f"part{begin}.bag")
            with BagWriter(parts[-1]) as out:
                new = {
                    one.id: out.add_connection(
                        one.topic, one.msgtype, msgdef=one.msgdef.data, md5sum=one.digest
                    )
                    for one in reader.connections
                }
                for connection, now, raw in reader.messages():
                    if begin <= now < end:
                        out.write(new[connection.id], now, raw)
    return parts


def cut_db3(source, folder, cuts):
    parts = []
    with sqlite3.connect(f"file:{source}?mode=ro", uri=True) as whole:
        ends = whole.execute("SELECT min(timestamp), max(timestamp) FROM messages").fetchone()
    for begin, end in pairwise(borders(*ends, cuts)):
        parts.append(folder / f"part{begin}.db3")
        shutil.copy(source, parts[-1])
        parts[-1].chmod(0o644)
        with sqlite3.connect(parts[-1]) as part:
            part.execute("DELETE FROM messages WHERE timestamp < ? OR timestamp >= ?", (begin, end))
    return parts
