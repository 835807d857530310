from dataclasses import replace

import numpy as np
import pytest

from tests.checks.making import BINS, NODES, WALLS, box, rings, seen, snapshot
from timemap_cli.checks.compare import compare
from timemap_cli.checks.snapshot import Input, Scans
from timemap_cli.checks.tolerances import defaults
from timemap_cli.checks.verdict import Outcome
from timemap_cli.errors import UsageError
from timemap_cli.model.nodes import Node

ROOM = np.concatenate([WALLS, box(2.0, 1.8)])


def verdict(found, expected=None, *, exact=False, **allowed):
    limits = defaults() | {name.replace("_", "."): value for name, value in allowed.items()}
    return compare(expected or snapshot(), found, limits, name="room", baseline="b.yaml", exact=exact)


def failed(one):
    return [(measure.name, measure.level) for measure in one.failures]


def test_the_same_map_passes_to_the_digest():
    one = verdict(snapshot(), exact=True)
    assert (one.outcome, one.unequal, one.causes, one.notes) == (Outcome.PASSED, (), (), ())
    assert all(measure.value == 0 for measure in one.measures)


def test_noise_of_a_centimetre_passes_but_not_to_the_digest():
    noise = np.random.default_rng(1).normal(0, 0.01, (len(NODES), BINS))
    other = rings(seen(NODES, ROOM) + noise)
    found = snapshot(levels={"short": replace(other, digests=("x", "y", "z"))})
    assert verdict(found).outcome is Outcome.PASSED
    assert verdict(found, exact=True).unequal == ("level short at node 0, 1, 2",)
    assert verdict(found, exact=True).outcome is Outcome.FAILED


def test_a_map_turned_by_a_degree_fails_and_names_the_heading():
    one = verdict(snapshot(seen(NODES, ROOM, turn=np.radians(1.0))))
    assert ("map.turn", None) in failed(one)
    assert "the laser's yaw on the robot, or the heading of the localisation" in one.causes[0]
    turn = next(measure for measure in one.measures if measure.name == "map.turn")
    assert turn.value == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("degrees", [-1.0, 1.0])
def test_a_map_turned_as_one_about_its_origin_names_its_frame_and_not_the_laser(degrees):
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turned = ROOM @ np.kron(np.eye(2), [[cos, sin], [-sin, cos]])  # each end of a wall as a row
    one = verdict(snapshot(seen(NODES, turned)))
    assert not {"nodes.shift", "nodes.turn"} & {name for name, _ in failed(one)}
    turn = next(measure for measure in one.measures if measure.name == "map.turn")
    assert turn.value == pytest.approx(1.0, abs=0.1)
    assert turn.text.startswith(f"all nodes are turned by {'-' if degrees < 0 else '+'}")
    assert turn.text.endswith(" deg, and about one point")
    assert (
        one.causes[0]
        == f"the map is turned ({turn.text}): the map of the localisation, or where the map frame lies"
    )
    assert not any("the laser's" in cause for cause in one.causes)


def test_a_map_shifted_by_three_centimetres_fails_and_names_the_localisation():
    one = verdict(snapshot(seen(NODES, ROOM, shift=(0.03, 0.0))))
    assert ("map.shift", None) in failed(one)
    assert any("the localisation, or where the map frame lies" in cause for cause in one.causes)


def test_nodes_shifted_in_different_directions_point_at_the_laser_s_place():
    ways = ((0.03, 0.0), (-0.03, 0.0), (0.0, 0.03))
    ranges = np.concatenate([seen([node], ROOM, shift=way) for node, way in zip(NODES, ways, strict=True)])
    one = verdict(snapshot(ranges))
    assert ("nodes.shift", None) in failed(one)
    assert any("the laser's place on the robot" in cause for cause in one.causes)


def test_one_thing_moved_by_fifteen_centimetres_fails_at_its_place():
    one = verdict(snapshot(seen(NODES, np.concatenate([WALLS, box(2.15, 1.8)]))))
    assert ("ranges.places", "short") in failed(one)
    (spot, *_) = next(measure for measure in one.failures if measure.name == "ranges.places").spots
    assert np.hypot(spot.x - 2.07, spot.y - 1.8) < 0.5
    assert set(spot.nodes) == {0, 1, 2}
    assert one.causes[0].startswith("something stands elsewhere around ")


def test_known_bins_that_became_unknown_fail_with_the_node_they_miss_at():
    ranges = seen(NODES, ROOM)
    ranges[1, :100] = np.nan
    one = verdict(snapshot(ranges))
    assert failed(one) == [("status.lost", "short")]
    assert one.failures[0].text == "9.26 % of the known angle bins are unknown now"  # 100 of 1080
    assert one.failures[0].spots[0].text == "node 1: 27.8 % of its angle bins"


def test_bins_that_became_clear_fail():
    ranges = seen(NODES, ROOM)
    ranges[0, :40] = np.inf
    assert ("status.clear", "short") in failed(verdict(snapshot(ranges)))


def test_a_level_that_knows_a_node_no_more_has_lost_its_bins():
    full = snapshot().levels["short"]
    ranges = full.ranges.copy()
    ranges[0] = np.nan
    found = snapshot(levels={"short": replace(full, ranges=ranges, digests=("", *full.digests[1:]))})
    assert failed(verdict(found)) == [("status.lost", "short")]


def test_a_changed_setting_fails_and_is_the_first_cause():
    found = snapshot(settings={"map.radius": 10.0, "levels.short.half_life": "10obs"})
    one = verdict(found)
    assert failed(one) == [("settings.changed", None)]
    assert one.causes == ("a setting was changed: levels.short.half_life 10obs instead of 5obs",)
    assert verdict(found, settings_changed=1).outcome is Outcome.PASSED


def test_a_setting_that_one_version_does_not_know_is_no_change_but_a_level_is():
    plain = snapshot().settings
    assert verdict(snapshot(settings={**plain, "gate.new": 1})).outcome is Outcome.PASSED
    assert failed(verdict(snapshot(settings={**plain, "levels.day.window": 9}))) == [
        ("settings.changed", None)
    ]


def test_missing_scans_fail_with_their_share():
    one = verdict(snapshot(scans=Scans(900, 891, {"no_pose": 9})))
    assert failed(one) == [("scans.read", None)]
    assert one.causes == ("10.0 % fewer scans: a part of a recording, or single scans of it",)


def test_scans_dropped_for_another_reason_fail_with_the_reason():
    one = verdict(snapshot(scans=Scans(1000, 900, {"no_pose": 10, "lost": 90})))
    assert failed(one) == [("scans.used", None)]
    assert one.causes == ("another share of the scans is dropped: lost 90 instead of 0",)


def test_as_many_dropped_scans_of_fewer_are_told_with_both_counts():
    one = verdict(snapshot(scans=Scans(200, 190, {"no_pose": 10})))
    assert ("scans.used", None) in failed(one)
    assert one.causes[-1] == "another share of the scans is dropped: 10 of 200 instead of 10 of 1000"


def test_a_share_that_is_off_by_its_tolerance_passes():
    one = verdict(
        snapshot(), snapshot(scans=Scans(1000, 980, {"no_pose": 20}))
    )  # 0.010000000000000009 in binary
    assert failed(one) == []


def test_missing_returns_that_count_as_hits_fail_though_the_map_is_the_same():
    one = verdict(snapshot(beams={"/scan": {"hit": 1.0, "no_return": 0.0}}))
    assert failed(one) == [("beams.kinds", None)]
    assert "the code that it writes for a missing return" in one.causes[0]


def test_another_recording_of_the_same_name_is_a_note_and_no_failure():
    one = verdict(snapshot(inputs=(Input("monday.mcap", "bb"),)))
    assert one.outcome is Outcome.PASSED
    assert one.notes == ("other recordings of the same name: monday.mcap",)


def test_nodes_a_little_elsewhere_are_compared_as_the_same():
    nodes = tuple(Node(node.x + 0.1, node.y) for node in NODES)
    one = verdict(snapshot(seen(nodes, ROOM), nodes=nodes))
    assert not {"nodes.missing", "nodes.new", "map.shift", "map.turn"} & {name for name, _ in failed(one)}
    assert one.notes[0].startswith("3 of 3 nodes stand a little elsewhere")


def test_a_missing_node_and_a_new_one_are_counted():
    nodes = (*NODES[:2], Node(9.0, 9.0))
    one = verdict(snapshot(seen(nodes, ROOM), nodes=nodes))
    texts = {measure.name: measure.text for measure in one.failures}
    assert texts["nodes.missing"] == "1 of 3 nodes are not there"
    assert texts["nodes.new"] == "1 of 3 nodes are new"


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"map_frame": "odom"}, "the map frame is 'odom' and was 'map'"),
        ({"angle_bins": 180}, "a node has 180 angle bins and had 360"),
        ({"levels": {}}, "they have no level in common"),
        ({"nodes": tuple(Node(50.0 + i, 0.0) for i in range(3))}, "they have no node in common"),
    ],
)
def test_what_cannot_be_compared_is_no_verdict(change, reason):
    with pytest.raises(UsageError) as refused:
        verdict(snapshot(**change))
    assert refused.value.message == f"nothing can be compared with b.yaml: {reason}"


def test_the_worst_is_told_first():
    moved = seen(NODES, np.concatenate([WALLS, box(2.15, 1.8)]))
    one = verdict(snapshot(moved, scans=Scans(990, 980, {"no_pose": 10})))
    excesses = [measure.excess for measure in one.failures]
    assert excesses == sorted(excesses, reverse=True)
    assert len(excesses) > 1
