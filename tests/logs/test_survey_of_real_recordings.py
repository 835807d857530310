"""What is found out about real recordings; each of them gives an answer or one clear error."""

from contextlib import ExitStack

import pytest

from tests.conftest import shared_data
from timemap_cli.config import load
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.inspect import inspect
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.survey import survey
from timemap_cli.reports.info_json import info_json
from timemap_cli.reports.info_text import info_text

SETTINGS = load(None)
INTEL = ("intel/intel.mcap", "intel/intel.bag", "intel/intel_db3")
WEAN = ("wean/wean_run1.mcap", "wean/wean_run3.mcap", "wean/wean_run4.mcap")


def surveyed(*names):
    with ExitStack() as stack:
        recordings = [
            stack.enter_context(recording)
            for recording in open_recordings([shared_data(name) for name in names])
        ]
        return survey(recordings, SETTINGS)


def inspected(name):
    return inspect([shared_data(name)], SETTINGS)


@pytest.mark.parametrize("name", INTEL)
def test_intel_has_missing_returns_that_are_no_evidence(name):
    found = surveyed(name)
    assert (found.selection.scan_topics, found.selection.map_frame, found.selection.pose) == (
        ("/scan",),
        "map",
        "tf",
    )
    assert found.no_return == "ignore"
    assert found.contradicted > 0.5
    assert found.beams[0, "/scan"].found == ("no return: 81.83 m (the scanner's own code)",)


def test_the_three_forms_of_intel_are_surveyed_alike():
    one, two, three = (surveyed(name) for name in INTEL)
    assert one.beams == two.beams == three.beams
    assert one.missing_returns == two.missing_returns == three.missing_returns


@pytest.mark.parametrize("names", [*((name,) for name in WEAN), WEAN, WEAN[::2]])
def test_wean_has_missing_returns_that_are_free_space(names):
    found = surveyed(*names)
    assert found.no_return == "clear"
    assert found.contradicted < 0.25
    assert all(beams.no_return_from < 81.83 for beams in found.beams.values())
    assert (found.selection.map_frame, found.problems) == ("map", ())


def test_olin_has_odometry_only():
    found = surveyed("olin_mac1")
    assert (found.selection.map_frame, found.selection.pose) == ("odom", "tf")
    assert len(found.selection.warnings) == 1


def test_bham_has_blind_beams_and_a_jump():
    found = inspected("bham_pioneer/trace1.bag")
    (log,) = found.logs
    (scan,) = log.scans
    assert found.chains == (("map", "odom", "base_link", "laser"),)
    assert scan.beams.too_close / scan.beams.total == pytest.approx(0.073, abs=0.001)
    assert scan.beams.invalid / scan.beams.total == pytest.approx(0.163, abs=0.001)
    assert (scan.count, scan.with_pose) == (906, 904)
    assert log.problems == (
        "/base_scan: the pose jumps once, namely at +3.2 s by 0.40 m and 2 deg within 0.10 s",
    )


def test_a_simulator_without_noise_shows_no_codes():
    (log,) = inspected("edge_cases/basic_localization_stage.bag").logs
    assert log.scans[0].beams.hit == 24 * 1081


def test_a_scanner_in_a_hall_shows_its_range_max():
    (log,) = inspected("edge_cases/pr2_mylaserdata.bag").logs
    assert log.scans[0].beams.no_return == 19808
    assert log.scans[0].found == ("no return: 10 m (range_max, in 97 % of the beams)",)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("csmfail.bag", "neither transforms nor poses"),
        ("laser_scan_matcher_demo.bag", "neither transforms nor poses"),
        ("laser_scan_splitter_demo.bag", "version 1.2"),
        ("mylaserdata.bag", "no laser scans"),
        ("mylaserdata2.bag", "no transform names it"),
        ("mylaserdata3.bag", "no transform names it"),
        ("mylaserdata4.bag", "no transform names it"),
        ("pegatron5F.bag", "neither transforms nor poses"),
        ("robotino_mylaserdata.bag", "no laser scans"),
        ("tf_example.bag", "no laser scans"),
        ("nav2_turtlebot.mcap", "no laser scans"),
        ("scan_today_bag_0.db3", "neither transforms nor poses"),
        ("test_bag_0.db3", "neither transforms nor poses"),
        ("tf_example.db3", "no laser scans"),
        ("map_yaml_with_nan_origin.yaml", "is not a recording"),
    ],
)
def test_a_recording_that_cannot_be_replayed_gives_one_clear_error(name, message):
    with pytest.raises(UsageError, match=message) as caught:
        surveyed(f"edge_cases/{name}")
    assert "\n" not in caught.value.message


EVERYTHING = (*INTEL, *WEAN, "wean/wean_run1.bag", "olin_mac1", "bham_pioneer/trace1.bag", "edge_cases")


def told(log):
    """The text about a recording, or the sentence with which it is refused."""
    try:
        found = inspect([log], SETTINGS)
    except TimemapError as error:
        return error.message
    info_json(found)
    return info_text(found)


def test_every_recording_can_be_inspected_or_is_refused_in_one_sentence():
    for name in EVERYTHING:
        path = shared_data(name)
        for log in sorted(path.iterdir()) if name == "edge_cases" else [path]:
            lines = told(log).splitlines()
            assert str(log) in lines[0]
            assert len(lines) < 25


def test_log_times_far_from_the_stamps_are_told():
    (log,) = inspected("edge_cases/scan_today_bag_0.db3").logs
    assert log.problems == ("/scan: recorded 54.3 years after the stamps (other clock, or played back)",)
