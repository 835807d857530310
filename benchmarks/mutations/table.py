"""The rows of the experiment as a table."""

from collections.abc import Sequence

from benchmarks.mutations.judging import Row


def table(title: str, rows: Sequence[Row]) -> str:
    """A table in Markdown."""
    lines = [
        f"\n### {title}\n",
        "| twin | verdict | farthest from its tolerance | told first |",
        "|---|---|---|---|",
    ]
    return "\n".join([*lines, *(_line(row) for row in rows)])


def _line(row: Row) -> str:
    worst = row.worst
    name = worst.name if worst.level is None else f"{worst.name} ({worst.level})"
    unit = f" {worst.unit}" if worst.unit else ""
    figure = f"{name} {worst.value:.3g}{unit}, {worst.allowed:g} allowed"
    times = f" ({worst.value / worst.allowed:.1f} times)" if worst.allowed else ""
    verdict = "**caught**" if row.verdict.failures else "passes"
    return f"| {row.twin} | {verdict} | {figure}{times} | {row.told} |"
