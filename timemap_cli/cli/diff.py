"""`timemap diff`: what differs between two levels, two times or two results."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from timemap_cli.cli.level_words import spread_levels
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, UsageError

if TYPE_CHECKING:
    from timemap_cli.comparing import Comparison


class _LevelPairs(click.Command):
    """A command whose --level takes a second word if that is a level's name."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        return super().parse_args(ctx, spread_levels(args))


@click.command(cls=_LevelPairs, short_help="what differs between two levels, two times or two results")
@click.argument("results", nargs=-1, type=NAMED_PATH, metavar="[RESULT] [OTHER]")
@click.option(
    "--level", "levels", multiple=True, metavar="LEVEL [LEVEL]", help="Two levels, or the one to look at."
)
@click.option("--at", metavar="TIME", help="Compare two levels at this time instead of at the end.")
@click.option("--between", nargs=2, metavar="TIME TIME", help="Compare two times of one level.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON (schema timemap.diff/1).")
@click.option("--exit-code", is_flag=True, help="Exit with 4 if there are differences.")
@click.pass_obj
def diff(
    terminal: Terminal,
    results: tuple[Path, ...],
    levels: tuple[str, ...],
    at: str | None,
    between: tuple[str, str] | None,
    as_json: bool,
    exit_code: bool,
) -> ExitCode:
    """Tell what differs between two levels, between two times of a level, or between two results.

    \b
      timemap diff [RESULT] --level long mid [--at TIME]
      timemap diff [RESULT] --level mid --between TIME TIME
      timemap diff RESULT OTHER --level long

    "From" is always the slower level or the earlier time. Without RESULT, the newest *.timemap.mcap in the
    current folder is taken. TIME is +10s or end-5s, RFC 3339, or nanoseconds since 1970.
    """
    _check_usage(results, levels, at, between)

    from timemap_cli.comparing import newest_result

    if not results:
        results = (newest_result(Path()),)
        terminal.note(f"using {results[0]}, the newest result in this folder")
    comparison = _compare(results, levels, at, between)
    _print(terminal, comparison, as_json)
    return ExitCode.DIFFERENT if exit_code and comparison.difference.changes else ExitCode.DONE


def _check_usage(
    results: tuple[Path, ...], levels: tuple[str, ...], at: str | None, between: tuple[str, str] | None
) -> None:
    """UsageError for a combination that is none of the three forms."""
    two_levels = "timemap diff --level long mid"
    two_times = "timemap diff --level mid --between start end"
    two_results = "timemap diff RESULT OTHER --level long"
    trouble = None
    if len(results) > 2:
        trouble = f"{len(results)} results given: {', '.join(map(str, results))}"
    elif len(levels) > 2:
        trouble = f"{len(levels)} levels given: {', '.join(levels)}"
    elif between and at:
        trouble = "--at and --between exclude each other"
    elif len(results) == 2 and (between or at):
        trouble = "two results are compared at their ends, without --at or --between"
    elif len(levels) == 2 and (between or len(results) == 2):
        trouble = f"--level {' '.join(levels)} names two levels where one is compared"
    elif len(levels) < 2 and at:
        trouble = "--at needs two levels"
    elif not levels:
        trouble = "--level is missing"
    elif len(levels) == 1 and not between and len(results) < 2:
        trouble = f"--level {levels[0]} alone compares nothing"
    if trouble:
        raise UsageError(trouble, hint="\n".join((two_levels, two_times, two_results)))


def _compare(
    results: tuple[Path, ...], levels: tuple[str, ...], at: str | None, between: tuple[str, str] | None
) -> "Comparison":
    from timemap_cli import comparing

    if len(results) == 2:
        return comparing.compare_results(results[0], results[1], levels[0])
    if between:
        return comparing.compare_times(results[0], levels[0], between)
    return comparing.compare_levels(results[0], (levels[0], levels[1]), at)


def _print(terminal: Terminal, found: "Comparison", as_json: bool) -> None:
    from timemap_cli.reports.diff_json import diff_json
    from timemap_cli.reports.diff_text import diff_text

    if as_json:
        terminal.result(diff_json(found.difference, found.nodes, found.before, found.after))
    else:
        terminal.result(diff_text(found.difference, found.before, found.after))
