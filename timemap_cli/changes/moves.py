"""A thing that vanished here and appeared there in the same shape has moved."""

from collections.abc import Sequence

from timemap_cli.changes.rules import Rules
from timemap_cli.changes.things import Thing


def pair_moves(vanished: Sequence[Thing], appeared: Sequence[Thing], rules: Rules) -> list[tuple[int, int]]:
    """Indices (vanished, appeared) of things that only moved, each used once."""
    return []
