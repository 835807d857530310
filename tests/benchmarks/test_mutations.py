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


@pytest.fixture(scope="module")
def scans():
    return messages(LOG, "/scan")


def changed(change, scans, log_ns=0):
    return [change(scan, log_ns) for scan in scans]


def laser(change):
    """Where the laser sits on the robot, before and after a change."""
    (static,) = messages(LOG, "/tf_static")
    return static.transforms[0].transform, change(static, 0).transforms[0].transform


def stamp_ns(scan):
    return scan.header.stamp.sec * 10**9 + scan.header.stamp.nanosec


def test_a_recording_rewritten_without_a_change_holds_the_same_scans(scans, tmp_path):
    rewrite(LOG, tmp_path / "twin.mcap", lambda message, _: message)
    twins = messages(tmp_path / "twin.mcap", "/scan")
    assert len(twins) == len(scans) == SCANS
    assert [stamp_ns(twin) for twin in twins] == [stamp_ns(scan) for scan in scans]
    assert all(np.array_equal(a.ranges, b.ranges) for a, b in zip(scans, twins, strict=True))


def test_messages_that_a_change_drops_are_not_written(tmp_path):
    rewrite(LOG, tmp_path / "twin.mcap", minute_missing(60.0))
    with AnyReader([tmp_path / "twin.mcap"]) as reader:
        since = [(log_ns - reader.start_time) / 1e9 for _, log_ns, _ in reader.messages()]
    assert not [second for second in since if 60.0 <= second < 120.0]
    assert max(since) > 400


def test_a_laser_turned_by_a_degree_has_a_yaw_of_a_degree_more():
    before, after = (
        math.degrees(2 * math.atan2(t.rotation.z, t.rotation.w)) for t in laser(laser_turned(1.0))
    )
    assert after - before == pytest.approx(1.0)


def test_a_shifted_laser_sits_elsewhere_on_the_robot():
    before, after = (t.translation for t in laser(laser_shifted(0.05, -0.02)))
    assert (after.x - before.x, after.y - before.y, after.z - before.z) == pytest.approx((0.05, -0.02, 0.0))


def test_late_stamps_are_those_of_the_scans_alone(scans):
    late = changed(scans_stamped_late(0.1), scans)
    assert {stamp_ns(b) - stamp_ns(a) for a, b in zip(scans, late, strict=True)} == {100_000_000}
    (static,) = messages(LOG, "/tf_static")
    assert scans_stamped_late(0.1)(static, 0) is static


def test_every_tenth_scan_goes_missing(scans):
    thinned = changed(every_scan_missing(10), scans)
    assert [number for number, scan in enumerate(thinned) if scan is None] == list(range(9, SCANS, 10))


def test_missing_returns_become_the_code_and_hits_stay(scans):
    coded = changed(missing_returns_as(9.5), scans)
    before, after = (np.stack([scan.ranges for scan in some]) for some in (scans, coded))
    missing = np.isinf(before)
    assert (after[missing] == 9.5).all()
    assert np.array_equal(after[~missing], before[~missing])


def test_noise_is_as_large_as_it_says_and_leaves_missing_returns(scans):
    noisy = changed(noise(0.01, 1), scans)
    before, after = (np.stack([scan.ranges for scan in some]) for some in (scans, noisy))
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
