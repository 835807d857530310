"""`timemap config`: the settings with their comments."""

from pathlib import Path

import click

from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.config import PROFILES, dump, load


@click.command(short_help="print the settings with their units, ranges and meanings")
@click.option("--config", "file", type=NAMED_PATH, metavar="FILE", help="Settings file to start from.")
@click.option("--profile", type=click.Choice(PROFILES), help="Defaults to start from.")
@click.pass_obj
def config(terminal: Terminal, file: Path | None, profile: str | None) -> None:
    """Print the settings as YAML, each with its unit, range and meaning.

    The output is a file that --config reads. With --config, the settings of a file are checked and completed.

    \b
      timemap config > settings.yaml
      timemap replay --config settings.yaml log.mcap
    """
    terminal.result(dump(load(file, {"profile": profile} if profile else {})))
