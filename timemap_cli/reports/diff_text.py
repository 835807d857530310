"""A comparison as a table that a person reads at a glance."""

from collections.abc import Sequence
from math import hypot, isfinite

from timemap_cli.changes.difference import Change, Difference, Kind, Sector
from timemap_cli.reports.sides import ComparedSide
from timemap_cli.reports.tables import place, plural, table
from timemap_cli.times import format_time

_NODES_SHOWN = 4  # more do not help to find the place, and the line stays within a terminal
_HEADINGS = ("what", "x, y [m]", "size [m]", "nodes", "range at first [m]", "support", "")


def diff_text(
    difference: Difference,
    old: ComparedSide,
    new: ComparedSide,
    without_partner: tuple[int, int] | None = None,
) -> str:
    """What was compared, how much of it, and a line per change, the largest first.

    Each line lists the nodes that saw the change, the one that saw it widest first, and the range from there
    before and after. `without_partner` counts the nodes of the old and of the new side's result that the other
    does not have. Ends without a newline.
    """
    lines = [*_sides(old, new), "", _summary(difference)]
    if difference.small:
        lines.append(f"{plural(difference.small, 'smaller change')} left out.")
    if without_partner and any(without_partner):
        alone = " and ".join(
            f"{plural(count, 'node')} of {side.result}"
            for count, side in zip(without_partner, (old, new), strict=True)
            if count
        )
        lines.append(f"No partner in the other result: {alone}.")
    if difference.changes:
        rows = [_HEADINGS, *(_row(change, difference.angle_bins) for change in difference.changes)]
        lines += ["", *table(rows)]
    return "\n".join(lines)


def _sides(old: ComparedSide, new: ComparedSide) -> list[str]:
    rows = [
        (label, f"level {side.level}", f"at {format_time(side.stamp_ns)}", f"of {side.result}")
        for label, side in (("from", old), ("to", new))
    ]
    return table(rows)


def _summary(difference: Difference) -> str:
    if not difference.nodes:
        told = "Nothing could be compared: no node was seen for both sides"
        return f"{told}{_silent(difference)}."
    nodes, bins = plural(len(difference.nodes), "node"), plural(difference.compared_bins, "angle bin")
    looked = f"{nodes}, {bins} compared"
    if not difference.changes:
        return f"Nothing differs: {looked}{_silent(difference)}."
    kinds = ", ".join(f"{difference.count(kind)} {kind.value}" for kind in Kind if difference.count(kind))
    return f"{plural(len(difference.changes), 'change')}: {kinds} ({looked}{_silent(difference)})."


def _silent(difference: Difference) -> str:
    silent = len(difference.silent_nodes)
    return f"; {plural(silent, 'node')} known to one side only or not seen again" if silent else ""


def _row(change: Change, angle_bins: int) -> tuple[str, ...]:
    x_min, y_min, x_max, y_max = change.bounds
    widest = sorted(change.sectors, key=lambda s: (-s.bins(angle_bins), s.node, s.start_bin))
    return (
        change.kind.value,
        place(change.x, change.y),
        f"{x_max - x_min:.2f} x {y_max - y_min:.2f}",
        _nodes(list(dict.fromkeys(sector.node for sector in widest))),
        _ranges(change, [sector for sector in widest if sector.node == widest[0].node]),
        f"{change.support:.2f}",
        _origin(change),
    )


def _ranges(change: Change, widest: Sequence[Sector]) -> str:
    """The ranges before and after of one node, its widest sector first.

    A moved thing has a sector that it left, where the range grew, and one that it entered, where it shrank.
    """
    before, after = widest[0].range_from_m, widest[0].range_to_m
    if change.kind is Kind.MOVED:
        before = next((s.range_from_m for s in widest if s.range_to_m > s.range_from_m), before)
        after = next((s.range_to_m for s in widest if s.range_to_m < s.range_from_m), after)
    return f"{_metres(before)} -> {_metres(after)}"


def _origin(change: Change) -> str:
    if change.moved_from is None:
        return ""
    x, y = change.moved_from
    return f"by {hypot(change.x - x, change.y - y):.2f} m from {place(x, y)}"


def _nodes(numbers: Sequence[int]) -> str:
    shown = ", ".join(str(number) for number in numbers[:_NODES_SHOWN])
    rest = len(numbers) - _NODES_SHOWN
    return f"{shown} and {rest} more" if rest > 0 else shown


def _metres(value: float) -> str:
    return f"{value:.2f}" if isfinite(value) else "clear"
