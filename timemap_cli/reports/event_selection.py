"""Which change events of a document are wanted, and in what order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from timemap_cli.model.ordering import to_order

Event = Mapping[str, Any]  # as in the document of the schema timemap.changes/1


@dataclass(frozen=True, slots=True)
class EventSelection:
    """What is asked of an event; None or empty asks nothing."""

    kinds: Sequence[str] = ()
    levels: Sequence[str] = ()  # adopted by all of these
    since_ns: int | None = None  # held at some time from here ...
    until_ns: int | None = None  # ... to before here
    region: tuple[float, float, float, float] | None = (
        None  # [m] x_min, y_min, x_max, y_max: meets its bounds
    )
    min_size_m: float = 0.0  # diagonal of the bounds
    min_age_ns: int = 0  # from its first to its last sighting
    holding: bool = False  # only what still holds

    def keeps(self, event: Event) -> bool:
        """Whether an event is wanted."""
        return (
            (not self.kinds or event["kind"] in self.kinds)
            and all(event["adopted"].get(level) is not None for level in self.levels)
            and self._is_in_time(event)
            and (self.region is None or _meet(self.region, event["bounds"]))
            and size_m(event) >= self.min_size_m
            and int(event["last_seen_ns"]) - int(event["first_seen_ns"]) >= self.min_age_ns
            and not (self.holding and event["closed_ns"] is not None)
        )

    def _is_in_time(self, event: Event) -> bool:
        return any(
            (self.until_ns is None or int(episode["since_ns"]) < self.until_ns)
            and (
                self.since_ns is None
                or episode["until_ns"] is None
                or int(episode["until_ns"]) > self.since_ns
            )
            for episode in event["episodes"]
        )


ORDERS: Mapping[str, Callable[[Event], Any]] = {
    "time": lambda event: (int(event["first_seen_ns"]), event["id"]),
    "size": lambda event: (-to_order(size_m(event)), event["id"]),
    "support": lambda event: (-to_order(event["support"]), event["id"]),
    "place": lambda event: (to_order(event["x"]), to_order(event["y"]), event["id"]),
}


def selected(events: Sequence[Event], wanted: EventSelection, order: str) -> list[Event]:
    """The wanted events in one of ORDERS."""
    return sorted((event for event in events if wanted.keeps(event)), key=ORDERS[order])


def size_m(event: Event) -> float:
    """Diagonal of an event's bounds [m]."""
    from timemap_cli.model.elementary import distance  # NumPy, which --help can do without

    x_min, y_min, x_max, y_max = event["bounds"]
    return distance(x_max - x_min, y_max - y_min)


def _meet(one: Sequence[float], other: Sequence[float]) -> bool:
    return one[0] <= other[2] and other[0] <= one[2] and one[1] <= other[3] and other[1] <= one[3]
