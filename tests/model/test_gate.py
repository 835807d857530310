"""Which scans of a node the slower levels may take."""

import math

import numpy as np
import pytest

from timemap_cli.model.gate import Gate, passing

GATE = Gate(min_travel=0.05, min_turn=math.radians(5), min_interval_ns=200_000_000)
OPEN = Gate(0.0, 0.0, 0)


def passed(gate, places, *, nodes=None, step_ms=1000, last=None):
    places = np.array(places, float).reshape(-1, 3)
    stamps = np.arange(len(places)) * step_ms * 1_000_000
    return passing(gate, nodes or [0] * len(places), places, stamps, {} if last is None else last).tolist()


def test_standing_still_passes_once():
    assert passed(GATE, [(1, 2, 0.5)] * 5) == [True, False, False, False, False]


def test_enough_travel_passes():
    assert passed(GATE, [(0, 0, 0), (0.03, 0.03, 0), (0.04, 0.04, 0)]) == [True, False, True]


def test_travel_is_measured_from_the_last_scan_that_passed():
    """Creeping passes too, if more seldom."""
    assert passed(GATE, [(0.02 * i, 0, 0) for i in range(7)]) == [
        True,
        False,
        False,
        True,
        False,
        False,
        True,
    ]


def test_enough_turning_passes_across_half_a_turn():
    turn = [(0, 0, math.radians(yaw)) for yaw in (178, 181, -178, -176, 184)]
    assert passed(GATE, turn) == [True, False, False, True, False]


def test_moving_passes_only_after_the_interval():
    moving = [(0.1 * i, 0, 0) for i in range(7)]
    assert passed(GATE, moving, step_ms=100) == [True, False, True, False, True, False, True]


def test_an_open_gate_lets_everything_pass():
    assert all(passed(OPEN, [(1, 2, 0.5)] * 5, step_ms=0))


def test_every_node_has_its_own_gate():
    assert passed(GATE, [(0, 0, 0)] * 4, nodes=[3, 5, 3, 5]) == [True, True, False, False]


def test_the_gate_remembers_from_block_to_block():
    places = [(0.01 * i, 0, 0.02 * i) for i in range(60)]
    whole = passed(GATE, places)
    last, parts = {}, []
    for i in range(60):
        stamps = np.array([i * 1_000_000_000])
        parts += passing(GATE, [0], np.array([places[i]]), stamps, last).tolist()
    assert parts == whole


@pytest.mark.parametrize("gate", [GATE, OPEN])
def test_no_scans_pass_no_gate(gate):
    assert passed(gate, []) == []


def test_two_scanners_of_a_standing_robot_pass_once_each():
    """The rear one looks the other way, from another place: that is no turn and no travel."""
    last = {}
    for second in range(10):
        for scanner, place in enumerate(((0.2, 0.0, 0.0), (-0.2, 0.0, math.pi))):
            passes = passing(GATE, [0], np.array([place]), np.array([second * 10**9]), last, scanner)
            assert passes.tolist() == [second == 0]


def test_no_scanner_takes_the_turn_of_the_other():
    """One scans 10 ms after the other, well within the interval: both pass as often as alone."""
    places = np.array([[0.02 * i, 0.0, 0.0] for i in range(100)])
    stamps_ns = np.arange(100) * 100_000_000
    alone = passing(GATE, [0] * 100, places, stamps_ns, {}, 1)
    last, front, rear = {}, [], []
    for i in range(100):
        front += passing(
            GATE, [0], places[i : i + 1] + 0.5, stamps_ns[i : i + 1] - 10_000_000, last, 0
        ).tolist()
        rear += passing(GATE, [0], places[i : i + 1], stamps_ns[i : i + 1], last, 1).tolist()
    assert front == rear == alone.tolist()
    assert 30 < sum(rear) < 40


def test_stamps_that_begin_anew_do_not_close_the_gate():
    last = {}
    places = np.array([[x, 0.0, 0.0] for x in (0.0, 1.0, 2.0)])
    stamps_ns = np.array([100, 101, 102]) * 10**9
    assert passing(GATE, [0, 0, 0], places, stamps_ns, last).all()
    assert passing(GATE, [0, 0, 0], places[::-1] + 0.5, stamps_ns - 90 * 10**9, last).all()


@pytest.mark.parametrize("gate", [Gate(0.05, 0.0, 0), Gate(0.0, 0.1, 0)])
def test_a_criterion_of_zero_is_left_out(gate):
    places = np.zeros((5, 3))
    assert passing(gate, [0] * 5, places, np.arange(5) * 10**9, {}).tolist() == [True] + [False] * 4
