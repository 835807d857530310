"""What moved between the rings of one level: all together, at single nodes, at places."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from timemap_cli.checks.pairs import SHOWN, Pair
from timemap_cli.checks.places import Ends, MovedPlace
from timemap_cli.checks.surfaces import Offsets, ends, farther
from timemap_cli.checks.tolerances import TOLERANCES
from timemap_cli.checks.verdict import Measure, Spot

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


def level_measures(
    level: str,
    pair: Pair,
    come: Offsets,
    gone: Offsets,
    places: Sequence[MovedPlace],
    allowed: Mapping[str, float],
) -> list[Measure]:
    """All figures of a level, with the places where they come from.

    `come` are the offsets of the result's ends from the baseline's surfaces, `gone` those the other way round.
    """
    told = _Told(level, pair, allowed)
    return [
        told.moved(come, gone, allowed["ranges.step"]),
        told.places(places),
        *told.status(),
    ]


def both_ends(pair: Pair, come: Offsets, gone: Offsets) -> Ends:
    """The ends of both sides in the map frame, where both know the angle bin."""
    sides = []
    for ranges, off, centres in (
        (pair.found, come, pair.centres),
        (pair.expected, gone, pair.centres + pair.apart),
    ):
        row, angle_bin = np.nonzero(np.isfinite(ranges) & pair.both)
        x, y = (part[row, angle_bin] for part in ends(ranges))
        node = np.array(pair.numbers, np.int64)[row]
        distance = off.distance[row, angle_bin]
        sides.append(Ends(x + centres[row, 0], y + centres[row, 1], node, distance))
    return sides[0].joined(sides[1])


class _Told:
    """Figures of one level as measures."""

    def __init__(self, level: str, pair: Pair, allowed: Mapping[str, float]) -> None:
        self._level = level
        self._pair = pair
        self._allowed = allowed

    def moved(self, come: Offsets, gone: Offsets, step_m: float) -> Measure:
        """How many angle bins show something that the other side does not have."""
        both = self._pair.both
        distance = np.zeros(both.shape)
        for off in (come, gone):
            distance = np.fmax(distance, np.where(both, off.distance, 0.0))
        moved = farther(distance, step_m)
        text = (
            f"{_percent(moved.sum(), both.sum())} of {both.sum()} angle bins moved by more than {step_m:g} m"
        )
        finite = np.where(np.isfinite(distance) & moved, distance, 0.0)
        if finite.any():
            row, angle_bin = np.unravel_index(int(finite.round(6).argmax()), finite.shape)
            x, y = self._end(int(row), int(angle_bin))
            text += (
                f", the farthest by {finite.max():.2f} m at {x:.2f}, {y:.2f} (node {self._pair.numbers[row]})"
            )
        shares = moved.sum(axis=1) / np.maximum(1, both.sum(axis=1))
        spots = self._pair.node_spots(
            np.arange(len(shares)), shares, lambda value: f"{100 * value:.1f} % of its angle bins moved"
        )
        return self._measure("ranges.moved", float(moved.sum() / max(1, both.sum())), text, spots)

    def places(self, places: Sequence[MovedPlace]) -> Measure:
        """Where several nodes agree that a surface moved."""
        spots = tuple(
            Spot(place.x, place.y, f"{_surface(place)}, seen from {_nodes(place.nodes)}", place.nodes)
            for place in places[:SHOWN]
        )
        text = "no place where several nodes see a surface that moved"
        if places:
            worst = places[0]
            text = (
                f"surfaces moved at {_count(len(places), 'place')}, the most at {worst.x:.2f}, {worst.y:.2f}"
            )
            text += f" ({spots[0].text})"
        return self._measure("ranges.places", float(len(places)), text, spots)

    def status(self) -> Iterator[Measure]:
        """Known, unknown and clear against the other side."""
        expected, found, both = self._pair.expected, self._pair.found, self._pair.both
        was, now = ~np.isnan(expected), ~np.isnan(found)
        turned = (np.isinf(expected) != np.isinf(found)) & both
        changes = (
            ("status.lost", was & ~now, was, "of the known angle bins are unknown now"),
            ("status.gained", now & ~was, was, "more angle bins are known"),
            ("status.clear", turned, both, "of the angle bins became clear or ceased to be"),
        )
        for name, which, of, told in changes:
            shares = which.sum(axis=1) / np.maximum(1, of.sum(axis=1))
            spots = self._pair.node_spots(
                np.arange(len(shares)), shares, lambda value: f"{100 * value:.1f} % of its angle bins"
            )
            share = float(which.sum() / max(1, of.sum()))
            yield self._measure(name, share, f"{_percent(which.sum(), of.sum())} {told}", spots)

    def _end(self, row: int, angle_bin: int) -> tuple[float, float]:
        """Where the end of either side lies, the result's if it has one [m, map frame]."""
        for ranges, centre in (
            (self._pair.found, self._pair.centres[row]),
            (self._pair.expected, self._pair.centres[row] + self._pair.apart[row]),
        ):
            if np.isfinite(ranges[row, angle_bin]):
                x, y = ends(ranges[row : row + 1])
                return float(x[0, angle_bin] + centre[0]), float(y[0, angle_bin] + centre[1])
        raise ValueError("neither side has an end there")

    def _measure(self, name: str, value: float, text: str, spots: tuple[Spot, ...] = ()) -> Measure:
        return Measure(name, self._level, value, self._allowed[name], TOLERANCES[name].unit, text, spots)


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / max(1, whole):.2f} %"


def _surface(place: MovedPlace) -> str:
    if not math.isfinite(place.distance):
        return f"{place.ends} ends without a counterpart"
    return f"{place.ends} ends off by {place.distance:.2f} m"


def _nodes(numbers: Sequence[int]) -> str:
    shown = ", ".join(map(str, numbers[:3]))
    return f"nodes {shown} and {len(numbers) - 3} more" if len(numbers) > 3 else f"nodes {shown}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
