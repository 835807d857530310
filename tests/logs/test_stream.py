import itertools
from dataclasses import replace

import numpy as np
import pytest

from tests.logs.making import FakeRecording, ns, scans, tf, yaw
from tests.logs.making import poses as pose_batch
from timemap_cli.logs import drive_stream
from timemap_cli.logs.batches import BadBatch
from timemap_cli.logs.beams import Beams
from timemap_cli.logs.coming import EndOfRecording, ScanCounts, Waiting
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.stream import sweeps

BEAMS = Beams(0.1, 30.0, False, 30.0, True, ())
MOUNT = tf("base", "laser", [0], [[0.5, 0, 0]], static=True)


def driving(start, stop, step=0.5):
    """The robot drives along x at 1 m/s."""
    seconds = np.arange(start, stop + step / 2, step)
    return tf("map", "base", seconds, np.stack([seconds, 0 * seconds, 0 * seconds], axis=1))


def replayed(*recordings, topics=("/scan",), pose="tf", map_frame="map", beams=BEAMS, **span):
    counts = ScanCounts()
    every = {(index, topic): beams for index in range(len(recordings)) for topic in topics}
    came = sweeps(recordings, Selection(topics, map_frame, pose), every, counts, **span)
    out = [one for one in came if not isinstance(one, Waiting)]
    dropped = sum(counts.dropped.values())
    assert counts.read == dropped + sum(len(block) for block in out if not isinstance(block, EndOfRecording))
    return out, counts


def blocks(out):
    return [block for block in out if not isinstance(block, EndOfRecording)]


def seconds(out):
    return [stamp / 1e9 for block in blocks(out) for stamp in block.stamps_ns.tolist()]


def test_scans_come_out_with_poses_and_resolved_ranges():
    batch = scans([1, 2], first=[5, 31])
    out, counts = replayed(FakeRecording([[MOUNT, driving(0, 3), batch]]))
    (block,) = blocks(out)
    np.testing.assert_array_equal(block.ranges, np.array([[5, 2, 2], [np.inf, 2, 2]], np.float32))
    np.testing.assert_allclose(block.map_from_laser_first[:, 0, 3], (1.5, 2.5))
    np.testing.assert_array_equal(block.map_from_laser_last, block.map_from_laser_first)
    np.testing.assert_allclose(block.bearings, (-0.5, -0.25, 0))
    assert (block.clear_range, block.scanner) == (30.0, 0)
    assert (out[-1], counts.read, counts.dropped) == (EndOfRecording(0), 2, {})


def test_the_pose_of_the_last_beam_is_that_of_its_time():
    out, _ = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1, 2], increment=0.05)]]))
    np.testing.assert_allclose(blocks(out)[0].map_from_laser_last[:, 0, 3], (1.6, 2.6), atol=1e-8)


def test_beams_stored_last_to_first_have_a_negative_time():
    out, _ = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1, 2], increment=-0.05)]]))
    np.testing.assert_allclose(blocks(out)[0].map_from_laser_last[:, 0, 3], (1.4, 2.4), atol=1e-8)


@pytest.mark.parametrize("increment", [np.nan, np.inf, 100.0])
def test_a_time_per_beam_that_cannot_be_is_not_used(increment):
    out, _ = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1, 2], increment=increment)]]))
    np.testing.assert_allclose(blocks(out)[0].map_from_laser_last[:, 0, 3], (1.5, 2.5))


def test_scans_out_of_order_within_the_window_come_out_in_order():
    log = np.arange(0, 8)
    out, counts = replayed(FakeRecording([[MOUNT, driving(0, 60)]] + [
        [scans([stamp], log=[at])] for at, stamp in zip(log, [20, 22, 21, 12.0, 30, 20.5, 40, 41], strict=True)
    ]))  # fmt: skip
    assert seconds(out) == [12, 20, 20.5, 21, 22, 30, 40, 41]
    assert counts.dropped == {}


def test_what_comes_more_than_10_s_behind_is_late():
    stamps = [20, 40, 30, 29.999, 41, 30.5]
    out, counts = replayed(FakeRecording([[MOUNT, driving(0, 60), scans(stamps, log=np.arange(6))]]))
    assert seconds(out) == [20, 30, 40, 41]
    assert counts.dropped == {"late": 2}


def test_transforms_may_come_later_than_the_scan():
    late = tf("map", "base", [0, 5], [[0, 0, 0], [5, 0, 0]], log=[9, 9])
    out, counts = replayed(FakeRecording([[MOUNT, scans([1, 2])], [scans([8.5])], [late], [scans([15])]]))
    assert seconds(out) == [1, 2]
    assert counts.dropped == {"no_pose": 2}


def test_scans_without_a_pose_are_counted():
    out, counts = replayed(FakeRecording([[MOUNT, driving(1, 3), scans([0.5, 1, 3, 3.5])]]))
    assert seconds(out) == [1, 3]
    assert counts.dropped == {"no_pose": 2}


def test_static_transforms_count_wherever_they_stand_and_whatever_the_time_window():
    recording = FakeRecording(
        [[driving(0, 6), scans([1, 2, 3, 4])], [tf("base", "laser", [99], [[2, 0, 0]], static=True)]]
    )
    out, counts = replayed(recording, start_ns=int(ns(2)[0]), end_ns=int(ns(4)[0]))
    assert seconds(out) == [2, 3]
    np.testing.assert_allclose(blocks(out)[0].map_from_laser_first[:, 0, 3], (4, 5))
    assert counts.dropped == {"outside_time": 2}


def test_reading_stops_when_the_end_is_past_the_window():
    lists = [[MOUNT, driving(0, 2), scans([1, 2])], *([scans([at])] for at in range(3, 100))]
    out, counts = replayed(FakeRecording(lists), end_ns=int(ns(2)[0]))
    assert seconds(out) == [1]
    assert out[-1] == EndOfRecording(0)
    assert counts.read == 12


@pytest.mark.parametrize("size", [1, 7, 100])
def test_what_counts_as_read_up_to_the_end_does_not_depend_on_the_reading(size):
    stamps = np.arange(100.0)
    stamps[50] = 3  # late, and after the end of reading
    lists = [
        [
            driving(at, min(at + size, 100) - 0.5),
            scans(stamps[at : at + size], log=np.arange(at, min(at + size, 100))),
        ]
        for at in range(0, 100, size)
    ]
    out, counts = replayed(FakeRecording([[MOUNT], *lists]), end_ns=int(ns(20)[0]))
    assert seconds(out) == list(range(20))
    assert (counts.read, counts.dropped) == (31, {"outside_time": 11})  # the scan at 30 s ends it


def test_stamps_before_1970_are_malformed():
    out, counts = replayed(FakeRecording([[MOUNT, driving(-5, 3), scans([-2, 1, -1, 2], log=[1, 2, 3, 4])]]))
    assert seconds(out) == [1, 2]
    assert counts.dropped == {"malformed": 2}


def test_a_scan_beyond_what_its_recording_can_hold_does_not_make_the_others_late():
    log = FakeRecording([[MOUNT, driving(-5, 5), scans([1, 1e6, 2, 3], log=[1, 2, 3, 4])]])
    out, counts = replayed(log, latest_ns={0: int(ns(100)[0])})
    assert seconds(out) == [1, 2, 3]
    assert counts.dropped == {"ahead": 1}


@pytest.mark.parametrize(("again", "reason"), [(7, "duplicate"), (8, "same_stamp")])
def test_of_equal_stamps_of_one_topic_the_first_scan_stays_and_the_other_is_the_same_or_lost(again, reason):
    out, counts = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1, 1, 2], first=[7, again, 9])]]))
    assert blocks(out)[0].ranges[:, 0].tolist() == [7, 9]
    assert counts.dropped == {reason: 1}


def test_unknown_ranges_are_the_same_and_later_copies_and_other_layouts_are_not():
    blind = np.full((2, 3), np.nan, np.float32)
    twice = FakeRecording([[MOUNT, driving(0, 3), replace(scans([1, 1]), ranges=blind)]])
    assert replayed(twice)[1].dropped == {"duplicate": 1}
    late = FakeRecording([[MOUNT, driving(0, 9), scans([1, 1], first=[7, 7], log=[1, 4])]])
    assert replayed(late)[1].dropped == {"same_stamp": 1}
    wider = FakeRecording([[MOUNT, driving(0, 3), scans([1]), scans([1], count=5)]])
    assert replayed(wider)[1].dropped == {"same_stamp": 1}


def test_overlapping_recordings_are_merged_and_share_transforms():
    a = FakeRecording([[scans([1, 3])], [scans([5, 7])]])
    b = FakeRecording([[MOUNT, driving(0, 9)], [scans([2, 3, 6])]])
    out, counts = replayed(a, b)
    assert seconds(out) == [1, 2, 3, 5, 6, 7]
    assert counts.dropped == {"duplicate": 1}
    assert out[-1] == EndOfRecording(0)
    assert out[out.index(EndOfRecording(1)) - 1].stamps_ns.tolist()[-1:] == ns(6).tolist()


def test_a_recording_that_follows_at_once_continues_the_drive():
    a = FakeRecording([[MOUNT, driving(0, 4, 1.0), scans([1, 4.5])]])
    b = FakeRecording([[driving(5, 9), scans([5.5, 6])]])
    out, counts = replayed(a, b)
    assert seconds(out) == [1, 4.5, 5.5, 6]
    assert [type(item).__name__ for item in out] == ["Sweeps", "EndOfRecording", "Sweeps", "EndOfRecording"]
    assert counts.dropped == {}


def ends(out):
    return [item.recording for item in out if isinstance(item, EndOfRecording)]


def test_every_recording_of_a_drive_ends_once():
    parts = [
        FakeRecording([[MOUNT, driving(at, at + 39.5), scans(np.arange(at, at + 39))]]) for at in (0, 40, 80)
    ]
    out, _ = replayed(*parts)
    assert ends(out) == [0, 1, 2]
    assert [seconds(out[: out.index(EndOfRecording(number))])[-1] for number in range(3)] == [38, 78, 118]


def test_recordings_that_are_not_read_to_their_end_end_once():
    parts = [
        FakeRecording([[MOUNT, driving(at, at + 39.5), scans(np.arange(at, at + 39))]]) for at in (0, 40, 80)
    ]
    out, _ = replayed(*parts, end_ns=int(ns(50)[0]))
    assert ends(out) == [0, 1, 2]
    assert seconds(out)[-1] == 49


def test_recordings_apart_have_their_own_moving_transforms_and_mounts():
    other_mount = tf("base", "laser", [100], [[0.7, 0, 0]], static=True)
    a = FakeRecording([[MOUNT, driving(0, 4), scans([1])]])
    b = FakeRecording([[other_mount, driving(100, 104), scans([101])]])
    c = FakeRecording([[driving(200, 204), scans([201, 1], log=[201, 202])]])
    out, counts = replayed(a, b, c)
    places = [block.map_from_laser_first[0, 0, 3] for block in blocks(out)]
    # c has no mount of its own: that of the first recording that has one
    np.testing.assert_allclose(places, (1.5, 101.7, 201.5))
    assert [item.recording for item in out if isinstance(item, EndOfRecording)] == [0, 1, 2]
    assert counts.dropped == {"late": 1}


def test_scanners_come_in_blocks_of_their_own_and_keep_their_mounts():
    mounts = [tf("base", f, [0], [[x, 0, 0]], static=True) for f, x in (("front", 1), ("rear", -1))]
    front = scans([1, 2, 3], topic="/front", frame="/front")
    rear = scans([1, 2.5], topic="/rear", frame="rear")
    out, counts = replayed(FakeRecording([[*mounts, driving(0, 4), rear, front]]), topics=("/front", "/rear"))
    assert seconds(out) == [1, 1, 2, 2.5, 3]
    assert [block.scanner for block in blocks(out)] == [0, 1, 0, 1, 0]
    places = [x for block in blocks(out) for x in block.map_from_laser_first[:, 0, 3]]
    np.testing.assert_allclose(places, (2, 0, 3, 1.5, 4))
    assert counts.dropped == {}


def test_scans_of_other_layout_come_in_blocks_of_their_own():
    out, _ = replayed(FakeRecording([[MOUNT, driving(0, 9), scans([1, 2, 5]), scans([3, 4], count=4)]]))
    assert [block.ranges.shape for block in blocks(out)] == [(2, 3), (2, 4), (1, 3)]


def test_what_cannot_be_decoded_is_counted():
    bad = [BadBatch("/scan", "malformed", 3), BadBatch("/tf", "malformed", 4)]
    _, counts = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1]), *bad]]))
    assert (counts.read, counts.dropped, counts.transforms_dropped) == (4, {"malformed": 3}, 4)
    _, counts = replayed(FakeRecording([[MOUNT, driving(0, 3), scans([1], count=0)]]))
    assert counts.dropped == {"malformed": 1}


def test_transforms_that_cannot_be_used_are_counted():
    broken = tf("map", "base", [1], [[0, 0, 0]], [[0, 0, 0, 0]])
    _, counts = replayed(FakeRecording([[MOUNT, driving(0, 3), broken, scans([1])]]))
    assert counts.transforms_dropped == 1


def test_poses_of_a_topic_replace_the_transforms():
    poses = pose_batch("/pose", "map", [0, 4], [[0, 0, 0], [0, 4, 0]], yaw(90))
    out, _ = replayed(
        FakeRecording([[tf("base_link", "laser", [0], [[0.5, 0, 0]], static=True), poses, scans([1, 2])]]),
        pose="/pose",
    )
    np.testing.assert_allclose(blocks(out)[0].map_from_laser_first[:, 1, 3], (1.5, 2.5))


def test_a_recording_without_scans_ends_too():
    out, counts = replayed(FakeRecording([[MOUNT, driving(0, 3)]]))
    assert (out, counts.read) == ([EndOfRecording(0)], 0)


def long_log(lists):
    """300 s of scans at 5 Hz, disordered within a second, read in so many lists."""
    generator = np.random.default_rng(3)
    stamps = np.arange(5, 300, 0.2)
    shuffled = stamps[np.argsort(stamps + generator.uniform(0, 1, len(stamps)))]
    edges = np.linspace(0, 301, lists + 1)
    made = [[MOUNT]]
    for low, high in itertools.pairwise(edges):
        inside = (stamps >= low) & (stamps < high)
        some = [driving(np.ceil(2 * low) / 2, high - 1e-6)] if high > np.ceil(2 * low) / 2 else []
        if inside.any():
            some.append(scans(shuffled[inside], log=stamps[inside], increment=0.01))
        made.append(some)
    return FakeRecording(made)


def everything(out):
    return [
        np.concatenate([getattr(block, name) for block in blocks(out)]).tobytes()
        for name in ("stamps_ns", "ranges", "map_from_laser_first", "map_from_laser_last")
    ]


@pytest.mark.parametrize(("lists", "least", "most"), [(1, 128, 512), (7, 1, 3), (60, 20, 50), (300, 1, 1)])
def test_neither_the_reading_nor_the_size_of_blocks_shows_in_the_outcome(monkeypatch, lists, least, most):
    expected, _ = replayed(long_log(2))
    monkeypatch.setattr(drive_stream, "LEAST_SCANS", least)
    monkeypatch.setattr(drive_stream, "MOST_SCANS", most)
    out, counts = replayed(long_log(lists))
    assert max(len(block) for block in blocks(out)) <= most
    assert everything(out) == everything(expected)
    assert seconds(out) == sorted(seconds(out))
    assert (counts.read, counts.dropped) == (1475, {})


@pytest.mark.parametrize(("lists", "least"), [(3, 128), (50, 1), (300, 7)])
def test_nor_does_it_move_the_ends_of_recordings(monkeypatch, lists, least):
    short = FakeRecording([[scans([20.05, 20.15])], [tf("map", "other", [25], [[0, 0, 0]])]])
    monkeypatch.setattr(drive_stream, "LEAST_SCANS", least)
    out, _ = replayed(long_log(lists), short)
    before = out[: out.index(EndOfRecording(1))]
    assert 20 < seconds(before)[-1] < 20.2
    assert out[-1] == EndOfRecording(0)


def test_memory_does_not_grow_with_the_log(monkeypatch):
    held = []
    let_out = drive_stream.DriveStream._let_out

    def watched(self, until_ns):
        yield from let_out(self, until_ns)
        held.append((len(self._poses._buffer), self._window.nbytes, len(self._window._waiting)))

    monkeypatch.setattr(drive_stream.DriveStream, "_let_out", watched)
    replayed(long_log(100))
    samples, nbytes, waiting = np.max(held, axis=0)
    # 2 transforms and 5 scans a second: the window, a block and two lists
    assert samples < 2 * 60
    assert waiting < 128 + 50 + 30
    assert nbytes < 12 * 400


def test_transforms_do_not_pile_up_while_the_scanner_is_silent(monkeypatch):
    held = []
    let_out = drive_stream.DriveStream._let_out

    def watched(self, until_ns):
        yield from let_out(self, until_ns)
        held.append(len(self._poses._buffer))

    monkeypatch.setattr(drive_stream.DriveStream, "_let_out", watched)
    lists = [
        [MOUNT, scans([1, 2])],
        *([driving(at, at + 9.5)] for at in range(0, 2000, 10)),
        [scans([1990, 1991])],
    ]
    out, _counts = replayed(FakeRecording(lists))
    assert max(held) < 2 * 150
    assert seconds(out) == [1, 2, 1990, 1991]


def test_a_layout_that_differs_from_scan_to_scan_costs_no_memory(monkeypatch):
    held = []
    let_out = drive_stream.DriveStream._let_out

    def watched(self, until_ns):
        yield from let_out(self, until_ns)
        held.append(len(self._window._kinds))

    monkeypatch.setattr(drive_stream.DriveStream, "_let_out", watched)
    lists = [[MOUNT], *([driving(at, at + 1), scans([at], count=2 + at % 500)] for at in range(1000))]
    out, counts = replayed(FakeRecording(lists))
    assert len(seconds(out)) == counts.read == 1000
    assert max(held) < 200
