"""By how much the map as a whole and its single nodes are shifted and turned."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.fits import Fits, fitted
from timemap_cli.checks.pairs import Pair
from timemap_cli.checks.surfaces import Offsets, ends
from timemap_cli.checks.tolerances import TOLERANCES, within
from timemap_cli.checks.verdict import Measure, Spot

Floats = npt.NDArray[np.float64]

_YAW = "the laser's yaw on the robot, or the heading of the localisation"
_FRAME = "the map of the localisation, or where the map frame lies"


def motion_measures(pair: Pair, come: Offsets, allowed: Mapping[str, float]) -> Iterator[Measure]:
    """What the nodes have in common, and what is left of each.

    `pair` are the rings of the level that averages the localisation's errors best, `come` the offsets of its result's
    ends.
    """
    fits = fitted(*ends(pair.found), come)
    known = fits.known
    if not known.any():
        return
    x, y, turn = fits.x[known], fits.y[known], np.degrees(fits.turn[known])
    common_x, common_y, common_turn = (float(np.median(part)) for part in (x, y, turn))
    shift = math.hypot(common_x, common_y)
    text = f"all nodes are shifted by {shift:.3f} m (x {common_x:+.3f}, y {common_y:+.3f})"
    yield _measure("map.shift", shift, text, allowed)
    rows = np.flatnonzero(known)
    left = np.hypot(x - common_x, y - common_y)
    as_one = _left_of_one_turn(fits, pair.centres)
    turned_as_one = not within(abs(common_turn), allowed["map.turn"]) and _rms(as_one) < _rms(left) / 2
    left = as_one if turned_as_one else left
    yield _turned(common_turn, turned_as_one, allowed)
    spots = pair.node_spots(rows, left, lambda value: f"shifted by {value:.3f} m")
    text = f"single nodes are shifted by {_rms(left):.3f} m, in different directions"
    yield _measure("nodes.shift", _rms(left), text, allowed, spots)
    left = np.abs(turn - common_turn)
    spots = pair.node_spots(rows, left, lambda value: f"turned by {value:.2f} deg")
    text = f"single nodes are turned by {_rms(left):.2f} deg, in different directions"
    yield _measure("nodes.turn", _rms(left), text, allowed, spots)


def _left_of_one_turn(fits: Fits, centres: Floats) -> Floats:
    """(known nodes,) [m] what is left of each node's shift if the map turns as one, about whatever point.

    Nodes that are turned about their own centres, as by the laser's yaw, do not go round each other.
    """
    known = fits.known
    turn = np.median(fits.turn[known])
    x = fits.x[known] + turn * centres[known, 1]
    y = fits.y[known] - turn * centres[known, 0]
    return np.asarray(np.hypot(x - np.median(x), y - np.median(y)))


def _turned(turn_deg: float, as_one: bool, allowed: Mapping[str, float]) -> Measure:
    if as_one:
        text = f"all nodes are turned by {turn_deg:+.2f} deg, and about one point"
        return replace(_measure("map.turn", abs(turn_deg), text, allowed), cause=_FRAME)
    text = f"all nodes are turned by {turn_deg:+.2f} deg"
    return replace(_measure("map.turn", abs(turn_deg), text, allowed), cause=_YAW)


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _measure(
    name: str, value: float, text: str, allowed: Mapping[str, float], spots: tuple[Spot, ...] = ()
) -> Measure:
    return Measure(name, None, value, allowed[name], TOLERANCES[name].unit, text, spots)
