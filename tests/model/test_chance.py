"""Random numbers that depend on what they decide and on nothing else."""

import numpy as np
import pytest

from timemap_cli.model import chance
from timemap_cli.model.nodes import Node


def test_numbers_are_those_of_splitmix64():
    """Of the seed 1234567, from the published C source: the state advances by the golden gamma before each."""
    keys = np.array([1234567], np.uint64)
    expected = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431]
    assert chance.mixed(keys, np.arange(4)).tolist() == expected


def test_a_key_depends_on_seed_place_and_level():
    keys = [
        chance.key(seed, node, level)
        for seed in (0, 1)
        for node in (Node(1, 2), Node(1, 2.001), Node(12, 0), Node(-1, 2))
        for level in ("short", "mid")
    ]
    assert len(set(keys)) == len(keys)


def test_a_key_counts_places_in_whole_millimetres():
    assert chance.key(0, Node(0.1 + 0.2, -0.0), "mid") == chance.key(0, Node(0.3, 0.0), "mid")


def test_a_key_is_the_same_in_every_run():
    """b2sum -l 64 of "0 1250 -3500 mid", bytes in little-endian order."""
    assert chance.key(0, Node(1.25, -3.5), "mid") == int.from_bytes(
        bytes.fromhex("3cdc1a3e4d335d91"), "little"
    )


@pytest.mark.parametrize("limit", [1, 2, 7, 100, 1000, 2**31])
def test_places_are_drawn_evenly_below_the_limit(limit):
    numbers = chance.mixed(np.arange(20_000, dtype=np.uint64), 3)
    drawn = chance.below(numbers, limit)
    assert drawn.min() >= 0
    assert drawn.max() < limit
    assert (drawn / limit).mean() == pytest.approx(0.5 * (1 - 1 / limit), abs=0.02)


def test_the_lower_half_of_a_number_is_as_random_as_the_upper():
    numbers = chance.mixed(np.arange(20_000, dtype=np.uint64), 0)
    upper, lower = chance.below(numbers, 10), chance.below(numbers << np.uint64(32), 10)
    table = np.zeros((10, 10))
    np.add.at(table, (upper, lower), 1)
    assert table.min() > 140
    assert table.max() < 265
