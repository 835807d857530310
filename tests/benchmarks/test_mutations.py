"""Twins of a recording with one mistake each: what the mistakes do, and that a check catches them."""

import math

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from benchmarks.mutations.judging import judge, make_baseline
from benchmarks.mutations.mistakes import (
    every_scan_missing,
    laser_shifted,
    laser_turned,
    minute_missing,
    missing_returns_as,
    noise,
    scans_stamped_late,
)
from benchmarks.mutations.rewriting import rewrite
from benchmarks.mutations.simulated import simulated
from benchmarks.mutations.table import table
from tests.conftest import ROOT

LOG = ROOT / "sample_logs" / "patrol_monday.mcap"
SCANS = 2049


def messages(path, topic):
    with AnyReader([path]) as reader:
        chosen = [one for one in reader.connections if one.topic == topic]
        return [reader.deserialize(raw, one.msgtype) for one, _, raw in reader.messages(chosen)]


@pytest.fixture
def twin_of(tmp_path):
    def twin(change):
        rewrite(LOG, tmp_path / "twin.mcap", change)
        return tmp_path / "twin.mcap"

    return twin


def laser(path):
    (static,) = messages(path, "/tf_static")
    return static.transforms[0].transform


def test_a_recording_rewritten_without_a_change_holds_the_same_messages(twin_of):
    one, other = messages(LOG, "/scan"), messages(twin_of(lambda message, _: message), "/scan")
    assert len(one) == len(other) == SCANS
    assert all(
        np.array_equal(a.ranges, b.ranges) and a.header == b.header for a, b in zip(one, other, strict=True)
    )


def test_a_laser_turned_by_a_degree_has_a_yaw_of_a_degree_more(twin_of):
    q = laser(twin_of(laser_turned(1.0))).rotation
    before = laser(LOG).rotation
    assert math.degrees(2 * math.atan2(q.z, q.w)) - math.degrees(2 * math.atan2(before.z, before.w)) == (
        pytest.approx(1.0)
    )


def test_a_shifted_laser_sits_elsewhere_on_the_robot(twin_of):
    before, after = laser(LOG).translation, laser(twin_of(laser_shifted(0.05, -0.02))).translation
    assert (after.x - before.x, after.y - before.y, after.z - before.z) == pytest.approx((0.05, -0.02, 0.0))


def test_a_missing_minute_takes_all_that_was_logged_in_it(twin_of):
    path = twin_of(minute_missing(60.0))
    missing = SCANS - len(messages(path, "/scan"))
    assert missing == pytest.approx(60 / 0.208, abs=2)
    with AnyReader([path]) as reader:
        since = [(log_ns - reader.start_time) / 1e9 for _, log_ns, _ in reader.messages()]
    assert not [second for second in since if 60.0 <= second < 120.0]


def test_late_stamps_are_those_of_the_scans_alone(twin_of):
    path = twin_of(scans_stamped_late(0.1))
    stamps = [
        [one.header.stamp.sec * 10**9 + one.header.stamp.nanosec for one in messages(log, "/scan")]
        for log in (LOG, path)
    ]
    assert {late - right for right, late in zip(*stamps, strict=True)} == {100_000_000}
    tf = [[one.transforms[0].header.stamp for one in messages(log, "/tf")] for log in (LOG, path)]
    assert tf[0] == tf[1]


def test_every_tenth_scan_goes_missing(twin_of):
    assert len(messages(twin_of(every_scan_missing(10)), "/scan")) == SCANS - SCANS // 10


def test_missing_returns_become_the_code_and_hits_stay(twin_of):
    before, after = (
        np.stack([scan.ranges for scan in messages(log, "/scan")])
        for log in (LOG, twin_of(missing_returns_as(9.5)))
    )
    missing = np.isinf(before)
    assert (after[missing] == 9.5).all()
    assert np.array_equal(after[~missing], before[~missing])


def test_noise_is_as_large_as_it_says_and_leaves_missing_returns(twin_of):
    before, after = (
        np.stack([scan.ranges for scan in messages(log, "/scan")]) for log in (LOG, twin_of(noise(0.01, 1)))
    )
    hit = np.isfinite(before)
    assert (after[hit] - before[hit]).std() == pytest.approx(0.01, rel=0.02)
    assert np.isinf(after[~hit]).all()


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    folder = tmp_path_factory.mktemp("clean")
    simulated(folder / "simulated.mcap", rounds=1)
    make_baseline(folder / "simulated.mcap", folder / "simulated.yaml")
    return folder


def judged(clean, name, log):
    return judge(name, log, clean / "simulated.yaml")


def test_other_noise_alone_passes(clean, tmp_path):
    simulated(tmp_path / "simulated.mcap", rounds=1, seed=5)
    row = judged(clean, "noise", tmp_path / "simulated.mcap")
    assert [one.text for one in row.verdict.failures] == []
    assert row.worst.value <= row.worst.allowed


def test_a_moved_object_is_caught_and_its_place_told(clean, tmp_path):
    simulated(tmp_path / "simulated.mcap", rounds=1, moved="machine", by=(-0.15, 0.0))
    row = judged(clean, "machine moved", tmp_path / "simulated.mcap")
    assert row.worst.name == "ranges.places"
    places = [(spot.x, spot.y) for one in row.verdict.failures for spot in one.spots if one is row.worst]
    assert any(math.dist(place, (11.2, 2.3)) < 0.8 for place in places)  # 0.9 m wide, seen from one side


@pytest.mark.parametrize(
    ("change", "caught", "cause"),
    [(laser_turned(1.0), "map.turn", "yaw"), (every_scan_missing(10), "scans.read", "fewer scans")],
)
def test_mistakes_are_caught_and_their_cause_is_told_first(clean, tmp_path, change, caught, cause):
    rewrite(clean / "simulated.mcap", tmp_path / "simulated.mcap", change)
    row = judged(clean, "mistake", tmp_path / "simulated.mcap")
    assert caught in [one.name for one in row.verdict.failures]
    assert cause in row.told
    assert "**caught**" in table("Twins", [row])
