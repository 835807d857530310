"""Things told as changes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from timemap_cli.changes.difference import Change, Kind, Sector
from timemap_cli.changes.rings import Floats
from timemap_cli.changes.runs import Run
from timemap_cli.changes.sides import Side
from timemap_cli.changes.things import Thing
from timemap_cli.model.elementary import lengths


class Teller:
    """Tells what differs between two sides."""

    def __init__(self, before: Side, after: Side) -> None:
        self._before = before
        self._after = after

    def one(self, kind: Kind, thing: Thing) -> Change:
        """A thing that appeared or vanished."""
        x, y = thing.points.mean(axis=0).tolist()
        x_min, y_min = thing.points.min(axis=0).tolist()
        x_max, y_max = thing.points.max(axis=0).tolist()
        came = kind is Kind.APPEARED
        having, lacking = (self._after, self._before) if came else (self._before, self._after)
        sectors = [_sector(run, lacking, came=came) for run in thing.passed]
        return Change(
            kind,
            x,
            y,
            (x_min, y_min, x_max, y_max),
            min(_support(thing.runs, having), _support(thing.passed, lacking)),
            tuple(sorted(sectors, key=lambda sector: (sector.node, sector.start_bin))),
            thing.points,
            thing.alone,
        )

    def moved(self, gone: Thing, come: Thing) -> Change:
        """A thing that left one place for another."""
        here, there = self.one(Kind.APPEARED, come), self.one(Kind.VANISHED, gone)
        sectors = sorted(here.sectors + there.sectors, key=lambda sector: (sector.node, sector.start_bin))
        return replace(
            here,
            kind=Kind.MOVED,
            support=min(here.support, there.support),
            sectors=tuple(sectors),
            moved_from=(there.x, there.y),
            points_before=there.points,
        )


def _sector(run: Run, lacking: Side, *, came: bool) -> Sector:
    """Where a node of the side without the thing looks past its surface."""
    surface = _lower_median(lengths(run.points - lacking.places.centres[run.row]))
    beyond = _lower_median(lacking.rings.ranges[run.row, run.bins])
    return Sector(
        node=int(lacking.places.numbers[run.row]),
        start_bin=int(run.bins[0]),
        stop_bin=int(run.bins[-1]) + 1,
        range_from_m=beyond if came else surface,
        range_to_m=surface if came else beyond,
    )


def _support(runs: Sequence[Run], side: Side) -> float:
    return float(np.concatenate([side.rings.support[run.row, run.bins] for run in runs]).mean())


def _lower_median(ranges: Floats) -> float:
    return float(np.sort(ranges)[(len(ranges) - 1) // 2])
