"""Scans whose poses are not to be trusted do not come out, however the recording is read."""

import numpy as np
import pytest

from tests.logs.making import FakeRecording, scans, tf
from tests.logs.test_pose_quality import stated
from timemap_cli.logs import stream
from timemap_cli.logs.beams import Beams
from timemap_cli.logs.pose_quality import PoseLimits
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.stream import ScanCounts, sweeps
from timemap_cli.model.sweeps import Sweeps

BEAMS = Beams(0.1, 30.0, False, 30.0, True, ())
LIMITS = PoseLimits(0.5, 0.3, 0.5)


def corrections(start, stop):
    """map -> odom every second; at every fourth it moves by 1 m."""
    seconds = np.arange(start, stop)
    return tf("map", "odom", seconds, np.stack([seconds // 4, 0 * seconds, 0 * seconds], axis=1))


def odometry(start, stop):
    return tf("odom", "laser", np.arange(start, stop, 0.25), [[0, 0, 0]])


def uncertain(start, stop):
    """Every fifth second but one, 0.6 m."""
    seconds = np.arange(start, stop)
    return stated(seconds, np.where(seconds % 5 == 1, 0.6, 0.1))


def replayed(lists, limits=LIMITS, pose="tf"):
    counts = ScanCounts()
    chosen = Selection(("/scan",), "map", pose, covariances="/amcl_pose")
    out = sweeps([FakeRecording(lists)], chosen, {(0, "/scan"): BEAMS}, counts, limits=limits)
    blocks = [block for block in out if isinstance(block, Sweeps)]
    return [stamp / 1e9 for block in blocks for stamp in block.stamps_ns.tolist()], counts


def recording(start, stop):
    return [
        corrections(start, stop),
        odometry(start, stop),
        uncertain(start, stop),
        scans(np.arange(start + 0.5, stop)),
    ]


def expected(stop, jump=range(3, 1000, 4), doubt=(0, 1)):
    """Of the scans at every half second: not those within a jump, nor beside an uncertain pose."""
    return [at + 0.5 for at in range(stop - 1) if at not in jump and at % 5 not in doubt]


def test_scans_within_a_jump_or_of_an_uncertain_pose_are_counted_by_reason():
    out, counts = replayed([recording(0, 21)])
    assert out == expected(21)
    # After the last transform there is no pose. Of the jumps at 3, 7, 11, 15 and 19 two are uncertain as well.
    assert counts.dropped == {"no_pose": 1, "uncertain_pose": 8, "pose_jump": 3}
    assert counts.read == 21


def test_without_limits_nothing_is_set_aside():
    out, counts = replayed([recording(0, 21)], PoseLimits())
    assert out == expected(21, jump=(), doubt=())
    assert counts.dropped == {"no_pose": 1}


def test_poses_of_a_topic_are_judged_alike():
    lists = [[uncertain(0, 21), scans(np.arange(0.5, 20))]]
    out, counts = replayed(lists, pose="/amcl_pose")
    assert out == expected(21, jump=())
    assert counts.dropped == {"uncertain_pose": 8}


@pytest.mark.parametrize("size", [1, 3, 60])
@pytest.mark.parametrize("least", [1, 17])
def test_what_is_set_aside_does_not_depend_on_how_the_recording_is_read(monkeypatch, size, least):
    whole, counts = replayed([recording(0, 60)])
    monkeypatch.setattr(stream, "LEAST_SCANS", least)
    in_parts, counts_in_parts = replayed([recording(at, min(60, at + size)) for at in range(0, 60, size)])
    assert in_parts == whole == expected(60)
    assert counts_in_parts == counts


def test_after_a_long_pause_of_the_localiser_its_last_word_holds():
    lists = [
        [corrections(0, 3), odometry(0, 40), stated([0, 1], [0.1, 0.6])],
        [tf("map", "odom", [12, 22, 32], [[0, 0, 0]]), scans([2.5, 13, 25])],
    ]
    assert replayed(lists)[0] == []
    assert replayed(lists, PoseLimits(0.7))[0] == [2.5, 13, 25]
