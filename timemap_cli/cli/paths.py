"""Paths as options and arguments."""

from pathlib import Path

import click

from timemap_cli.errors import UsageError


class NamedPath(click.Path):
    """A path that is not empty: an empty word, as an unset variable gives, would mean the current folder."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """The path; UsageError for an empty word."""
        if value == "":
            where = f"behind {param.opts[-1]} " if isinstance(param, click.Option) else ""
            command = ctx.command_path if ctx else "timemap"
            raise UsageError(f"the name of a file {where}is empty", hint=f"{command} --help")
        path: Path = super().convert(value, param, ctx)  # type: ignore[arg-type, assignment]
        return path


NAMED_PATH = NamedPath()
