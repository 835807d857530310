"""What the nodes were told of a drive, held against the world it went through."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from benchmarks.forward.drives import BLOCK, Driven, Place
from sample_logs.rays import Floats
from timemap_cli.model.gate import Gate
from timemap_cli.model.observer import Observations, Observer
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Ranges

ANGLE_BINS, RADIUS, SPACING = 360, 10.0, 1.0
RAYS = 3  # to an angle bin
JUDGED_EVERY = 0.2  # [s] more scans say the same
STEP, STEP_SHARE = 0.2, 0.03  # [m] by which a range is wrong, or a share of it


@dataclass(frozen=True, slots=True)
class Score:
    """What became of the scans of one drive."""

    scans: int
    nodes: int
    not_seen: int  # scans that were lost: node_not_seen
    behind_walls: int  # scans that judged a node behind a wall, or a thing
    judged: int  # scans that were held against the truth
    known: int  # angle bins that these know
    wrong_hits: int  # of these, ranges at which nothing stands
    wrong_clear: int  # and those told as clear though something stands there

    @property
    def learnt(self) -> float:
        """Share of the scans."""
        return 1 - self.not_seen / self.scans


def score(place: Place, drive: Driven) -> Score:
    """Observe a drive as a replay does, in blocks, and judge what the nodes were told."""
    observer = Observer(Gate(0.05, 0.1, 0), angle_bins=ANGLE_BINS, radius=RADIUS, spacing=SPACING)
    every = max(1, round(JUDGED_EVERY / np.median(np.diff(drive.times))))
    not_seen = behind = judged = known = wrong_hits = wrong_clear = 0
    for rows, seen in _observed(observer, drive):
        not_seen += seen.node_not_seen
        at = rows.start + np.searchsorted(drive.sweeps.stamps_ns[rows], seen.stamps_ns)
        centres = np.array([(node.x, node.y) for node in observer.nodes])[seen.nodes].reshape(-1, 2)
        behind += _behind_walls(place, drive.lasers[at], centres, drive.times[at])
        some = np.flatnonzero(at % every == 0)
        hits, clear = _wrong(seen.ranges[some], place, centres[some], drive.times[at[some]])
        judged += int(np.sum(np.arange(rows.start, rows.stop) % every == 0))
        known += int(np.sum(seen.ranges[some] != UNSEEN))
        wrong_hits, wrong_clear = wrong_hits + hits, wrong_clear + clear
    return Score(
        len(drive.times), len(observer.nodes), not_seen, behind, judged, known, wrong_hits, wrong_clear
    )


def _observed(observer: Observer, drive: Driven) -> Iterator[tuple[slice, Observations]]:
    for start in range(0, len(drive.times), BLOCK):
        rows = slice(start, min(start + BLOCK, len(drive.times)))
        yield rows, observer.observe(drive.sweeps.rows(rows))


def _wrong(ranges: Ranges, place: Place, centres: Floats, times: Floats) -> tuple[int, int]:
    """How many ranges, and how many clear angle bins, the world refutes."""
    if not len(ranges):
        return 0, 0
    nearest, farthest = _truth(place, centres, times)
    metres = ranges / 1000.0
    step = np.maximum(STEP, STEP_SHARE * np.minimum(metres, RADIUS))
    hit = ranges < CLEAR
    off = (metres < nearest - step) | (metres > farthest + step)
    shut = (ranges == CLEAR) & (farthest < RADIUS - 2 * step)
    return int(np.sum(hit & off)), int(np.sum(shut))


def _truth(place: Place, centres: Floats, times: Floats) -> tuple[Floats, Floats]:
    """Nearest and farthest (n, angle_bins) [m] that stands in each angle bin and the two beside it."""
    bearings = np.arange(ANGLE_BINS * RAYS) * (2 * np.pi / ANGLE_BINS / RAYS)
    n = len(centres)
    origins = np.broadcast_to(centres[:, None], (n, len(bearings), 2))
    rays = place.world.ranges(times, origins, np.broadcast_to(bearings, (n, len(bearings))), 1.5 * RADIUS)
    rays = rays.reshape(n, ANGLE_BINS, RAYS)
    nearest, farthest = rays.min(axis=2), rays.max(axis=2)
    beside = (-1, 0, 1)
    return (
        np.minimum.reduce([np.roll(nearest, by, axis=1) for by in beside]),
        np.maximum.reduce([np.roll(farthest, by, axis=1) for by in beside]),
    )


def _behind_walls(place: Place, lasers: Floats, centres: Floats, times: Floats) -> int:
    """How many scans have something that stands still between the laser and the node."""
    if not len(lasers):
        return 0
    still = type(place.world)(place.world.walls, place.world.things)
    way = centres - lasers
    bearings: npt.NDArray[np.float64] = np.arctan2(way[:, 1], way[:, 0])[:, None]
    free = still.ranges(times, lasers[:, None], bearings, 3.0)[:, 0]
    return int(np.sum(free < np.hypot(way[:, 0], way[:, 1])))
