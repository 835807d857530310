"""Short versions of the experiments on time scales, speed and support, with wide bounds."""

import math

import numpy as np
import pytest

from benchmarks.paper import bin_edges, calibration, half_life
from benchmarks.paper.half_life import young_law
from benchmarks.paper.section import Scale
from timemap_cli.model.levels import Level


@pytest.fixture(scope="module")
def lives():
    return half_life.run(Scale.quick).numbers


def test_the_half_life_is_the_stated_one_however_often_an_angle_bin_is_seen(lives):
    assert 0.85 < lives["window least"] <= lives["window most"] < 1.15
    assert 0.85 < lives["estimate least"] <= lives["estimate most"] < 1.15


def test_a_young_memory_follows_its_own_law(lives):
    assert 0.85 < lives["young least"] <= lives["young most"] < 1.15


def test_what_was_long_seen_without_its_neighbour_arrives_with_it(lives):
    assert lives["apart"] == 1.0


def test_the_law_of_a_young_memory_is_majority_first_and_the_half_life_at_last():
    level = Level("level", 100, 200.0)
    mature = 200 * 100 * math.log(100 / 99) / math.log(2)  # 290: when one scan in 1/q is its due
    assert young_law(level, 40) == 40
    assert young_law(level, 2000) == 200
    assert young_law(level, round(mature)) == pytest.approx(200, abs=2)
    assert young_law(level, 217) == pytest.approx(mature - 217 + 200 * math.log2(2 * 217 / mature), abs=0.1)


def test_where_a_surface_stands_does_not_matter_with_states_from_the_data():
    numbers = bin_edges.run(Scale.quick).numbers
    assert 0.9 <= numbers["least"] <= numbers["most"] <= 1.1
    assert numbers["paper most"] > 1.2


def test_support_is_the_share_of_the_past_that_agrees_whatever_the_view():
    numbers = calibration.run(Scale.quick).numbers
    assert numbers["mid 360° support"] < 0.15
    assert numbers["mid 240° support"] < 0.15 < 0.3 < numbers["mid 240° share of the window"]


def test_agreement_counts_what_stood_within_ten_centimetres_and_clear_only_as_clear():
    shown = np.array([1.0, 1.0, np.inf, 1.0])
    there = np.array([[1.09, 1.2, np.inf, np.inf]])
    assert calibration.agrees(shown, there, there).tolist() == [[1.0, 0.0, 1.0, 0.0]]
