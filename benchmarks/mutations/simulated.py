"""The clean recording: a robot that goes through a building of four rooms and a corridor, while something changes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from sample_logs.building import TUESDAY, building, patrol, walk
from sample_logs.drives import Drive, Rates
from sample_logs.make_samples import FIRST_NS, FRONT, write
from sample_logs.world import Thing


def simulated(
    path: Path, *, rounds: int = 2, seed: int = 1, moved: str = "", by: tuple[float, float] = (0, 0)
) -> None:
    """Write it as an MCAP file; another seed is other noise of scanner, odometry and localisation.

    The object `moved` stands `by` so much [m] from where it stands else.
    """
    walks = (
        walk("colleague", 15.0, 1.0, (11.5, 3.6), (4.0, 3.6), (0.5, 3.6)),
        walk("courier", 36.0, 1.2, (0.5, 4.5), (4.9, 4.3), (4.9, 4.3), (0.5, 4.5)),
    )
    world = building(TUESDAY, walks)
    world = replace(world, things=_moved(world.things, moved, by))
    scanner = replace(FRONT, period=0.1, sweep_time=0.07, missing=0.02)
    start_ns = FIRST_NS + round(TUESDAY * 1e9)
    write(path, Drive(world, patrol(rounds), scanner, Rates(20.0, 5.0), start_ns, seed=seed))


def _moved(things: Sequence[Thing], name: str, by: tuple[float, float]) -> list[Thing]:
    return [replace(one, outline=one.outline + np.array(by)) if one.name == name else one for one in things]
