"""Which remembered ranges of an angle bin are the same surface: states found in the data, without fixed borders.

Fixed range bins split a surface that stands on their border in two and halve its weight; see docs/method.md.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from timemap_cli.model.elementary import logarithms
from timemap_cli.model.memory import Remembered
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Ranges

Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Stretched = npt.NDArray[np.int32]

MAX_STATES = 24  # of one angle bin; on real recordings at most 20, the 99th percentile at most 10
STRETCH_FROM = 1.6  # [m] beyond, surfaces may be farther apart in proportion to their range
_UNIT = 1e-4  # [m] of the stretched scale
_CLEAR_PLACE, _UNSEEN_PLACE = 1 << 22, 1 << 23  # on that scale, beyond every range


@dataclass(frozen=True, slots=True)
class States:
    """The angle bins of m nodes that may show more than one thing.

    State i of a row holds the ranges from borders[i] up to but without borders[i + 1].
    """

    rows: Ints  # (rows,) node * angle_bins + angle bin, ascending
    borders: Ranges  # (rows, states + 1) [mm] ascending, the first 0; UNSEEN from the last one on
    known: Ranges  # (rows, most) [mm] all ranges known of these angle bins, ascending, then UNSEEN

    @property
    def size(self) -> int:
        """The most states that any row has."""
        return int(self.borders.shape[1]) - 1

    @property
    def exists(self) -> Bools:
        """(rows, states) which states there are."""
        return self.borders[:, :-1] < UNSEEN

    def span(self, rows: Ints, state: Ints) -> tuple[Ranges, Ranges]:
        """Where one state of each of these rows begins and ends (k, 1) [mm], the end excluded."""
        return self.borders[rows, state, None], self.borders[rows, state + 1, None]

    def labels(self, values: Ranges, rows: Ints) -> npt.NDArray[np.unsignedinteger]:
        """Number of the state of each value (k, n) of these rows; what UNSEEN gets means nothing."""
        borders = self.borders[rows]
        if self.size == 1:
            return np.zeros(values.shape, np.uint8)
        label: npt.NDArray[np.unsignedinteger] = (values >= borders[:, 1:2]).astype(
            np.min_scalar_type(self.size)
        )
        for state in range(2, self.size):
            more = np.flatnonzero(borders[:, state] < UNSEEN)  # ever fewer
            label[more] += values[more] >= borders[more, state, None]
        return label


def known_ranges(memory: Remembered, rows: Ints) -> Ranges:
    """All ranges (rows, most) [mm] that are known of these angle bins, ascending, then UNSEEN.

    They are its samples, the left ends of its pairs, and the right ends of the pairs of the angle bin before.
    """
    angle_bins = memory.samples.shape[1]
    before = rows - 1 + angle_bins * (rows % angle_bins == 0)
    stores, at = (memory.samples, memory.left, memory.right), (rows, rows, before)
    parts = [store.reshape(-1, store.shape[2])[where] for store, where in zip(stores, at, strict=True)]
    return ascending(np.concatenate(parts, axis=1))


def how_many_known(memory: Remembered) -> Ints:
    """Number (m * angle_bins,) of ranges that are known of each angle bin."""
    return (memory.n_samples + memory.n_pairs + np.roll(memory.n_pairs, 1, axis=1)).reshape(-1)


def ascending(ranges: Ranges) -> Ranges:
    """Rows of ranges, each sorted. As 32-bit numbers: few processors sort 16-bit ones by more than one at a time."""
    wide = ranges.astype(np.uint32)
    wide.sort(axis=1)
    return wide.astype(np.uint16)


def states_from_data(memory: Remembered, width: float) -> States:
    """Group all that the memory knows of each angle bin, samples and the ends of its pairs, into surfaces.

    Ranges farther apart than width / 2 [m] are different surfaces. A group wider than 2 * width is no surface: its
    densest window of one width is cut out, and again from the rests. Beyond STRETCH_FROM all widths grow with range.
    """
    size = round(width / _UNIT)
    rows = _spread_out(memory, size)
    known, n_known = known_ranges(memory, rows), how_many_known(memory)[rows]
    place = _stretched().take(known)
    cut = place[:, 1:] - place[:, :-1] > size // 2
    cut &= known[:, 1:] < UNSEEN
    _cut_wide_groups(cut, place, n_known, size)
    split = np.flatnonzero(cut.any(axis=1))
    return States(rows[split], _borders(known[split], cut[split], place[split]), known[split])


def _spread_out(memory: Remembered, size: int) -> Ints:
    """Angle bins whose known ranges may lie so far apart that there is a cut; most do not, and need no sorting.

    The stretched scale grows ever slower with range, so two ranges are no farther apart on it than its slope at the
    nearest range makes them. Clear is a state of its own, however near to it a range is.
    """
    stores = (memory.samples, memory.left, np.roll(memory.right, 1, axis=1))
    extremes = [_extremes(store.reshape(-1, store.shape[2])) for store in stores]
    nearest = np.minimum.reduce([near for near, _ in extremes])
    beyond = np.maximum.reduce([beyond for _, beyond in extremes])
    apart = beyond - np.minimum(nearest, beyond)
    widening = np.maximum(1, nearest / (STRETCH_FROM * 1000))
    also_clear = (beyond == CLEAR + 1) & (nearest < CLEAR)
    return np.flatnonzero(also_clear | (apart > widening * (size // 2 - 1) * _UNIT * 1000))


def _extremes(ranges: Ranges) -> tuple[Ranges, Ranges]:
    """The nearest of each row (rows,) [mm], and one more than the farthest; UNSEEN does not count."""
    columns = np.ascontiguousarray(ranges.T)  # NumPy is slow at short rows
    return columns.min(axis=0), (columns + np.uint16(1)).max(axis=0)  # UNSEEN + 1 is 0


def _borders(known: Ranges, cut: Bools, place: Stretched) -> Ranges:
    """Borders of the states (rows, states + 1); where there are too many, the smallest gaps are closed again."""
    crowded = np.flatnonzero(cut.sum(axis=1) >= MAX_STATES)
    for row in crowded:  # rare: a laser that returns noise
        gaps = np.where(cut[row], np.diff(place[row]), -1)
        cut[row] = False
        cut[row, np.argsort(-gaps, kind="stable")[: MAX_STATES - 1]] = True
    return borders_at(known, cut)


def borders_at(known: Ranges, cut: Bools) -> Ranges:
    """Borders of states (rows, states + 1) from ascending ranges (rows, k) and where they are cut (rows, k - 1)."""
    row, column = np.nonzero(cut)
    number = np.arange(1, len(row) + 1) - np.searchsorted(row, row)  # 1, 2, ... within each row
    borders = np.full((len(known), int(number.max(initial=0)) + 2), UNSEEN, np.uint16)
    borders[:, 0] = 0
    borders[row, number] = known[row, column + 1]
    return borders


def _cut_wide_groups(cut: Bools, place: Stretched, count: Ints, size: int) -> None:
    """Cut groups wider than two sizes into windows of one size, densest first, in place.

    All such groups are worked on at once; each round takes one window out of every group that is still too wide.
    """
    wide = _groups_wider_than(2 * size, cut, place, count)
    while len(wide):
        row, start, stop = wide.T
        begin, end = _densest_windows(place, wide, size)
        before, after = begin > start, end < stop
        cut[row[before], begin[before] - 1] = True
        cut[row[after], end[after] - 1] = True
        rests = np.concatenate(
            (np.stack((row, start, begin), 1)[before], np.stack((row, end, stop), 1)[after])
        )
        wide = rests[place[rests[:, 0], rests[:, 2] - 1] - place[rests[:, 0], rests[:, 1]] > size]


def _groups_wider_than(limit: int, cut: Bools, place: Stretched, count: Ints) -> Ints:
    """Groups (k, 3): row, first column and one past the last, of those that span more than `limit`."""
    span = place[np.arange(len(place)), np.maximum(count, 1) - 1] - place[:, 0]
    rows = np.flatnonzero(span > limit)  # most angle bins end here
    row, column = np.nonzero(cut[rows])
    row, start = np.append(np.arange(len(rows)), row), np.append(np.zeros(len(rows), np.int64), column + 1)
    order = np.lexsort((start, row))
    row, start = rows[row[order]], start[order]
    stop = np.append(start[1:], 0)
    final = np.append(row[1:] != row[:-1], True)[: len(row)]
    stop = np.where(final, count[row], stop[: len(row)])
    wide = place[row, stop - 1] - place[row, start] > limit
    return np.stack((row[wide], start[wide], stop[wide]), 1)


def _densest_windows(place: Stretched, groups: Ints, size: int) -> tuple[Ints, Ints]:
    """First column and one past the last of each group's window of one size with the most ranges; ties: the nearest."""
    row, start, stop = groups.T
    length = stop - start
    owner = np.repeat(np.arange(len(groups)), length)
    column = np.arange(len(owner)) + np.repeat(stop - np.cumsum(length), length)
    apart = np.int64(4 * _CLEAR_PLACE)
    key = place[row[owner], column] + owner * apart
    inside = np.searchsorted(key, key + size, side="right") - np.arange(len(key))
    first = np.cumsum(length) - length
    most = np.maximum.reduceat(inside, first)
    fullest = np.flatnonzero(inside == np.repeat(most, length))
    best = fullest[np.searchsorted(fullest, first)]
    return column[best], column[best] + inside[best]


@cache
def _stretched() -> Stretched:
    """Place of each range [mm] on a scale [_UNIT] on which surfaces of any range are equally wide."""
    bend = round(STRETCH_FROM * 1000)
    mm = np.arange(CLEAR, dtype=np.float64)
    beyond = STRETCH_FROM * (1 + logarithms(np.maximum(mm, bend) / bend))
    metres = np.where(mm <= bend, mm / 1000, beyond)
    return np.append(np.rint(metres / _UNIT), (_CLEAR_PLACE, _UNSEEN_PLACE)).astype(np.int32)
