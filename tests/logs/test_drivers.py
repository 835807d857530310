"""What drivers write where a return is missing: each is found out from the recording, told, and gives the same map.

A robot drives through a room whose far side is open, and through one whose far side is of glass: through the glass a
beam comes back head-on only, so missing returns pass through what other beams show to be solid.
"""

import json
from dataclasses import dataclass

import numpy as np
import pytest

from sample_logs.laser import Mount
from sample_logs.robot import drive
from sample_logs.world import World, wall
from tests.cli.program import timemap
from tests.logs.recorded import ROS2, Message, scan, transforms, write_mcap
from tests.simulated import in_order, numbers, scanner, stamp, static
from timemap_cli.results.reader import ResultReader

INF, NAN = np.inf, np.nan
WAY = drive([(1.5, 2.0), (3.0, 2.0)], 0.4, 1.0)
SIDES = [wall((0, 0), (5, 0)), wall((0, 0), (0, 4)), wall((0, 4), (5, 4))]
OPEN = World(np.concatenate(SIDES))
GLASS = World(np.concatenate(SIDES), glass=np.array([[4.0, 0.0, 4.0, 4.0]]))
LASER = scanner(Mount(0, 0, 0.2, 0), first_deg=-90.0, beams=181, range_max=8.0, sweep_time=0.0)


@dataclass(frozen=True)
class Driver:
    """What it writes for a missing return, and how `info` puts it; `None` as range_max: the largest of each scan."""

    code: float
    found: str
    range_max: float | None = 8.0
    is_return: bool = True  # False: no evidence, whatever the room
    step: float = 0.0  # [m] by which range_max, and a code that is finite, grow from scan to scan


OWN = "the scanner's own code"
DRIVERS = {
    "plus_inf": Driver(INF, "no return: inf (REP 117)"),
    "nan": Driver(NAN, "invalid: nan (no evidence)", is_return=False),
    "zero": Driver(0.0, "invalid: 0 (no evidence)", is_return=False),
    "range_max": Driver(8.0, "no return: 8 m (range_max, in SHARE % of the beams)"),
    "range_max_plus_1": Driver(9.0, "no return: 9 m (beyond range_max 8 m, in SHARE % of the beams)"),
    "65.533": Driver(65.533, f"no return: 65.533 m ({OWN})"),
    "81.91": Driver(81.91, f"no return: 81.91 m ({OWN})"),
    "range_max_that_changes_with_every_scan": Driver(
        8.0, "range_max differs from scan to scan and stands for a missing return", step=0.01
    ),
    "inf_and_range_max_is_the_largest_of_each_scan": Driver(INF, "no return: inf (REP 117)", range_max=None),
    "81.91_and_range_max_is_the_largest_range_of_each_scan": Driver(
        81.91, f"no return: 81.91 m ({OWN})", range_max=None
    ),
}


def recording(path, driver, world):
    """Scans ten times a second; also how many beams come back and how many do not."""
    starts = np.arange(0.3, WAY.duration - 0.3, 0.1)
    true = LASER.scan(world, WAY, starts, np.random.default_rng(0)).astype(np.float64)
    shape = {"angle_min": -np.pi / 2, "angle_max": np.pi / 2, "angle_increment": np.pi / 180}
    parts = [static((LASER, "laser"))]
    for i, (at, row) in enumerate(zip(starts.tolist(), true, strict=True)):
        grown = driver.step * i
        ranges = np.where(np.isfinite(row), row, driver.code + grown)
        largest = row[np.isfinite(row)].max() if driver.range_max is None else driver.range_max + grown
        edge = stamp(at), "map", "base_link", numbers(WAY.at(np.array(at)))
        content = scan(ROS2, stamp(at), ranges, range_max=float(largest), time_increment=0.0, **shape)
        parts += [Message("/tf", stamp(at), transforms(ROS2, edge)), Message("/scan", stamp(at) + 1, content)]
    write_mcap(path, in_order(parts))
    missing = int(np.count_nonzero(np.isinf(true)))
    return true.size - missing, missing


def with_settings(path):
    """A radius that is well within what each driver's missing returns free."""
    path.with_name("settings.yaml").write_text("map: {radius: 2.5}\n")
    return "--config", path.with_name("settings.yaml")


def told(path):
    """What `info` prints, and its JSON."""
    settings = with_settings(path)
    return timemap("info", path, *settings).out, json.loads(timemap("info", path, *settings, "--json").out)


def mapped(path):
    """Estimates (nodes, bins) of the slowest level."""
    result = path.with_suffix(".timemap.mcap")
    ran = timemap("replay", path, "-o", result, *with_settings(path), "--force", "--quiet")
    assert (ran.code, ran.err) == (0, "")
    with ResultReader(result) as reader:
        return np.stack([one.ranges for one in reader.estimates("long").values()])


def reference(tmp_path_factory, name, world):
    path = tmp_path_factory.mktemp("drivers") / "log.mcap"
    recording(path, DRIVERS[name], world)
    return mapped(path)


@pytest.fixture(scope="module")
def open_room(tmp_path_factory):
    """The map of the driver that does as REP 117 says."""
    return reference(tmp_path_factory, "plus_inf", OPEN)


@pytest.fixture(scope="module")
def behind_glass(tmp_path_factory):
    """The map of the driver whose missing returns never are evidence."""
    return reference(tmp_path_factory, "nan", GLASS)


@pytest.mark.parametrize("driver", DRIVERS.values(), ids=DRIVERS)
def test_in_an_open_room_a_missing_return_is_found_and_is_free_space(tmp_path, driver, open_room):
    path = tmp_path / "open.mcap"
    hits, missing = recording(path, driver, OPEN)
    text, found = told(path)
    (topic,) = found["logs"][0]["scans"]
    share = f"{100 * missing / (hits + missing):.2g}"
    assert driver.found.replace("SHARE", share) in topic["found"]
    assert f"\n              {driver.found.replace('SHARE', share)}\n" in text
    largest = "range_max is the largest range of each scan: not used"
    assert (largest in topic["found"]) == (driver.range_max is None)
    assert topic["beams"]["hit"] == hits
    assert topic["beams"]["no_return" if driver.is_return else "invalid"] == missing
    assert found["no_return"] == "clear"
    assert ("  no return  free space: 0 % of those sampled pass" in text) == driver.is_return
    assert ("  no return  there is none\n" in text + "\n") != driver.is_return
    ranges = mapped(path)
    if driver.is_return:
        np.testing.assert_array_equal(ranges, open_room)
    else:
        ahead = [*range(10), *range(350, 360)]  # of the last node, in the middle of the open side
        assert np.isnan(ranges[-1, ahead]).all()
        assert np.isinf(open_room[-1, ahead]).all()
        walls = np.isfinite(ranges) & np.isfinite(open_room)
        assert walls.sum() > 0.9 * np.isfinite(open_room).sum()
        np.testing.assert_array_equal(ranges[walls], open_room[walls])


@pytest.mark.parametrize("driver", DRIVERS.values(), ids=DRIVERS)
def test_behind_glass_a_missing_return_is_no_evidence(tmp_path, driver, behind_glass):
    path = tmp_path / "glass.mcap"
    recording(path, driver, GLASS)
    text, found = told(path)
    assert found["no_return"] == ("ignore" if driver.is_return else "clear")
    assert ("pass through something solid (glass, mirrors, black surfaces)" in text) == driver.is_return
    np.testing.assert_array_equal(mapped(path), behind_glass)
