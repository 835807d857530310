"""`--level long mid`: an option that takes one word, and a second one if it is a level's name."""

import re
from collections.abc import Sequence

import click

LEVEL_NAME = re.compile(r"[a-z][a-z0-9_]*")


def spread_levels(args: Sequence[str]) -> list[str]:
    """The arguments with each `--level A B` as `--level A --level B`.

    B is taken for a level only if it has the form of one; a result's name holds a `.` or a `/`. Words after
    `--` are left alone.
    """
    spread: list[str] = []
    rest = list(args)
    while rest:
        word = rest.pop(0)
        spread.append(word)
        if word == "--":
            return spread + rest
        if word == "--level" and rest and not rest[0].startswith("-"):
            spread.append(rest.pop(0))
        elif not word.startswith("--level="):
            continue
        if rest and LEVEL_NAME.fullmatch(rest[0]):
            spread += ["--level", rest.pop(0)]
    return spread


class LevelPairs(click.Command):
    """A command whose --level takes a second word if that is a level's name."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments, with each pair of levels spread out."""
        return super().parse_args(ctx, spread_levels(args))
