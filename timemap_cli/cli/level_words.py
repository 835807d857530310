"""`--level long mid`: an option that takes one word, and a second one if it is a level's name."""

import re
from collections.abc import Sequence

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
