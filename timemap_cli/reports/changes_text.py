"""Change events as a table that a person reads at a glance."""

from collections.abc import Sequence

from timemap_cli.reports.event_selection import Event
from timemap_cli.reports.tables import place, plural, table
from timemap_cli.times import format_time

_HEADINGS = (
    "id",
    "what",
    "x, y [m]",
    "size [m]",
    "since",
    "until",
    "adopted by",
    "nodes",
    "seen",
    "support",
    "",
)


def changes_text(events: Sequence[Event], total: int) -> str:
    """How many events, and a line for each in the given order; `total` counts those left out too.

    Ends without a newline. Times are in UTC, to the second. "seen" is in how many of the looks that could tell it held.
    """
    if not events:
        return f"No change events{_left_out(total)}."
    head = f"{plural(len(events), 'change event')}{_left_out(total - len(events))}."
    return "\n".join([head, "", *table([_HEADINGS, *map(_row, events)])])


def _left_out(count: int) -> str:
    return f" ({count} left out)" if count else ""


def _row(event: Event) -> tuple[str, ...]:
    x_min, y_min, x_max, y_max = event["bounds"]
    newest = event["episodes"][-1]
    return (
        str(event["id"]),
        event["kind"],
        place(event["x"], event["y"]),
        f"{x_max - x_min:.2f} x {y_max - y_min:.2f}",
        _time(event["first_seen_ns"]),
        _time(newest["until_ns"]) if newest["until_ns"] is not None else "",
        ", ".join(level for level, at_ns in event["adopted"].items() if at_ns is not None) or "none",
        str(len(event["nodes"])),
        f"{round(event['share_held'] * event['looks'])} of {event['looks']}",
        f"{event['support']:.2f}",
        _remark(event),
    )


def _remark(event: Event) -> str:
    remarks = []
    if event["moved_from"] is not None:
        remarks.append(f"from {place(*event['moved_from'])}")
    if event["recurring"]:
        remarks.append(f"came {len(event['episodes'])} times")
    if event["not_seen_since"]:
        remarks.append(f"not looked at since {_time(event['looked_ns'])}")
    return ", ".join(remarks)


def _time(stamp_ns: str) -> str:
    return format_time(int(stamp_ns) // 10**9 * 10**9)
