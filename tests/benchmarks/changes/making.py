"""Small truths and events by hand: five patrols at 100, 200, ... 500 s, each 50 s long."""

from benchmarks.changes.places import Event
from benchmarks.changes.truth import Bounds, Episode, Outline, Recorded, TrueChange, Truth, Walked

S = 1_000_000_000


def square(x: float, y: float, size: float = 1.0) -> Outline:
    """Corners of a square with its lower left corner at x, y."""
    return ((x, y), (x + size, y), (x + size, y + size), (x, y + size))


def change(
    kind: str, outline: Outline, *episodes: tuple[int, int | None], origin: Outline | None = None
) -> TrueChange:
    """A change that holds from and until so many seconds."""
    spans = tuple(Episode(a * S, None if b is None else b * S) for a, b in episodes)
    return TrueChange("thing", kind, outline, origin, spans)


def truth(*changes: TrueChange, walked: tuple[Walked, ...] = ()) -> Truth:
    """Five patrols; all who walked did so in the third."""
    recordings = [
        Recorded(f"day_{d}", d, d * 100 * S, (d * 100 + 50) * S, walked if d == 3 else ())
        for d in range(1, 6)
    ]
    return Truth(tuple(recordings), changes)


def event(
    kind: str,
    bounds: Bounds,
    first_s: int,
    last_s: int = 550,
    short: int | None = None,
    mid: int | None = None,
    **more: object,
) -> Event:
    """An event seen from `first_s` to `last_s` [s], adopted by two levels at so many seconds."""
    adopted = {"short": short and short * S, "mid": mid and mid * S}
    return Event("1", kind, bounds, first_s * S, last_s * S, adopted, (0,), **more)
