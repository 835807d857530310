"""By how much the map as a whole and its single nodes are shifted and turned."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.fits import Fits, fitted
from timemap_cli.checks.pairs import Pair
from timemap_cli.checks.surfaces import Offsets, ends
from timemap_cli.checks.tolerances import TOLERANCES
from timemap_cli.checks.verdict import Measure, Spot

Floats = npt.NDArray[np.float64]


def motion_measures(
    pairs: Sequence[Pair], come: Sequence[Offsets], allowed: Mapping[str, float]
) -> Iterator[Measure]:
    """What the nodes have in common, and what is left of each; one motion of a node explains all its levels.

    `pairs` are the levels' rings with the same rows, `come` the offsets of the result's ends.
    """
    fits = _fits(pairs, come)
    known = fits.known
    if not known.any():
        return
    x, y, turn = fits.x[known], fits.y[known], np.degrees(fits.turn[known])
    common_x, common_y, common_turn = (float(np.median(part)) for part in (x, y, turn))
    shift = math.hypot(common_x, common_y)
    text = f"all nodes are shifted by {shift:.3f} m (x {common_x:+.3f}, y {common_y:+.3f})"
    yield _measure("map.shift", shift, text, allowed)
    yield _measure("map.turn", abs(common_turn), f"all nodes are turned by {common_turn:+.2f} deg", allowed)
    rows, left = np.flatnonzero(known), np.hypot(x - common_x, y - common_y)
    spots = pairs[0].node_spots(rows, left, lambda value: f"shifted by {value:.3f} m")
    text = f"single nodes are shifted by {_rms(left):.3f} m, in different directions"
    yield _measure("nodes.shift", _rms(left), text, allowed, spots)
    left = np.abs(turn - common_turn)
    spots = pairs[0].node_spots(rows, left, lambda value: f"turned by {value:.2f} deg")
    text = f"single nodes are turned by {_rms(left):.2f} deg, in different directions"
    yield _measure("nodes.turn", _rms(left), text, allowed, spots)


def _fits(pairs: Sequence[Pair], come: Sequence[Offsets]) -> Fits:
    x, y = (np.concatenate(part, axis=1) for part in zip(*(ends(p.found) for p in pairs), strict=True))
    return fitted(x, y, Offsets.joined(come))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _measure(
    name: str, value: float, text: str, allowed: Mapping[str, float], spots: tuple[Spot, ...] = ()
) -> Measure:
    return Measure(name, None, value, allowed[name], TOLERANCES[name].unit, text, spots)
