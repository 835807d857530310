"""Whether a missing return means free space: a test of the recording on itself.

A beam comes back to nobody not only from open space but also from glass, from mirrors and from dark walls hit
at a grazing angle. So the test asks how many of the beams without a return pass through places that finite
ranges of the other scans show to be solid. Where that share is high, a missing return is no evidence.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from timemap_cli.model.elementary import cos_sin
from timemap_cli.model.sweeps import Sweeps

CELL = 0.05  # [m] finer than a wall is thick, coarser than the noise of a scanner
STEP = 0.02  # [m] along a beam that is tested
DEEP = 3  # steps in a row within solid cells: a beam that only cuts a corner passes by
SIDE = 2048  # cells; places so many cells apart share one, which is rare enough for a share
FIRM_SCANS = 3  # scans that hit a cell before it counts as solid
MOST_BEAMS = 2000  # missing returns that are looked at
PASSING_BEAMS = 60  # of a scan, that show what is not solid
THRESHOLD = 0.3  # share of contradicted beams above which a missing return is no evidence
ENOUGH = 50  # beams below which nothing is said

Int64s = NDArray[np.int64]
Float64s = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MissingReturns:
    """What the test found for one scan topic."""

    beams: int  # missing returns looked at
    contradicted: float | None  # share of them that pass through something solid; None: too few to tell

    def __add__(self, other: "MissingReturns") -> "MissingReturns":
        """What both tests found together."""
        if self.contradicted is None or other.contradicted is None:
            return other if self.contradicted is None else self
        beams = self.beams + other.beams
        share = (self.beams * self.contradicted + other.beams * other.contradicted) / beams
        return MissingReturns(beams, share)

    @property
    def are_clear(self) -> bool:
        """Whether a missing return counts as free space; it does where there is nothing against it."""
        return self.contradicted is None or self.contradicted <= THRESHOLD


def examine(sweeps: Sequence[Sweeps], radius: float) -> MissingReturns:
    """Test the missing returns (`+inf`) of some scans against their hits, out to `radius` or the clear range.

    `radius` is in m. Scans of one place that were taken one after the other are needed, a dozen at least.
    """
    beams = sum(int(np.count_nonzero(np.isposinf(block.ranges))) for block in sweeps)
    if beams < ENOUGH:
        return MissingReturns(beams, None)
    solid = _solid_cells(sweeps, radius)
    every = max(1, beams // MOST_BEAMS)
    contradicted, looked_at = 0, 0
    for block in sweeps:
        scan, beam = np.nonzero(np.isposinf(block.ranges))
        scan, beam = scan[::every], beam[::every]
        steps = np.arange(CELL, min(radius, block.clear_range), STEP)
        origins, directions = _rays(block)
        points = origins[scan, None] + directions[scan, beam, None] * steps[:, None]
        inside = solid[_cells(points)]
        contradicted += int(np.count_nonzero(_have_runs(inside, DEEP)))
        looked_at += len(scan)
    return MissingReturns(beams, contradicted / looked_at)


def _have_runs(inside: NDArray[np.bool_], length: int) -> NDArray[np.bool_]:
    """Which rows (n,) of a table (n, steps) hold so many True in a row."""
    last = inside.shape[1] - length + 1
    runs = inside[:, : max(0, last)].copy()
    for shift in range(1, length):
        runs &= inside[:, shift : shift + runs.shape[1]]
    found: NDArray[np.bool_] = np.any(runs, axis=1)
    return found


def _solid_cells(sweeps: Sequence[Sweeps], radius: float) -> NDArray[np.bool_]:
    """Cells that several scans hit and that beams hit more often than they pass."""
    hits = np.concatenate([_hit_cells(block, radius) for block in sweeps])
    every = max(1, max(block.ranges.shape[1] for block in sweeps) // PASSING_BEAMS)
    passed = np.concatenate([_passed_cells(block, radius, every) for block in sweeps])
    cells, n_hits = np.unique(hits, return_counts=True)
    cells, n_hits = cells[n_hits >= FIRM_SCANS], n_hits[n_hits >= FIRM_SCANS]
    solid = np.zeros(SIDE * SIDE, dtype=bool)
    solid[cells] = True
    passed = np.searchsorted(cells, passed[solid[passed]])
    # Steps are two cells long and only some of the beams are followed.
    n_passes = np.bincount(passed, minlength=len(cells)) * (2 * every)
    solid[cells[n_hits < n_passes]] = False
    return solid


def _hit_cells(block: Sweeps, radius: float) -> Int64s:
    """Cells in which beams end, each once per scan."""
    origins, directions = _rays(block)
    scan, beam = np.nonzero(block.ranges < radius)
    ends = origins[scan] + directions[scan, beam] * block.ranges[scan, beam, None]
    return np.unique(scan * (SIDE * SIDE) + _cells(ends)) % (SIDE * SIDE)


def _passed_cells(block: Sweeps, radius: float, every: int) -> Int64s:
    """Cells that every so many-th beam with a hit passes, in steps of two cells."""
    origins, directions = _rays(block)
    # The last 0.2 m before a hit are its surroundings, not free space.
    free = np.minimum(block.ranges[:, ::every], radius) - 0.2
    counts = np.where(np.isfinite(free) & np.isfinite(block.ranges[:, ::every]), free / (2 * CELL), 0)
    counts = np.maximum(counts, 0).astype(np.int64)
    scan, beam = np.nonzero(counts)
    repeats = counts[scan, beam]
    starts = np.cumsum(repeats) - repeats
    steps = (np.arange(repeats.sum()) - np.repeat(starts, repeats)) * (2 * CELL) + CELL
    rays = np.repeat(np.arange(len(scan)), repeats)
    return _cells(origins[scan][rays] + directions[scan, beam * every][rays] * steps[:, None])


def _rays(block: Sweeps) -> tuple[Float64s, Float64s]:
    """Where the beams begin (n, 2) [m] and where they go (n, beams, 2), seen from above.

    Products one by one: how a matrix product rounds is up to the machine.
    """
    map_from_laser = block.map_from_laser_first
    cos, sin = cos_sin(block.bearings)
    along_x, along_y = (map_from_laser[:, None, :2, axis] for axis in (0, 1))
    return map_from_laser[:, :2, 3], along_x * cos[:, None] + along_y * sin[:, None]


def _cells(points: Float64s) -> Int64s:
    """Numbers (...) of the cells of points (..., 2) [m]."""
    places = np.floor(points * (1 / CELL)).astype(np.int64) & (SIDE - 1)
    cells: Int64s = places[..., 0] * SIDE + places[..., 1]
    return cells
