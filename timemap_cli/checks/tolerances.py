"""How much may differ before a check fails."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from timemap_cli.errors import UsageError, shown


@dataclass(frozen=True, slots=True)
class Tolerance:
    """One tolerance: the largest value that passes."""

    default: float
    unit: str  # empty: a share 0..1
    meaning: str


# docs/ci.md has what noise alone and what mistakes measure at these.
TOLERANCES: Mapping[str, Tolerance] = {
    "settings.changed": Tolerance(0, "settings", "settings with other values"),
    "scans.read": Tolerance(0.005, "", "more or fewer scans read"),
    "scans.used": Tolerance(0.01, "", "more or fewer of the scans read are used"),
    "beams.kinds": Tolerance(
        0.33, "", "change of the share of hits, missing returns or useless beams, in proportion to that share"
    ),
    "nodes.place": Tolerance(0.25, "m", "a node this far away is the same node"),
    "nodes.missing": Tolerance(0.05, "", "nodes of the baseline that are not there"),
    "nodes.new": Tolerance(0.05, "", "nodes that the baseline does not have"),
    "map.shift": Tolerance(0.01, "m", "shift that all nodes have in common"),
    "map.turn": Tolerance(0.25, "deg", "turn that all nodes have in common"),
    "nodes.shift": Tolerance(0.015, "m", "shifts of the single nodes, root mean square"),
    "nodes.turn": Tolerance(0.4, "deg", "turns of the single nodes, root mean square"),
    "ranges.step": Tolerance(0.08, "m", "an end this far from the baseline's surfaces has moved"),
    "ranges.moved": Tolerance(0.03, "", "angle bins that moved"),
    "ranges.places": Tolerance(0, "places", "places where several nodes agree that a surface moved"),
    "status.lost": Tolerance(0.02, "", "known angle bins that are unknown now"),
    "status.gained": Tolerance(0.02, "", "angle bins known now that were unknown"),
    "status.clear": Tolerance(0.01, "", "angle bins that are clear now and were not, or the reverse"),
    "events.missing": Tolerance(0, "events", "change events of the baseline that are not there"),
    "events.new": Tolerance(0, "events", "change events that the baseline does not have"),
    "events.place": Tolerance(0.3, "m", "how far a change event may lie from its place"),
    "events.time": Tolerance(300, "s", "how much sooner or later a change may be seen or undone"),
}


_MOST = 1e12  # none is that large; an integer that no float can hold neither


def defaults() -> dict[str, float]:
    """Every tolerance at its default."""
    return {name: tolerance.default for name, tolerance in TOLERANCES.items()}


def within(value: float, allowed: float) -> bool:
    """Whether a figure is within its tolerance; to nine digits, since 0.99 - 0.98 is more than 0.01 in binary."""
    return value <= allowed + 1e-9 * max(1.0, allowed)


def checked(values: Mapping[str, object], place: str) -> dict[str, float]:
    """Tolerances as a file has them; UsageError for an unknown name, with the nearest one, or no number >= 0."""
    found: dict[str, float] = {}
    for name, value in values.items():
        if name not in TOLERANCES:
            near = get_close_matches(shown(name), TOLERANCES, n=1, cutoff=0.4)
            raise UsageError(
                f"unknown tolerance {shown(name)} in {place}",
                hint=near[0] if near else f"one of {', '.join(TOLERANCES)}",
            )
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < _MOST:
            raise UsageError(f"tolerance {name} in {place} is not a number from 0 on: {shown(value)}")
        found[name] = float(value)
    return found


def parsed(words: Sequence[str]) -> dict[str, float]:
    """Tolerances as options have them: `ranges.moved=0.02`. UsageError as `checked` raises it."""
    values: dict[str, object] = {}
    for word in words:
        name, equals, value = word.partition("=")
        try:
            values[name.strip()] = float(value)
        except ValueError as error:
            what = "is not a number" if equals else "has no value"
            raise UsageError(f"--tolerance {word} {what}", hint="--tolerance ranges.moved=0.02") from error
    return checked(values, "--tolerance")
