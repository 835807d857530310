"""A stream that goes on where another one stopped is the stream of all recordings in one go."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.logs.making import FakeRecording, ns, poses, scans, tf
from timemap_cli.logs import drive_stream
from timemap_cli.logs.beams import Beams
from timemap_cli.logs.coming import EndOfRecording, Resumed, ScanCounts, Waiting
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.stream import sweeps
from timemap_cli.model.sweeps import Sweeps
from timemap_cli.results.state_messages import Part, StatePart, pack_state, unpack_state

BEAMS = Beams(0.1, 30.0, False, 30.0, True, ())
MOUNT = tf("base", "laser", [0], [[0.5, 0, 0]], static=True)


def driving(seconds):
    """The robot drives along x at 1 m/s."""
    return tf("map", "base", seconds, np.stack([seconds, 0 * seconds, 0 * seconds], axis=1))


def streamed(*recordings, earlier=None, pose="tf", **span):
    topics = ("/front", "/rear")
    beams = {(index, topic): BEAMS for index in range(len(recordings)) for topic in topics}
    selection = Selection(topics, "map", pose)
    return list(sweeps(recordings, selection, beams, ScanCounts(), earlier=earlier, **span))


def through_a_file(state):
    """The state as a result gives it back."""
    return unpack_state(pack_state(StatePart(Part.READING, 0, state), 0, "map")).state


def kept(out):
    (waiting,) = (one.state for one in out if isinstance(one, Waiting))
    return through_a_file(waiting)


def told(out):
    """What comes out: for every scan, all that is known of it, and where recordings end."""
    rows = []
    for one in out:
        if isinstance(one, EndOfRecording):
            rows.append("end")
        elif isinstance(one, Sweeps):
            fixed = (one.scanner, one.clear_range, one.bearings.tobytes())
            arrays = (one.stamps_ns, one.ranges, one.map_from_laser_first, one.map_from_laser_last)
            rows += [(*fixed, *(part.tobytes() for part in row)) for row in zip(*arrays, strict=True)]
    return rows


def plain(state):
    """A state in a form that can be compared, to the bit."""
    return {
        name: value.tobytes() if isinstance(value, np.ndarray) else value for name, value in state.items()
    }


def before_the_end(out):
    """What had come out when all had been read."""
    return told(out[: next(i for i, one in enumerate(out) if isinstance(one, Waiting))])


def parts(cuts, batches):
    """One recording cut at log times [s] into several; static transforms stay in the first."""
    borders = [-np.inf, *sorted(cuts), np.inf]
    found = []
    for begin, end in pairwise(borders):
        some = [_between(batch, begin, end) for batch in batches]
        lists = [[batch] for batch in some if len(batch.stamps_ns)]
        if lists:
            found.append(FakeRecording([[*(one for batch in lists for one in batch)]]))
    return found


def _between(batch, begin, end):
    rows = (batch.log_ns >= begin * 1e9) & (batch.log_ns < end * 1e9)
    names = [name for name in batch.__slots__ if isinstance(getattr(batch, name), np.ndarray)]
    return type(batch)(
        **{
            name: getattr(batch, name)[rows] if name in names else getattr(batch, name)
            for name in batch.__slots__
        }
    )


def assert_resumed_is_continuous(recordings, **options):
    whole = streamed(*recordings, **options)
    out, state = [], None
    for recording in recordings:
        new = streamed(recording, earlier=state, **options)
        out += before_the_end(new)
        state = kept(new)
    out += told(new[next(i for i, one in enumerate(new) if isinstance(one, Waiting)) :])
    assert out == told(whole)
    assert plain(state) == plain(kept(whole))


@settings(max_examples=25)
@given(
    cuts=st.lists(st.floats(0.5, 39.5), min_size=1, max_size=3, unique=True),
    late=st.lists(st.sampled_from([0.0, 0.03, 0.4, 3.0]), min_size=80, max_size=80),
)
def test_a_recording_that_is_cut_anywhere_goes_on(cuts, late):
    front, rear = np.arange(0, 40, 0.5), np.arange(0.2, 40, 0.7)
    batches = [
        MOUNT,
        driving(np.arange(0, 41, 0.3)),
        scans(front, topic="/front", log=front + late, increment=0.05),
        scans(rear, topic="/rear"),
    ]
    assert_resumed_is_continuous(parts(cuts, batches))


@pytest.mark.parametrize("gap", [1.0, 9.0, 11.0, 3600.0])
def test_another_drive_begins_after_a_gap(gap):
    first = np.arange(0, 30, 0.5)
    later = first + 30 + gap
    recordings = [
        FakeRecording([[MOUNT, driving(first), scans(first + 0.1, topic="/front")]]),
        FakeRecording([[driving(later), scans(later + 0.1, topic="/front")]]),
    ]
    assert_resumed_is_continuous(recordings)


def test_a_mount_that_a_later_recording_tells_anew_holds_for_its_own_drive_only():
    seconds = np.arange(0, 20, 0.5)
    turned = tf("base", "laser", [0], [[-0.5, 0, 0]], static=True)
    days = [seconds + 1000 * day for day in range(3)]
    statics = [[MOUNT], [turned], []]
    recordings = [
        FakeRecording([[*static, driving(day), scans(day, topic="/front")]])
        for static, day in zip(statics, days, strict=True)
    ]
    assert_resumed_is_continuous(recordings)


def test_a_scanner_that_is_silent_for_more_than_a_minute_over_the_cut_is_silent_in_both():
    seconds, later = np.arange(0, 20, 0.5), np.arange(82, 130, 0.5)
    first = [[MOUNT, driving(seconds), scans(seconds, topic="/front")], [driving(np.arange(20, 75, 0.5))]]
    second = [[driving(later), scans(later, topic="/front")]]
    assert_resumed_is_continuous([FakeRecording(first), FakeRecording(second)])


def test_frames_told_in_another_order_make_no_other_state():
    camera = tf("head", "camera", [0], [[0.0, 0, 1]], static=True)
    recordings = [
        FakeRecording([[*static, driving(day), scans(day, topic="/front")]])
        for static, day in (
            ([MOUNT, camera], np.arange(0, 20, 0.5)),
            ([camera, MOUNT], np.arange(20, 40, 0.5)),
        )
    ]
    assert_resumed_is_continuous(recordings)


def test_poses_of_a_topic_go_on_too():
    seconds = np.arange(0, 30, 0.4)
    batches = [
        MOUNT,
        poses("/amcl", "map", seconds, np.stack([seconds, 0 * seconds, 0 * seconds], axis=1), child="base"),
        scans(seconds + 0.1, topic="/front"),
    ]
    assert_resumed_is_continuous(parts([11.0, 19.5], batches), pose="/amcl")


def test_what_an_earlier_replay_left_comes_before_the_word_that_new_scans_begin():
    seconds = np.arange(0, 30, 0.5)
    first = FakeRecording([[MOUNT, driving(seconds), scans(seconds, topic="/front")]])
    state = kept(streamed(first))
    out = streamed(
        FakeRecording([[driving(seconds + 99), scans(seconds + 99, topic="/front")]]), earlier=state
    )
    begins = next(i for i, one in enumerate(out) if isinstance(one, Resumed))
    old = [int(one.stamps_ns.max()) for one in out[:begins] if isinstance(one, Sweeps)]
    assert max(old) == ns(29.5)[0]
    assert isinstance(out[begins - 1], EndOfRecording)


def test_a_recording_cut_by_its_span_goes_on_with_the_rest_of_itself():
    seconds = np.arange(0, 60, 0.5)
    whole = FakeRecording([[MOUNT, driving(seconds), scans(seconds, topic="/front")]])
    cut_ns = int(ns(30)[0])
    first = streamed(whole, end_ns=cut_ns)
    rest = streamed(whole, start_ns=cut_ns, earlier=kept(first))
    assert before_the_end(first) + told(rest) == told(streamed(whole))


def test_the_state_is_small_however_long_the_recording_is(monkeypatch):
    monkeypatch.setattr(drive_stream, "LEAST_SCANS", 8)
    seconds = np.arange(0, 4000, 0.5)
    lists = [[driving(part), scans(part, topic="/front")] for part in np.split(seconds, 100)]
    state = kept(streamed(FakeRecording([[MOUNT], *lists])))
    assert len(state["window.stamp"]) <= 30
    assert sum(value.nbytes for value in state.values() if isinstance(value, np.ndarray)) < 20_000
