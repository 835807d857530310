"""Paths as options and arguments."""

from pathlib import Path

import click


class NamedPath(click.Path):
    """A path that is not empty: an empty word, as an unset variable gives, would mean the current folder."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        """The path; a complaint of click about an empty word."""
        if value == "":
            self.fail("the name is empty", param, ctx)
        path: Path = super().convert(value, param, ctx)  # type: ignore[arg-type, assignment]
        return path


NAMED_PATH = NamedPath()
