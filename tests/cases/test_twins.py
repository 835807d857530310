"""The same drive, recorded in another way, gives the same map.

Every recording has a plain twin: one upright laser of 360 degrees, counter-clockwise, with an exact transform at
every scan. Both are replayed with the same nodes. What is compared is the share of the angle bins, at each level, in
which one twin knows what the other does not, or in which their ranges differ by more than a tolerance.
"""

import numpy as np
import pytest

from sample_logs.laser import Mount
from tests.logs.recorded import write_mcap
from tests.simulated import (
    NODES,
    amcl,
    in_order,
    localised,
    moving,
    odometry_topic,
    scanner,
    scans,
    static,
)
from timemap_cli.config import load
from timemap_cli.replay import replay
from timemap_cli.results.reader import ResultReader

ROUNDING_M = 0.002  # ranges are rounded to a millimetre, by the scanner and again by the memory
# Half of what counts as one surface (map.range_bin, 0.1 m). In 75 ms of a sweep the robot moves by 4.5 cm, ...
SURFACE_M = 0.05
# ... and about ten edges of walls and furniture can be seen from a node. At each of them one angle bin of 360
# may show either side to a beam that comes from a few centimetres beside.
AT_EDGES = 10 / 360
ALMOST_NONE = 1 / 360  # a point on the border of an angle bin may fall to either side


def in_base(*made):
    """Mounts of lasers named alike."""
    return [static(*((one, "laser") for one in made))]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("twins")
    (made / "nodes.txt").write_text(NODES)
    return made


def mapped(folder, *parts, **wanted):
    """Estimates by level and node of a recording of these parts; all scans are read."""
    log = write_mcap(folder / "log.mcap", in_order(*parts))
    settings = load(None, {"input": wanted})
    done = replay([log], folder / "result.timemap.mcap", settings, force=True, nodes=folder / "nodes.txt")
    assert sum(done.dropped.values()) <= 0.01 * done.scans_read
    with ResultReader(done.result) as reader:
        found = {level: reader.estimates(level) for level in reader.levels}
    return {(level, node): one.ranges for level, nodes in found.items() for node, one in nodes.items()}


def plain(folder, **more):
    made = scanner(**more)
    return mapped(folder, in_base(made), moving(), scans(made))


@pytest.fixture(scope="module")
def twin(folder):
    return plain(folder)


@pytest.fixture(scope="module")
def instant_twin(folder):
    """Of a laser that takes all beams at once."""
    return plain(folder, sweep_time=0.0)


def shares(one, other, tolerance_m):
    """Largest share, over the levels, of angle bins that differ, and of those that only one of both knows."""
    assert one.keys() == other.keys()
    differing, lonely = [], []
    for level in ("short", "mid", "long"):
        a, b = (
            np.concatenate([found[key] for key in sorted(one) if key[0] == level]) for found in (one, other)
        )
        known = ~np.isnan(a) & ~np.isnan(b)
        with np.errstate(invalid="ignore"):  # both clear
            same = (a == b) | (np.abs(a - b) <= tolerance_m)
        differing.append(np.mean(known & ~same))
        lonely.append(np.mean(np.isnan(a) != np.isnan(b)))
        assert known.mean() > 0.95
    return max(differing), max(lonely)


def assert_same_map(one, other, tolerance_m, share):
    differing, lonely = shares(one, other, tolerance_m)
    assert differing <= share
    assert lonely <= share


UPSIDE_DOWN = Mount(0.1, 0.0, 0.2, 0.0, upside_down=True)
CLOCKWISE = {"first_deg": 179.0, "step_deg": -1.0}


def test_a_laser_upside_down_shows_the_same_points(folder, instant_twin):
    made = scanner(UPSIDE_DOWN, sweep_time=0.0)
    found = mapped(folder, in_base(made), moving(), scans(made))
    assert_same_map(found, instant_twin, ROUNDING_M, ALMOST_NONE)


def test_a_clockwise_laser_shows_the_same_points(folder, instant_twin):
    made = scanner(**CLOCKWISE, sweep_time=0.0)
    found = mapped(folder, in_base(made), moving(), scans(made))
    assert_same_map(found, instant_twin, ROUNDING_M, ALMOST_NONE)


@pytest.mark.parametrize("turned", [{"mount": UPSIDE_DOWN}, CLOCKWISE], ids=["upside_down", "clockwise"])
def test_a_sweep_the_other_way_round_sees_each_direction_at_another_moment(folder, twin, turned):
    made = scanner(**turned)
    assert_same_map(mapped(folder, in_base(made), moving(), scans(made)), twin, SURFACE_M, AT_EDGES)


def test_transforms_between_the_scans_are_interpolated(folder, twin):
    """Every 0.2 s, never at a scan. While the robot gains its speed in 0.4 s, the straight line between two of them is
    off by 1.5 m/s^2 * (0.2 s)^2 / 8 = 7.5 mm, and while it begins to turn by 0.7 deg: 0.12 m at 10 m."""
    made = scanner()
    found = mapped(folder, in_base(made), moving(0.2, begin=0.03), scans(made))
    assert_same_map(found, twin, SURFACE_M, AT_EDGES / 2)


def test_drifting_odometry_and_its_correction_are_one_pose(folder, twin):
    """The drift is even, so what is interpolated between two corrections is exact but for its curve."""
    made = scanner()
    found = mapped(folder, in_base(made), localised(0.25, begin=0.03), scans(made))
    assert_same_map(found, twin, SURFACE_M, ALMOST_NONE)


def test_odometry_alone_gives_the_same_map_in_its_own_frame(folder, twin):
    made = scanner()
    for poses in (moving(parent="odom"), odometry_topic()):
        found = mapped(folder, in_base(made), poses, scans(made))
        assert_same_map(found, twin, 0.0, 0.0)


def test_the_poses_of_amcl_are_interpolated(folder, twin):
    """Every 0.25 s: as transforms every 0.2 s, but off by half as much again."""
    made = scanner()
    found = mapped(folder, in_base(made), amcl(), scans(made))
    assert_same_map(found, twin, SURFACE_M, AT_EDGES / 2)


CORNERS = {"first_deg": -135.0, "beams": 271}
ENDS = {"first_deg": -90.0, "beams": 181}


@pytest.mark.parametrize(
    ("front", "rear", "unseen"),
    [
        (
            scanner(Mount(0.25, 0.2, 0.2, 45.0), **CORNERS),
            scanner(Mount(-0.25, -0.2, 0.2, -135.0), **CORNERS),
            ALMOST_NONE,
        ),
        # What lies beside the robot, between the two half circles, is seen when it has driven on.
        (scanner(Mount(0.3, 0.0, 0.2, 0.0), **ENDS), scanner(Mount(-0.3, 0.0, 0.2, 180.0), **ENDS), AT_EDGES),
    ],
    ids=["corners", "ends"],
)
def test_front_and_rear_laser_feed_one_map(folder, twin, front, rear, unseen):
    """Each stands 0.3 m beside the twin's and sees past an edge on its own side: two angle bins at each of them."""
    mounts = [static((front, "front"), (rear, "rear"))]
    both = scans(front, "/front", "front"), scans(rear, "/rear", "rear", begin=0.55)
    found = mapped(folder, mounts, moving(), *both, scan_topics=["/front", "/rear"])
    differing, lonely = shares(found, twin, SURFACE_M)
    assert differing <= 2 * AT_EDGES
    assert lonely <= unseen
