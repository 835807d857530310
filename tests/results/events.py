"""Change events by hand, and a room in which some happen."""

from pathlib import Path

import numpy as np

from tests.results.rooms import CHANGES, CONFIG, NODES, REPORT, SECOND, T0, all_levels, new_writer
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Episode, Event, Transition, Turn

SQUARE = np.array([[1.0, 2.0], [2.0, 2.0], [2.0, 3.0], [1.0, 3.0]])


def event(number: int = 7, *, kind: Kind = Kind.APPEARED, until_ns: int | None = None, **values) -> Event:
    """A thing with its corners at SQUARE, seen by node 0 since T0, and undone at a time, or not."""
    told = {
        "id": number,
        "kind": kind,
        "points": SQUARE,
        "moved_from": None,
        "support": 0.75,
        "first_seen_ns": T0,
        "last_seen_ns": T0 + SECOND,
        "looked_ns": T0 + 2 * SECOND,
        "adopted": {"short": T0, "mid": None, "long": None},
        "nodes": (0,),
        "against": (),
        "episodes": (Episode(T0, until_ns),),
        "looks": 4,
        "looks_held": 3,
    }
    return Event(**(told | values))


def write_changing_room(path: Path) -> None:
    """Event 0 comes, then event 1 while event 0 goes, then event 1 is adopted."""
    first, second = event(0), event(1, kind=Kind.MOVED, moved_from=(4.0, 1.0))
    gone = event(0, until_ns=T0 + 10 * SECOND)
    rounds = [
        ([Transition(Turn.SEEN, first)], [first]),
        ([Transition(Turn.CLOSED, gone), Transition(Turn.SEEN, second)], [gone, second]),
        ([Transition(Turn.ADOPTED, second, "mid")], [gone, second]),
    ]
    with new_writer(path) as writer:
        for step, (found, events) in enumerate(rounds):
            now_ns = T0 + 10 * SECOND * step
            writer.write_nodes(NODES, now_ns)
            writer.write_estimates(all_levels(0, now_ns, seed=step), now_ns)
            writer.write_changes(found, events, now_ns)
        writer.finish({}, CONFIG, REPORT, CHANGES)
