"""Fig. 7, "previously unseen parts are included immediately": what a level had never seen, or not of this object."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import chosen
from benchmarks.paper.metrics import STEP, apart
from benchmarks.paper.rooms import arc
from benchmarks.paper.scene import ANGLE_BINS, ROUND_ROOM, look, truth
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.watched import LONG, MID, Watched, drawn, old_history
from benchmarks.paper.words import scans
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level
from timemap_cli.model.virtual_scan import Ranges

NODES = 12
PARTS = {
    "of the room": "never seen by the node",
    "of the object": "hidden since it came, the wall seen before",
}
_NAMES = ("ours", "profile: paper", "caption, states from data", "vote without pairs", "median per angle bin")
_OBJECT = (30, 70)  # angle bins
_UNSEEN = (50, 70)  # of them, with three more on the side that goes on
_LOOKED = 100  # scans with the part in view
_MARGIN = 2  # angle bins at an edge of the object that may show either side

Bools = npt.NDArray[np.bool_]


def run(scale: Scale) -> Section:
    """A part that comes into view, at a level that takes every scan and at one that takes one in four."""
    levels = scale.pick((MID, LONG), (MID,))
    found = {(level.name, part): measured(level, part) for level in levels for part in PARTS}
    rows = [
        (name, *(" / ".join(map(scans, _delays(one[name]))) for one in found.values())) for name in _NAMES
    ]
    return Section(
        "Fig. 7: parts that were never seen",
        (
            "The paper says of Fig. 7 that *previously unseen parts are included immediately*. 20 angle bins come into "
            "view for the first time. *Of the room*: the node had never seen anything there, for five half-lives. *Of "
            "the object*: an object came five half-lives ago, and this part of it was hidden ever since; what is "
            "remembered there is the wall behind it. Given is after how many scans 90 % of the 20 angle bins show what "
            f"is there, in the median of {NODES} nodes and in the slowest of them; never: not in {_LOOKED} scans. Mid "
            "takes every scan; long takes one "
            "in four, and can show nothing before it takes one.",
        ),
        (Table(("median / slowest [scans]", *(f"{level}: {part}" for level, part in found)), rows),),
        (),
        {
            f"{level} {part} {name}": _delays(one[name])[0]
            for (level, part), one in found.items()
            for name in ("ours", "vote without pairs")
        },
    )


def measured(level: Level, part: str) -> Mapping[str, Floats]:
    """Scans (NODES,) until the part is shown, by definition; NaN: not within _LOOKED."""
    random = np.random.default_rng(17)
    world = np.concatenate((ROUND_ROOM, arc(*_OBJECT)))
    room, whole = look(ROUND_ROOM, 200, random), look(world, 200, random)
    history = old_history(level)
    watched = Watched(level, NODES, chosen(*_NAMES))
    if part == "of the object":
        watched.learn(drawn(room.virtual(), history, NODES, random))
        before, after, true = whole, whole, truth(world)
    else:
        before, after, true = room, room, truth(ROUND_ROOM)
    watched.learn(_parts(before.hiding(_unseen(3)).virtual(), history, random))
    seen = watched.follow(_parts(after.virtual(), _LOOKED, random), every=1)
    return {name: _delay(one, true) for name, one in seen.items()}


def _parts(pool: Ranges, n: int, random: np.random.Generator) -> Ranges:
    return drawn(pool, n, NODES, random)


def _unseen(beyond: int) -> Bools:
    """Angle bins (ANGLE_BINS,) that come into view, and so many more where the object ends."""
    place = np.arange(ANGLE_BINS)
    return (place >= _UNSEEN[0]) & (place < _UNSEEN[1] + beyond)


def _delay(seen: Floats, true: Floats) -> Floats:
    """Scans (nodes,) until 90 % of the unseen angle bins are within STEP of the truth; NaN never."""
    judged = _unseen(-_MARGIN)
    right = apart(seen[..., judged], true[judged]) <= STEP
    done = right.mean(axis=2) >= 0.9
    return np.where(done.any(axis=0), done.argmax(axis=0) + 1.0, np.nan)


def _delays(delays: Floats) -> tuple[float, float]:
    """Median and slowest; a node that never shows it is the slowest of all."""
    ordered = np.sort(np.where(np.isnan(delays), np.inf, delays))
    found = ordered[len(ordered) // 2], ordered[-1]
    return float(np.where(np.isinf(found[0]), np.nan, found[0])), float(
        np.where(np.isinf(found[1]), np.nan, found[1])
    )
