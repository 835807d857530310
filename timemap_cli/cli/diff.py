"""`timemap diff`: what differs between two levels, two times or two results."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from timemap_cli.cli.chosen import chosen_result
from timemap_cli.cli.level_words import LevelPairs
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, UsageError

if TYPE_CHECKING:
    from timemap_cli.comparing import Comparison


_TWO_LEVELS = "timemap diff --level long mid"
_TWO_TIMES = "timemap diff --level mid --between 2024-05-01T18:00:00Z end"
_TWO_RESULTS = "timemap diff RESULT OTHER --level long"


def _two_times(
    _context: click.Context, _option: click.Parameter, times: tuple[str, str] | None
) -> tuple[str, str] | None:
    """The two times; click takes an option's name for the second one where only one is given."""
    if times and any(time.startswith("-") for time in times):
        raise UsageError("--between needs two times", hint=_TWO_TIMES)
    return times


@click.command(cls=LevelPairs, short_help="what differs between two levels, two times or two results")
@click.argument("results", nargs=-1, type=NAMED_PATH, metavar="[RESULT] [OTHER]")
@click.option(
    "--level", "levels", multiple=True, metavar="LEVEL [LEVEL]", help="Two levels, or the one to look at."
)
@click.option("--at", metavar="TIME", help="Compare two levels at this time instead of at the end.")
@click.option(
    "--between",
    nargs=2,
    metavar="TIME TIME",
    callback=_two_times,
    help="Compare two times of one level.",
)
@click.option("--min-size", type=click.FloatRange(0), default=0.0, metavar="M", help="Least diagonal [m].")
@click.option(
    "--min-shift",
    type=click.FloatRange(0),
    default=0.0,
    metavar="M",
    help="Least way of what moved; of others the least step between the ranges before and after [m]. "
    "What was or became clear passes.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON (schema timemap.diff/1).")
@click.option(
    "--exit-code",
    is_flag=True,
    help="Exit with 4 if there are differences (of --min-size and --min-shift), with 2 if nothing could be compared.",
)
@click.pass_obj
def diff(
    terminal: Terminal,
    results: tuple[Path, ...],
    levels: tuple[str, ...],
    at: str | None,
    between: tuple[str, str] | None,
    min_size: float,
    min_shift: float,
    as_json: bool,
    exit_code: bool,
) -> ExitCode:
    """Tell what differs between two levels, between two times of a level, or between two results.

    \b
      timemap diff [RESULT] --level long mid [--at TIME]
      timemap diff [RESULT] --level mid --between TIME TIME
      timemap diff RESULT OTHER --level long

    "From" is always the slower level or the earlier time. Without RESULT, the newest *.timemap.mcap in the
    current folder is taken. TIME is a date, RFC 3339, +10s from the start, 2d back from the end, or nanoseconds since
    1970.
    """
    _check_usage(results, levels, at, between)

    results = results or (chosen_result(terminal, None),)
    comparison = _compare(results, levels, at, between)
    comparison = replace(comparison, difference=comparison.difference.at_least(min_size, min_shift))
    _print(terminal, comparison, as_json)
    return _exit_code(comparison) if exit_code else ExitCode.DONE


def _check_usage(
    results: tuple[Path, ...], levels: tuple[str, ...], at: str | None, between: tuple[str, str] | None
) -> None:
    """UsageError for a combination that is none of the three forms."""
    trouble = None
    if len(results) > 2:
        trouble = f"{len(results)} results given: {', '.join(map(str, results))}"
    elif len(levels) > 2:
        trouble = f"{len(levels)} levels given: {', '.join(levels)}"
    elif between and at is not None:
        trouble = "--at and --between exclude each other"
    elif len(results) == 2 and (between or at is not None):
        trouble = "two results are compared at their ends, without --at or --between"
    elif len(levels) == 2 and (between or len(results) == 2):
        trouble = f"--level {' '.join(levels)} names two levels where one is compared"
    elif len(levels) < 2 and at is not None:
        trouble = "--at needs two levels"
    elif not levels:
        trouble = "--level is missing"
    elif len(levels) == 1 and not between and len(results) < 2:
        trouble = f"--level {levels[0]} alone compares nothing"
    if trouble:
        raise UsageError(trouble, hint="\n".join((_TWO_LEVELS, _TWO_TIMES, _TWO_RESULTS)))


def _compare(
    results: tuple[Path, ...], levels: tuple[str, ...], at: str | None, between: tuple[str, str] | None
) -> "Comparison":
    from timemap_cli import comparing

    if len(results) == 2:
        return comparing.compare_results(results[0], results[1], levels[0])
    if between:
        return comparing.compare_times(results[0], levels[0], between)
    return comparing.compare_levels(results[0], (levels[0], levels[1]), at)


def _exit_code(found: "Comparison") -> ExitCode:
    """Nothing compared is no "nothing differs": who asks for the code would take it for that."""
    if not found.difference.nodes:
        return ExitCode.USAGE
    return ExitCode.DIFFERENT if found.difference.changes else ExitCode.DONE


def _print(terminal: Terminal, found: "Comparison", as_json: bool) -> None:
    from timemap_cli.reports.diff_json import diff_json
    from timemap_cli.reports.diff_text import diff_text

    if as_json:
        terminal.result(
            diff_json(found.difference, found.nodes, found.before, found.after, found.without_partner)
        )
    else:
        terminal.result(diff_text(found.difference, found.before, found.after, found.without_partner))
    for warning in found.warnings:
        terminal.warn(warning)
    terminal.hint(found.hint)
