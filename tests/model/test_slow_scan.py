"""The virtual scan against a slow one that follows every beam and cuts every line of sight exactly."""

import math

import numpy as np
import pytest

from tests.model.scenes import ROOM, cast, drive_past, fan, look_around, seen_from
from tests.model.slow_scan import slow_virtual_scan
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, virtual_scans


def a_scan(random, beams, degrees, *, noise=False):
    """A scan from a random place of the room, and a node near it; half of the robots move."""
    while True:
        x, y = random.uniform(-3.8, 4.8), random.uniform(-2.8, 3.3)
        side, away, yaw = random.uniform(0, 2 * math.pi), random.uniform(0, 1), random.uniform(0, 2 * math.pi)
        room_for_it = cast(ROOM, x, y, np.linspace(0, 2 * math.pi, 60)).min() > 0.25
        if room_for_it and cast(ROOM, x, y, np.array([side]))[0] > away + 0.05:  # no wall in between
            break
    bearings, upside_down = fan(beams, degrees), bool(random.integers(2))
    if random.integers(2):
        there = np.array([x, y, yaw]) + random.uniform(-0.1, 0.1, 3)
        scan = drive_past(ROOM, (x, y, yaw), there, bearings, upside_down=upside_down, clear_range=12.0)
    else:
        scan = look_around(
            ROOM,
            x,
            y,
            yaw,
            bearings,
            upside_down=upside_down,
            noise=random if noise else None,
            clear_range=12.0,
        )
    if random.integers(2):
        lost = random.random(beams)
        scan.ranges[0, lost < 0.04] = np.nan
        scan.ranges[0, lost > 0.98] = np.inf
    return scan, np.array([[x + away * math.cos(side), y + away * math.sin(side)]])


def both(scan, node, angle_bins, radius):
    """The model's ranges and the slow ones, or None where one of them cannot judge the node."""
    fast, judged = virtual_scans(scan, node, np.ones(1, bool), angle_bins, radius)
    slow = slow_virtual_scan(scan, 0, node[0], angle_bins, radius)
    if slow is None or not judged[0]:
        assert slow is None or np.any(scan.map_from_laser_first != scan.map_from_laser_last)
        return None
    fast = np.where(fast[0] == UNSEEN, np.nan, np.where(fast[0] == CLEAR, np.inf, fast[0] / 1000))
    return fast, slow


SCANNERS = [(91, 90), (181, 180), (361, 180), (271, 270), (541, -270), (361, 360), (360, -359), (181, 360)]


@pytest.mark.parametrize(("beams", "degrees"), SCANNERS)
def test_a_scan_of_half_a_degree_and_more_agrees_with_the_slow_one(beams, degrees):
    random = np.random.default_rng(beams)
    judged, bins, more, less, other_range = 0, 0, 0, 0, 0
    for _ in range(24):
        found = both(
            *a_scan(random, beams, degrees), int(random.choice([333, 360])), random.choice([2.0, 10.0])
        )
        if found is None:
            continue
        fast, slow = found
        judged, bins = judged + 1, bins + len(fast)
        less += (np.isnan(fast) & ~np.isnan(slow)).sum()
        more += (~np.isnan(fast) & (np.isnan(slow) | (np.isposinf(fast) != np.isposinf(slow)))).sum()
        finite = np.isfinite(fast) & np.isfinite(slow)
        other_range += (np.abs(fast[finite] - slow[finite]) > 0.0011).sum()
    assert judged >= 20
    # A point may fall on the other side of a border, a line of sight pass an edge on the other side; and the model
    # looks along the borders of angle bins alone, so it leaves a few more of them empty.
    assert more <= 0.0005 * bins
    assert less <= 0.01 * bins
    assert other_range <= 0.002 * bins


@pytest.mark.parametrize("degrees", [180, -270, 360])
def test_a_scan_finer_than_the_angle_bins_keeps_the_nearest_of_neighbouring_beams(degrees):
    random = np.random.default_rng(5)
    bins, other_kind, errors = 0, 0, []
    for _ in range(8):
        found = both(*a_scan(random, 4 * abs(degrees) + 1, degrees, noise=True), 360, 10.0)
        if found is None:
            continue
        fast, slow = found
        bins += len(fast)
        other_kind += (np.isfinite(fast) != np.isfinite(slow)).sum()
        finite = np.isfinite(fast) & np.isfinite(slow)
        errors += np.abs(fast[finite] - slow[finite]).tolist()
    assert other_kind <= 0.02 * bins
    assert np.quantile(errors, 0.8) < 0.01
    assert np.quantile(errors, 0.99) < 0.08


@pytest.mark.parametrize(("beams", "degrees"), [(181, 180), (1081, 270), (361, 360)])
def test_what_is_claimed_from_a_node_is_true_there(beams, degrees):
    """Judged by the room itself, not by any scan; plain placing of points fails here ten times as often."""
    random = np.random.default_rng(7)
    wrong_hits, wrong_clear, claims = 0, 0, 0
    for _ in range(100):
        scan, node = a_scan(random, beams, degrees)
        ranges, _ = virtual_scans(scan, node, np.ones(1, bool), 360, 4.0)
        true = seen_from(ROOM, *node[0], 360, rays_per_bin=8)
        hit = ranges[0] < CLEAR
        metres = ranges[0] / 1000
        wrong_hits += (hit & ((metres < true[:, 0] - 0.15) | (metres > true[:, 1] + 0.15))).sum()
        wrong_clear += ((ranges[0] == CLEAR) & (true[:, 1] < 3.9)).sum()
        claims += (ranges[0] != UNSEEN).sum()
    assert claims > 10_000
    assert wrong_hits < 0.003 * claims
    assert wrong_clear < 0.002 * claims
