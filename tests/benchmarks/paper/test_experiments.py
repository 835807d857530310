"""Short versions of the experiments, with wide bounds: what the document says must not turn around."""

from functools import cache

import pytest

from benchmarks.paper import experiments
from benchmarks.paper.document import markdown
from benchmarks.paper.section import Scale


@cache
def numbers(name):
    section = experiments.run(name, Scale.quick)
    assert f"## {section.title}" in markdown(section)
    return section.numbers


def test_a_box_appears_at_the_half_life_and_as_a_whole():
    found = numbers("fig6")
    assert 20 <= found["mid delay"] <= 55
    assert 200 <= found["long delay"] <= 370
    assert found["mid mixed"] <= 10
    assert found["mid error"] < 0.015
    assert found["long error"] < 0.015


@pytest.mark.parametrize("side", ["first", "last"])
def test_the_hidden_part_follows_the_visible_one_from_either_side(side):
    found = numbers("fig7")
    assert found[f"window 40 {side} 20 follows"] > 0.9
    assert found[f"window 40 {side} 20 mixed"] < 0.1
    assert found[f"window 40 median {side} mixed"] > 0.8


def test_a_part_that_was_never_seen_is_included_immediately():
    found = numbers("unseen")
    assert found["mid of the room ours"] == 1
    assert found["mid of the object ours"] <= 3


def test_wrong_poses_below_a_half_leave_the_map_right():
    found = numbers("fig8")
    assert found["mid 0.1 error"] < 0.01
    assert found["mid 0.4 error"] < 0.03
    assert found["mid 0.6 flipped"] > 0.5


@pytest.mark.parametrize("behind", ["wall", "open space"])
def test_a_removed_obstacle_is_forgotten_at_the_half_life(behind):
    assert 20 <= numbers("removed")[f"mid {behind} delay"] <= 55


def test_levels_differ_at_the_door_where_they_should():
    found = numbers("door")
    assert found["overlap"] > 0.7
    assert found["false"] < 0.01


def test_a_person_is_in_the_short_level_and_never_in_the_long_one():
    found = numbers("person")
    assert found["short"] > 0
    assert found["long"] == 0


def test_a_parked_robot_keeps_its_slow_levels_only_with_the_gate():
    found = numbers("parked")
    assert found["gate long"] == found["gate mid"] == 0
    assert found["none mid"] == 1


def test_touching_surfaces_change_as_a_whole():
    found = numbers("failures")
    scene = "touching shelves, one of four taken away"
    assert found[f"mid ours {scene} mixed"] <= 10
    assert 25 <= found[f"mid ours {scene} delay"] <= 60


def test_the_median_loses_the_hidden_part_that_the_vote_carries_along():
    found = numbers("rivals_table")
    assert found["mid ours hidden"] > 0.7
    assert found["mid median per angle bin hidden"] < 0.2


def test_the_vote_takes_a_hidden_neighbour_away_and_the_median_does_not():
    found = numbers("rivals_table")
    assert found["mid ours neighbour"] < 0.2
    assert found["mid median per angle bin neighbour"] > 0.8
