"""What really changed in the building, for people and tests to compare with."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sample_logs.drives import Drive
from sample_logs.world import Thing


def truth(drives: Mapping[str, Drive], things: Sequence[Thing], first_ns: int) -> dict[str, Any]:
    """The recordings, the changes and who walked, as JSON values.

    Times are strings of nanoseconds, lengths metres in the map frame; the times of `things` are seconds
    since `first_ns`. A change that no recording shows happening lies between two recordings.
    """
    recordings = {
        name: (d.start_ns, d.start_ns + round(d.motion.duration * 1e9)) for name, d in drives.items()
    }
    changes = [_change(old, new, first_ns, recordings) for old, new in _pairs(things)]
    return {
        "schema": "timemap.samples/1",
        "frame": "map",
        "recordings": [
            {"file": name, "start_ns": str(start), "end_ns": str(end), "walked": _walked(drives[name])}
            for name, (start, end) in recordings.items()
        ],
        "changes": sorted(changes, key=lambda change: (int(change["at_ns"]), change["what"])),
        "stays": [{"what": t.name, "bounds": _bounds(t)} for t in things if not _changes(t)],
    }


def _changes(thing: Thing) -> bool:
    return bool(np.isfinite(thing.since) or np.isfinite(thing.until))


def _pairs(things: Sequence[Thing]) -> list[tuple[Thing | None, Thing | None]]:
    """Old and new place of everything that changed; None: not there."""
    moving = [thing for thing in things if _changes(thing)]
    pairs: list[tuple[Thing | None, Thing | None]] = []
    for thing in moving:
        if np.isfinite(thing.until):
            pairs.append((thing, _follower(thing, moving)))
        if np.isfinite(thing.since) and not any(_follower(other, moving) is thing for other in moving):
            pairs.append((None, thing))
    return pairs


def _follower(thing: Thing, things: Sequence[Thing]) -> Thing | None:
    return next((t for t in things if t.name == thing.name and t.since == thing.until), None)


def _change(
    old: Thing | None, new: Thing | None, first_ns: int, recordings: Mapping[str, tuple[int, int]]
) -> dict[str, Any]:
    time = new.since if new is not None else old.until if old is not None else np.nan
    at_ns = first_ns + round(time * 1e9)
    before = [name for name, (start, _) in recordings.items() if start <= at_ns]
    after = [name for name, (_, end) in recordings.items() if end >= at_ns]
    thing = new or old
    return {
        "what": thing.name if thing is not None else "",
        "kind": "moved" if old and new else "appeared" if new else "vanished",
        "at_ns": str(at_ns),
        "between": [before[-1], after[0]],
        "from": _bounds(old) if old else None,
        "to": _bounds(new) if new else None,
    }


def _bounds(thing: Thing) -> dict[str, float]:
    names = ("x_min", "y_min", "x_max", "y_max")
    return {name: round(value, 3) for name, value in zip(names, thing.bounds, strict=True)}


def _walked(drive: Drive) -> list[dict[str, Any]]:
    return [
        {
            "who": walk.name,
            "from_ns": str(drive.start_ns + round(walk.times[0] * 1e9)),
            "to_ns": str(drive.start_ns + round(walk.times[-1] * 1e9)),
            "x_min": float(walk.positions[:, 0].min()),
            "y_min": float(walk.positions[:, 1].min()),
            "x_max": float(walk.positions[:, 0].max()),
            "y_max": float(walk.positions[:, 1].max()),
        }
        for walk in drive.world.walks
    ]
