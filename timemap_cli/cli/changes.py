"""`timemap changes`: the change events of a result."""

from pathlib import Path
from typing import Any

import click

from timemap_cli.cli.chosen import chosen_result
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, UsageError
from timemap_cli.file_names import json_text
from timemap_cli.reports.event_selection import ORDERS, EventSelection, selected

_KINDS = ("appeared", "vanished", "moved")


@click.command(short_help="what changed, where, since when, and at which time scale")
@click.argument("result", required=False, type=NAMED_PATH)
@click.option(
    "--kind", "kinds", multiple=True, type=click.Choice(_KINDS), help="Only these; may be repeated."
)
@click.option("--level", "levels", multiple=True, metavar="LEVEL", help="Only what this level has adopted.")
@click.option("--since", metavar="TIME", help="Only what held at this time or later.")
@click.option("--until", metavar="TIME", help="Only what held before this time.")
@click.option(
    "--region", nargs=4, type=float, metavar="X_MIN Y_MIN X_MAX Y_MAX", help="Only what lies here [m]."
)
@click.option("--min-size", type=click.FloatRange(0), default=0.0, metavar="M", help="Least diagonal [m].")
@click.option(
    "--min-age", metavar="SPAN", help="Least time from the first to the last sighting: 30s, 10min, 12h, 2d."
)
@click.option("--holding", is_flag=True, help="Only what still holds.")
@click.option("--sort", type=click.Choice(list(ORDERS)), default="time", help="Order. [default: time]")
@click.option("--json", "form", flag_value="json", help="Print JSON (schema timemap.changes/1).")
@click.option("--csv", "form", flag_value="csv", help="Print lines for a spreadsheet.")
@click.option("--geojson", "form", flag_value="geojson", help="Print polygons in metres of the map frame.")
@click.pass_obj
def changes(
    terminal: Terminal, /, result: Path | None, sort: str, form: str | None, **wanted: Any
) -> ExitCode:
    """Tell what changed over time: appeared, vanished or moved, since when, and which levels have adopted it.

    Without RESULT, the newest *.timemap.mcap in the current folder is taken. TIME is a date, RFC 3339, +10s from the
    start, 2d back from the end, or nanoseconds since 1970.
    """
    from timemap_cli.comparing import require_level
    from timemap_cli.results.reader import ResultReader

    with ResultReader(chosen_result(terminal, result)) as reader:
        document, levels = reader.changes, reader.levels
        for level in wanted["levels"]:
            require_level(reader, reader.path, level, f"timemap changes {reader.path} --level {levels[-1]}")
        selection = _selection((reader.start_ns, reader.end_ns), **wanted)
    events = selected(document["events"], selection, sort)
    terminal.result(_told(document, events, levels, form))
    return ExitCode.DONE


def _selection(
    span_ns: tuple[int, int],
    *,
    since: str | None,
    until: str | None,
    min_size: float,
    min_age: str | None,
    region: tuple[float, float, float, float] | None,
    **same: Any,
) -> EventSelection:
    from timemap_cli.times import parse_time

    if region is not None and (region[0] > region[2] or region[1] > region[3]):
        x, y = sorted(region[::2]), sorted(region[1::2])
        raise UsageError(
            "--region is X_MIN Y_MIN X_MAX Y_MAX, and a MIN is above its MAX",
            hint=f"--region {x[0]:g} {y[0]:g} {x[1]:g} {y[1]:g}",
        )
    return EventSelection(
        since_ns=None if since is None else parse_time(since, *span_ns),
        until_ns=None if until is None else parse_time(until, *span_ns),
        min_size_m=min_size,
        min_age_ns=0 if min_age is None else _nanoseconds(min_age),
        region=region,
        **same,
    )


def _nanoseconds(span: str) -> int:
    from timemap_cli.spans import Span

    try:
        parsed = Span.parse(span)
    except ValueError as error:
        message = f"--min-age '{span}' is not a number with one of the units s, min, h, d"
        raise UsageError(message, hint="--min-age 10min") from error
    if parsed.unit != "s":
        raise UsageError("--min-age is a time", hint="--min-age 10min")
    return round(parsed.value * 1e9)


def _told(document: dict[str, Any], events: list[Any], levels: tuple[str, ...], form: str | None) -> str:
    from timemap_cli.reports import changes_json, changes_tables, changes_text

    if form == "json":
        told = document | {"events": events, "summary": changes_json.summary(events)}
        return json_text(told, indent=2)
    if form == "csv":
        return changes_tables.changes_csv(events, levels)
    if form == "geojson":
        return changes_tables.changes_geojson(events)
    return changes_text.changes_text(events, len(document["events"]))
