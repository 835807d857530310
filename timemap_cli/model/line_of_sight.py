"""How far one sees from a node's centre without leaving what a scan saw free."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.angles import quarter_turns
from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.outline import Outlines

Floats = npt.NDArray[np.float32]
Bools = npt.NDArray[np.bool_]
Ints = npt.NDArray[np.int64]

MILLIMETRES = np.float32(1000)
FAR = 65535  # [mm] as far as the table reaches


@dataclass(frozen=True, slots=True)
class Sight:
    """The outlines of n scans seen from their nodes, along the borders of the angle bins; bin i begins at border i."""

    bearing: Floats  # (n, vertices + 1) in angle bins, [0, angle_bins)
    free: npt.NDArray[np.uint16]  # (n, angle_bins) [mm] along each border to the first edge of the outline
    edge: npt.NDArray[np.uint16]  # (n, angle_bins) number of that edge's first vertex
    folded: Bools  # (n, angle_bins) the outline runs backwards somewhere in the angle bin
    encloses: Bools  # (n,) the node's centre is inside the outline


def line_of_sight(outlines: Outlines, angle_bins: int) -> Sight:
    """Intersect rays from each node's centre, along the borders of its angle bins, with the outline of its scan."""
    rays = angle_bins
    bearing = quarter_turns(outlines.x, outlines.y)
    bearing *= np.float32(rays / 4)
    start = bearing[:, :-1]
    step = bearing[:, 1:] - start
    step -= np.rint(step * np.float32(1 / rays)) * np.float32(rays)
    encloses = np.sum(step * outlines.turn, axis=1) > 0.75 * rays
    stop = start + step
    low, high = np.minimum(start, stop), np.maximum(start, stop)
    free, edge = _first_crossings(outlines, low, high, rays)
    folded = _folds(low, high, step * outlines.turn < 0, rays)
    return Sight(bearing, free, edge, folded, encloses)


def _first_crossings(
    outlines: Outlines, low: Floats, high: Floats, rays: int
) -> tuple[npt.NDArray[np.uint16], npt.NDArray[np.uint16]]:
    n, vertices = low.shape
    x, y = outlines.x, outlines.y
    first, last = np.ceil(low), np.floor(high)
    edge, ray = _whole_numbers(np.flatnonzero(last >= first), first, last, rays)
    dx, dy = x[:, 1:] - x[:, :-1], y[:, 1:] - y[:, :-1]
    area = x[:, :-1] * dy - y[:, :-1] * dx
    cos, sin = _ray_directions(rays)
    across = cos.take(ray) * dy.ravel().take(edge)
    across -= sin.take(ray) * dx.ravel().take(edge)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = area.ravel().take(edge) / across
    distance *= MILLIMETRES
    np.abs(distance, out=distance)
    # an edge along the ray divides 0 by 0; its ends are met by its neighbours, so it may count as far
    np.fmin(distance, np.float32(FAR), out=distance)
    key = np.rint(distance, out=distance).astype(np.uint32)
    key <<= np.uint32(16)
    scan = edge // vertices
    key |= (edge - scan * vertices).astype(np.uint32)
    ray += scan * rays
    table = np.full(n * rays, FAR << 16, np.uint32)
    np.minimum.at(table, ray, key)
    table = table.reshape(n, rays)
    return (table >> np.uint32(16)).astype(np.uint16), table.astype(np.uint16)


def _folds(low: Floats, high: Floats, backward: Bools, rays: int) -> Bools:
    """Where a star-shaped outline would not be: between which rays lies an edge that runs backwards."""
    n, vertices = low.shape
    edge, cell = _whole_numbers(np.flatnonzero(backward), np.floor(low), high, rays)
    folded = np.zeros(n * rays, np.bool_)
    folded[cell + edge // vertices * rays] = True
    return folded.reshape(n, rays)


def _whole_numbers(chosen: Ints, first: Floats, last: Floats, rays: int) -> tuple[Ints, Ints]:
    """The whole numbers from first to last of the chosen edges (flat indices), wrapped into [0, rays).

    Returns the edge and the number, each (count,). An edge spans less than the circle and starts on it.
    """
    start = first.ravel().take(chosen).astype(np.int64)
    counts = last.ravel().take(chosen).astype(np.int64)
    counts -= start
    counts += 1
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    steps = np.zeros(total, np.int64)
    steps[ends[:-1]] = 1
    owner = np.cumsum(steps)
    start -= ends
    start += counts
    number = np.arange(total)
    number += start.take(owner)
    number += (number < 0) * rays
    number -= (number >= rays) * rays
    return chosen.take(owner), number


@cache
def _ray_directions(rays: int) -> tuple[Floats, Floats]:
    cos, sin = cos_sin(np.arange(rays) * (2 * math.pi) / rays)
    return cos.astype(np.float32), sin.astype(np.float32)
