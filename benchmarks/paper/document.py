"""docs/paper.md: sections between markers, so that an experiment run alone replaces its own and no other."""

import re
from collections.abc import Mapping, Sequence

from benchmarks.paper.section import Figure, Section, Table

PICTURES = "pictures/paper"  # beside the document

_HEAD = """# The paper's experiments

Written by `make paper` (`python -m benchmarks.paper`), from simulated scans with fixed seeds: do not edit.
What the words mean and how the method works stands in [method.md](method.md).
"""
_SECTION = re.compile(r"<!-- (\w+) -->\n(.*?)(?=<!-- \w+ -->\n|\Z)", re.DOTALL)


def markdown(section: Section) -> str:
    """A section as Markdown, with links to its figures."""
    parts = [f"## {section.title}", *section.sentences]
    parts += [_table(table) for table in section.tables]
    parts += [_figure(figure) for figure in section.figures]
    return "\n\n".join(parts) + "\n"


def document(order: Sequence[str], old: str, new: Mapping[str, str]) -> str:
    """The whole document: new sections where there are any, else those of the old document."""
    sections = {name: text.strip() + "\n" for name, text in _SECTION.findall(old)} | dict(new)
    return "\n".join([_HEAD, *(f"<!-- {name} -->\n{sections[name]}" for name in order if name in sections)])


def plain(section: Section) -> str:
    """A section for a terminal."""
    lines = [section.title, "=" * len(section.title), "", *section.sentences]
    for table in section.tables:
        rows = [table.header, *table.rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(table.header))]
        lines += ["", *([table.caption] if table.caption else [])]
        lines += [
            "  ".join(
                cell.rjust(w) if i else cell.ljust(w)
                for i, (cell, w) in enumerate(zip(r, widths, strict=True))
            )
            for r in rows
        ]
    return "\n".join([*lines, ""])


def _table(table: Table) -> str:
    rule = ["---", *["---:"] * (len(table.header) - 1)]
    rows = "\n".join(f"| {' | '.join(row)} |" for row in (table.header, rule, *table.rows))
    return f"{table.caption}\n\n{rows}" if table.caption else rows


def _figure(figure: Figure) -> str:
    return f"![{figure.caption}]({PICTURES}/{figure.name}.svg)\n\n*{figure.caption}*"
