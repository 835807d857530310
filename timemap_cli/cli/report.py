"""`timemap report`: a result as one page."""

from pathlib import Path

import click

from timemap_cli.cli.chosen import HTML, begins_with, chosen_result, title_of
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode


@click.command(short_help="one page to look at: the map over time, the changes, what they rest on")
@click.argument("result", required=False, type=NAMED_PATH)
@click.option(
    "-o",
    "--output",
    type=NAMED_PATH,
    metavar="PAGE.html",
    help="Page. [default: RESULT's name with .html, here]",
)
@click.option("--force", is_flag=True, help="Replace an existing page.")
@click.pass_obj
def report(terminal: Terminal, /, result: Path | None, output: Path | None, force: bool) -> ExitCode:
    """Write RESULT as one HTML page that needs no network.

    Without RESULT, the newest *.timemap.mcap in the current folder is taken. Needs plotly:
    pip install 'timemap-cli[report]'.
    """
    from timemap_cli.reports.page import page
    from timemap_cli.reports.page_data import page_data
    from timemap_cli.results.atomic_file import AtomicFile
    from timemap_cli.results.reader import ResultReader

    result = chosen_result(terminal, result)
    title = title_of(result)
    output = output or Path(title + ".html")
    with (
        ResultReader(result) as reader,
        AtomicFile(output, force=force, may_replace=begins_with(HTML), replaced="a page") as file,
    ):
        file.write(page(title, page_data(reader)).encode())
        file.commit()
    terminal.result(str(output))
    return ExitCode.DONE
