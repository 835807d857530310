"""`timemap report`: a result as one page."""

from pathlib import Path

import click

from timemap_cli.cli.chosen import HTML, chosen_result, title_of
from timemap_cli.cli.outputs import PAGE, is_standard_output, required_suffix, write_output
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
    help="Page; - is standard output. [default: RESULT's name with .html, here]",
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
    from timemap_cli.results.reader import ResultReader

    if output is not None and not is_standard_output(output):
        required_suffix(output, PAGE, "a page")
    result = chosen_result(terminal, result)
    title = title_of(result)
    output = output or Path(title + ".html")
    with ResultReader(result) as reader:
        write_output(
            terminal,
            output,
            lambda: page(title, page_data(reader)).encode(),
            force=force,
            heads=[HTML],
            replaced="a page",
        )
    return ExitCode.DONE
