"""The whole method on a drive through a room."""

import numpy as np

from tests.model.drives import GATE, LEVELS, OPEN_GATE, as_bytes, drive, observer, replay, time_map
from tests.model.scenes import ROOM, pillar, pose, seen_from, sweeps
from timemap_cli.model.levels import Level
from timemap_cli.model.nodes import Node

SCANS = drive(160)


def test_every_level_of_every_node_is_estimated_once():
    learnt, found = replay(SCANS)
    assert len(learnt.nodes) > 2
    assert list(found) == [(level.name, node) for level in LEVELS for node in range(len(learnt.nodes))]
    assert learnt.estimates() == []


def test_the_room_is_found():
    """Before the box came, what is estimated is where the walls are."""
    learnt, found = replay(SCANS.rows(slice(0, 80)))
    errors = []
    for (_, node), estimate in found.items():
        true = seen_from(ROOM, learnt.nodes[node].x, learnt.nodes[node].y, 72)
        seen = np.isfinite(estimate.ranges)
        errors += np.maximum(true[:, 0] - estimate.ranges, estimate.ranges - true[:, 1])[seen].tolist()
    assert len(errors) > 500
    assert np.mean(np.array(errors) < 0.05) > 0.97


def test_the_box_is_seen_by_the_short_level_after_it_came():
    learnt, found = replay(SCANS)
    with_box = np.concatenate((ROOM, pillar(1.9, 0.5, 0.5)))
    short = found["short", 0]
    place = learnt.nodes[0]
    true, before = (seen_from(room, place.x, place.y, 72) for room in (with_box, ROOM))
    box = (before[:, 0] - true[:, 1] > 0.3) & np.isfinite(short.ranges)
    assert box.sum() >= 3
    assert (np.abs(short.ranges[box] - true[box].mean(axis=1)) < 0.3).all()


def test_an_estimate_is_stamped_with_the_newest_scan_that_its_memory_holds():
    looking, learning = observer(gate=GATE), time_map()
    standing = sweeps(
        np.full((40, 121), 1.5), SCANS.bearings, [pose(0, 0)] * 40, stamps_ns=np.arange(40) * 10**9
    )
    learning.learn(looking.observe(standing))
    stamps = {found.level: found.stamp_ns for found in learning.estimates()}
    assert stamps["mid"] == 0  # the gate let the first pass alone
    assert 30 * 10**9 < stamps["short"] <= 39 * 10**9


def test_slower_levels_take_only_what_passed_the_gate():
    standing = sweeps(np.full((40, 121), 1.5), SCANS.bearings, [pose(0, 0)] * 40)
    _, gated = replay(standing, gate=GATE)
    _, free = replay(standing, gate=OPEN_GATE)
    counts = {level: int(gated[level, 0].samples.max()) for level in ("short", "mid", "long")}
    assert counts == {"short": 7, "mid": 1, "long": 1}
    assert free["mid", 0].samples.max() == 10


def test_only_nodes_that_changed_are_estimated_again():
    looking, learning = observer(), time_map()
    learning.learn(looking.observe(SCANS))
    learning.estimates()
    learning.learn(looking.observe(SCANS.rows(slice(0, 3))))
    assert {found.node for found in learning.estimates()} == {0}


def test_estimates_in_between_change_nothing():
    looking, learning = observer(), time_map()
    for start in range(0, 160, 20):
        learning.learn(looking.observe(SCANS.rows(slice(start, start + 20))))
        latest = {found.level: found for found in learning.estimates() if found.node == 0}
    whole = {level: found for (level, node), found in replay(SCANS)[1].items() if node == 0}
    for level, found in latest.items():
        assert found.ranges.tobytes() == whole[level].ranges.tobytes()


# ------------------------------------------------------------------ chance


def test_two_runs_are_the_same_to_the_last_bit():
    assert as_bytes(replay(SCANS)[1]) == as_bytes(replay(SCANS)[1])


def test_another_seed_keeps_other_samples():
    assert as_bytes(replay(SCANS, seed=1)[1]) != as_bytes(replay(SCANS)[1])


def test_a_level_more_changes_no_other_level():
    extra = (LEVELS[0], Level("extra", 9, 30.0), *LEVELS[1:])
    found, more = as_bytes(replay(SCANS)[1]), as_bytes(replay(SCANS, levels=extra)[1])
    assert {key: value for key, value in more.items() if key[0] != "extra"} == found


def test_a_level_keeps_other_samples_under_another_name():
    renamed = (LEVELS[0], Level("middle", 10, 12.0))
    original = replay(SCANS, levels=LEVELS[:2])[1]
    other = replay(SCANS, levels=renamed)[1]
    assert any(original["mid", n].ranges.tobytes() != other["middle", n].ranges.tobytes() for n in range(3))


def test_nodes_more_change_no_other_node():
    """Scans go to the nearest node, and nearest to the others are the same scans; only the numbers shift."""
    nodes = [Node(0.9, 0.5), Node(-0.9, 0.5)]
    far = [Node(3.5, 3.0), Node(-3.5, -2.5), Node(3.5, -2.5)]
    found = as_bytes(replay(SCANS, nodes=nodes)[1])
    more = as_bytes(replay(SCANS, nodes=[far[0], nodes[0], far[1], nodes[1], far[2]])[1])
    assert {(level, {1: 0, 3: 1}[node]): value for (level, node), value in more.items()} == found
    assert len(found) == 6
