"""`timemap check`: a recording or a result against its baseline."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from timemap_cli.cli import check_outputs as outputs
from timemap_cli.cli.chosen import HTML, begins_with, title_of
from timemap_cli.cli.outputs import PAGE, RESULT, require_file, required_suffix
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.progress import ProgressBar
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, UsageError

if TYPE_CHECKING:
    from timemap_cli.checking import Check, Updated
    from timemap_cli.checks.snapshot import Snapshot
    from timemap_cli.checks.verdict import Verdict
    from timemap_cli.results.reader import ResultReader

_USES = "timemap check LOG... --baseline BASELINE.yaml\ntimemap check --suite regression.yaml"


@click.command(short_help="whether a recording still gives the map that its baseline says")
@click.argument("sources", nargs=-1, type=NAMED_PATH, metavar="[RESULT | LOG...]")
@click.option("--baseline", type=NAMED_PATH, metavar="FILE", help="What the map is expected to be.")
@click.option("--update-baseline", "updates", is_flag=True, help="Write the baseline instead of checking.")
@click.option("--suite", type=NAMED_PATH, metavar="FILE", help="Run the checks that this file lists.")
@click.option("--jobs", type=click.IntRange(1), default=1, metavar="N", help="Checks of a suite at a time.")
@click.option("--config", type=NAMED_PATH, metavar="FILE", help="Settings of the replay.")
@click.option("-o", "--output", type=NAMED_PATH, metavar="OUT.mcap", help="Keep the result of the replay.")
@click.option("--force", is_flag=True, help="Replace an existing result or page.")
@click.option(
    "--tolerance",
    "tolerances",
    multiple=True,
    metavar="NAME=VALUE",
    help="Instead of the baseline's; may be repeated: ranges.moved=0.02.",
)
@click.option("--exact", is_flag=True, help="Demand the same digests, too.")
@click.option(
    "--format",
    "formats",
    multiple=True,
    metavar="FORMAT[=FILE]",
    help="text, json, junit, github or markdown, to a file if one is named; may be repeated. [default: text]",
)
@click.option("--html", type=NAMED_PATH, metavar="FILE", help="Also write a page with baseline and result.")
@click.pass_obj
def check(
    terminal: Terminal,
    /,
    sources: tuple[Path, ...],
    baseline: Path | None,
    updates: bool,
    suite: Path | None,
    jobs: int,
    formats: tuple[str, ...],
    tolerances: tuple[str, ...],
    exact: bool,
    html: Path | None,
    **replaying: Any,
) -> ExitCode:
    """Tell whether RESULT, or what a replay of LOG... gives, is still what its baseline says.

    \b
      timemap check monday.mcap --baseline monday.yaml --update-baseline
      timemap check monday.mcap --baseline monday.yaml
      timemap check --suite regression.yaml --format junit=junit.xml --format github

    Exit code 4: something is out of tolerance. 2: nothing can be compared. 3: all is within tolerance, but
    data was lost.
    """
    from timemap_cli.checks.tolerances import parsed
    from timemap_cli.checks.verdict import exit_code_of

    if updates and (formats or html):
        unused = "--format" if formats else "--html"
        raise UsageError(f"{unused} does not go with --update-baseline: nothing is checked then", hint=_USES)
    _require_names(baseline if updates else None, replaying.get("output"), html)
    wanted, limits = outputs.wanted(formats), parsed(tolerances)
    outputs.require_writable(wanted)
    if suite is not None:
        _require_alone(suite, sources, baseline, {**replaying, "html": html})
        from timemap_cli import suite as suites

        checks = suites.read_suite(suite, limits, exact=exact)
        if updates:
            return _tell_updated(terminal, suites.update_all(checks, limits, jobs))
        cases = suites.run(checks, jobs)
    else:
        one = _check(sources, baseline, limits, exact, **replaying)
        from timemap_cli import checking

        with ProgressBar(terminal) as progress:
            if updates:
                return _tell_updated(terminal, [checking.update(one, progress)])
            cases = [checking.checked(one, progress, _page_writer(html, one) if html else None)]
        if cases[0].error is not None:
            outputs.tell(terminal, cases, wanted if formats else ())  # in its report as on the terminal
            raise cases[0].error
    outputs.tell(terminal, cases, wanted)
    return exit_code_of(cases)


def _require_names(baseline: Path | None, output: Path | None, html: Path | None) -> None:
    """UsageError where an output has a name of something else, or is standard output, which has the verdict."""
    if baseline is not None:
        require_file(baseline, "a baseline", "--baseline BASELINE.yaml")
    if output is not None:
        require_file(output, "a result", "-o OUT.mcap")
        required_suffix(output, RESULT, "a result")
    if html is not None:
        require_file(html, "the page of a check", "--html CHECK.html")
        required_suffix(html, PAGE, "a page", "--html ")


def _check(
    sources: tuple[Path, ...],
    baseline: Path | None,
    tolerances: Mapping[str, float],
    exact: bool,
    **replaying: Any,
) -> "Check":
    if baseline is None or not sources:
        missing = "no recording or result is named" if baseline else "--baseline is missing"
        raise UsageError(missing, hint=_USES)
    from timemap_cli.checking import Check

    others = f" and {len(sources) - 1} more" if len(sources) > 1 else ""
    name = title_of(sources[0]) + others
    return Check(sources, baseline, name, tolerances=tolerances, exact=exact, **replaying)


def _page_writer(page: Path, one: "Check") -> "Callable[[ResultReader, Snapshot, Verdict], None]":
    """Writes the page of a result that is checked, with its baseline in it."""

    def write(reader: "ResultReader", expected: "Snapshot", verdict: "Verdict") -> None:
        from timemap_cli.reports.page import page as page_text
        from timemap_cli.reports.page_check import check_data
        from timemap_cli.reports.page_data import page_data
        from timemap_cli.results.atomic_file import AtomicFile

        with AtomicFile(page, force=one.force, may_replace=begins_with(HTML), replaced="a page") as file:
            data = page_data(reader) | {"check": check_data(expected, verdict)}
            file.write(page_text(one.name, data).encode())
            file.commit()

    return write


def _require_alone(
    suite: Path, sources: tuple[Path, ...], baseline: Path | None, replaying: Mapping[str, Any]
) -> None:
    """UsageError where something is given that the suite says for each of its checks."""
    given = [str(source) for source in sources]
    given += ["--baseline"] if baseline else []
    given += [f"--{name}" for name, value in replaying.items() if value]
    if given:
        raise UsageError(f"{given[0]} does not go with --suite: {suite} says it for each check", hint=_USES)


def _tell_updated(terminal: Terminal, done: "Sequence[Updated]") -> ExitCode:
    from timemap_cli.reports.check_text import updated_text

    for one in done:
        for warning in one.warnings:
            terminal.warn(f"{one.path}: {warning}" if len(done) > 1 else warning)
        terminal.result(updated_text(str(one.path), one.snapshot, one.was))
    return ExitCode.DATA_LOST if any(one.lost for one in done) else ExitCode.DONE
