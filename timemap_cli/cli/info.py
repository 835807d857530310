"""`timemap info`: what is in recordings and what a replay would use."""

from collections.abc import Sequence
from pathlib import Path

import click

from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.file_names import json_text


@click.command(short_help="what is in recordings or results, and what a replay would use")
@click.argument("logs", nargs=-1, required=True, type=NAMED_PATH, metavar="LOG...")
@click.option("--config", "config_file", type=NAMED_PATH, metavar="FILE", help="Settings file.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON (schema timemap.info/1).")
@click.pass_obj
def info(terminal: Terminal, logs: tuple[Path, ...], config_file: Path | None, as_json: bool) -> None:
    """Tell what is in the recordings LOG... and what a replay would use.

    Topics, rates, field of view, frames, how much of the time a pose is known, kinds of beams, and problems.
    LOG is a ROS 1 bag, a ROS 2 bag (folder or single file) or an MCAP file.

    LOG... may be results too: then what they hold is told.
    """
    from timemap_cli.results.container import is_result

    if all(map(is_result, logs)):
        terminal.result(_about_results(logs, as_json))
        return
    from timemap_cli.config import load
    from timemap_cli.logs.inspect import inspect
    from timemap_cli.reports.info_json import info_json
    from timemap_cli.reports.info_text import info_text

    report = inspect(logs, load(config_file))
    terminal.result(info_json(report) if as_json else info_text(report))


def _about_results(results: Sequence[Path], as_json: bool) -> str:
    from timemap_cli.reports.result_info import result_document, result_text
    from timemap_cli.results.reader import ResultReader

    found = []
    for path in results:
        with ResultReader(path) as result:
            found.append(result_document(result))
    if as_json:
        return json_text({"schema": "timemap.info/1", "logs": [], "results": found}, indent=2)
    return "\n\n".join(map(result_text, found))
