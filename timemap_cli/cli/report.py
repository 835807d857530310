"""`timemap report`: a result as one page."""

from pathlib import Path

import click

from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode


@click.command(short_help="one page to look at: the map over time, the changes, what they rest on")
@click.argument("result", required=False, type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
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
    from timemap_cli.comparing import newest_result
    from timemap_cli.reports.page import page
    from timemap_cli.reports.page_data import page_data
    from timemap_cli.results.atomic_file import AtomicFile
    from timemap_cli.results.reader import ResultReader

    if result is None:
        result = newest_result(Path())
        terminal.note(f"using {result}, the newest result in this folder")
    output = output or Path(result.name.removesuffix(".mcap").removesuffix(".timemap") + ".html")
    with ResultReader(result) as reader:
        text = page(result.name.removesuffix(".mcap").removesuffix(".timemap"), page_data(reader))
    file = AtomicFile(output, force=force)
    try:
        file.write(text.encode())
        file.commit()
    finally:
        file.discard()
    terminal.result(str(output))
    return ExitCode.DONE
