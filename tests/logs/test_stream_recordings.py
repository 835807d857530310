"""The stream on real recordings."""

from contextlib import ExitStack
from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import shared_data
from timemap_cli.logs import rigid
from timemap_cli.logs.beams import Beams
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.stream import EndOfRecording, ScanCounts, Waiting, sweeps

BEAMS = Beams(0.02, 79.0, False, 79.0, True, ())


def replayed(*names, topic="/scan", frame="map", pose="tf"):
    paths = [shared_data(name) for name in names]
    counts = ScanCounts()
    with ExitStack() as stack:
        recordings = [stack.enter_context(recording) for recording in open_recordings(paths)]
        beams = {(index, topic): BEAMS for index in range(len(recordings))}
        came = sweeps(recordings, Selection((topic,), frame, pose), beams, counts)
        return [one for one in came if not isinstance(one, Waiting)], counts


def joined(out, name):
    return np.concatenate([getattr(block, name) for block in out if not isinstance(block, EndOfRecording)])


def end_points(out):
    """Ends (k, 2) [m] of all beams that hit, from the pose at the first beam."""
    bearings, ranges = out[0].bearings, joined(out, "ranges").astype(float)
    row, beam = np.nonzero(np.isfinite(ranges))
    distance, bearing = ranges[row, beam], bearings[beam]
    ends = np.stack([distance * np.cos(bearing), distance * np.sin(bearing), 0 * distance], axis=-1)
    return rigid.apply(joined(out, "map_from_laser_first")[row], ends[:, None])[:, 0, :2]


def test_one_recording_in_three_formats_is_the_same_to_the_last_bit():
    outs = [replayed(name) for name in ("intel/intel.mcap", "intel/intel.bag", "intel/intel_db3")]
    for name in ("stamps_ns", "ranges", "map_from_laser_first", "map_from_laser_last"):
        assert len({joined(out, name).tobytes() for out, _ in outs}) == 1
    assert all((counts.read, counts.dropped) == (910, {}) for _, counts in outs)


def test_a_pose_topic_gives_the_same_as_the_transforms_made_of_it():
    by_tf, _ = replayed("intel/intel.mcap")
    by_topic, counts = replayed("intel/intel.mcap", pose="/pose")
    assert counts.dropped == {}
    np.testing.assert_allclose(
        joined(by_topic, "map_from_laser_first"), joined(by_tf, "map_from_laser_first"), atol=1e-9
    )


def test_recordings_given_in_any_order_are_replayed_one_after_the_other():
    names = [f"wean/wean_run{run}.mcap" for run in (4, 1, 3)]
    out, counts = replayed(*names)
    assert [item.recording for item in out if isinstance(item, EndOfRecording)] == [0, 1, 2]
    assert (np.diff(joined(out, "stamps_ns")) > 0).all()
    assert (counts.read, counts.dropped) == (2554, {})


@pytest.mark.parametrize(
    ("name", "topic", "frame", "used", "dropped"),
    [
        (
            "bham_pioneer/trace1.bag",
            "/base_scan",
            "map",
            904,
            {"no_pose": 2},
        ),  # the mount's first stamp is later
        ("olin_mac1", "/scan", "odom", 356, {"no_pose": 1}),
    ],
)
def test_hardly_a_scan_is_lost(name, topic, frame, used, dropped):
    out, counts = replayed(name, topic=topic, frame=frame)
    assert len(joined(out, "stamps_ns")) == used
    assert counts.dropped == dropped


def filled_cells(points):
    return len(np.unique(np.floor(points / 0.05).astype(int), axis=0))


def test_walls_are_crisp():
    out, _ = replayed("intel/intel.mcap")
    crisp = filled_cells(end_points(out))
    for wrong in (-1, 1):
        turned = [replace(block, bearings=block.bearings + np.radians(wrong)) for block in out[:-1]]
        assert crisp < 0.9 * filled_cells(end_points(turned))
    mirrored = [replace(block, bearings=-block.bearings) for block in out[:-1]]
    assert crisp < 0.3 * filled_cells(end_points(mirrored))
