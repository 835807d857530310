"""Inspections written out by hand, for the tests of what is printed of them."""

from dataclasses import replace

from timemap_cli.errors import UsageError
from timemap_cli.logs.beams import BeamCounts
from timemap_cli.logs.inspect import Inspection, LogInfo, PoseInfo
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.scan_statistics import ScanTopic
from timemap_cli.logs.selection import Selection

SCAN = ScanTopic(
    topic="/scan",
    frame_id="laser",
    count=910,
    rate_hz=0.2986,
    n_beams=180,
    fov_deg=179.0,
    range_min_m=0.1,
    range_max_m=80.0,
    beams=BeamCounts(hit=159_628, no_return=4_172),
    with_pose=905,
    found=("no return: 81.83 m",),
    pose_report=None,
)
LOG = LogInfo(
    path="intel.mcap",
    format="ROS 2 mcap",
    start_ns=976_052_889_905_799_936,
    end_ns=976_055_540_770_000_001,
    scans=(SCAN,),
    poses=(
        PoseInfo("/pose", "geometry_msgs/msg/PoseWithCovarianceStamped", 910, "map", None),
        PoseInfo("/odom", "nav_msgs/msg/Odometry", 2639, "odom", "base_link"),
        PoseInfo("/tf", "tf2_msgs/msg/TFMessage", 910, None, None),
    ),
    other_topics=2,
    problems=("/scan: stamps step back once, by up to 0.86 s", "/scan: 1 gap without scans, up to 20.1 s"),
)
INTEL = Inspection(
    logs=(LOG,),
    selection=Selection(("/scan",), "map", "tf", ("odometry drifts",)),
    trouble=None,
    span_ns=(976_052_889_859_000_111, 976_055_540_700_000_000),
    chains=(("map", "base_link", "laser"),),
    missing_returns={(0, "/scan"): MissingReturns(4172, 0.67)},
    missing_are_clear={(0, "/scan"): False},
    no_return="ignore",
    problems=("b.mcap has no scans of /scan",),
)
STUCK = replace(
    INTEL,
    selection=None,
    trouble=UsageError("2 scan topics and none named: /a, /b", hint="--scan-topic /a\n--scan-topic /b"),
    span_ns=None,
    chains=(),
    missing_returns={},
    missing_are_clear={},
    no_return=None,
    problems=(),
)
