"""Tables of text."""

from collections.abc import Sequence


def table(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows as lines, the columns aligned left and two spaces apart."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]


def plural(count: int, noun: str) -> str:
    """`1 node`, `2 nodes`."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def place(x: float, y: float) -> str:
    """A place in metres, to the centimetre."""
    x, y = (round(value, 2) + 0.0 for value in (x, y))  # the sum turns -0.0 into 0.0
    return f"{x:.2f}, {y:.2f}"
