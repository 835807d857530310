"""A check as Markdown: for a job's summary or a comment on a change."""

from collections.abc import Iterator, Sequence

from timemap_cli.checks.verdict import CheckedCase, Measure, Verdict
from timemap_cli.reports.check_values import outcome, title, value, within

_MARKS = {"passed": "✅", "failed": "❌", "error": "⚠️"}


def check_markdown(cases: Sequence[CheckedCase]) -> str:
    """A section for each check: what is out of tolerance, likely causes, and all figures folded away."""
    return "\n".join(line for case in cases for line in _case(case))


def _case(case: CheckedCase) -> Iterator[str]:
    word = outcome(case)
    yield f"### {_MARKS[word]} {_plain(case.name)}: {word}"
    yield ""
    if case.verdict is None:
        yield _plain(case.error.message if case.error else "nothing was compared")
        yield ""
        return
    yield from _failures(case.verdict)
    yield from _listed("Data was lost" if case.lost else "Warnings", case.warnings)
    yield from _listed("Likely cause", case.verdict.causes)
    yield from _listed("Not the same to the digest", case.verdict.unequal or ())
    yield from _listed("Also", [note for note in case.verdict.notes if note not in case.verdict.causes])
    yield from _all(case)


def _failures(verdict: Verdict) -> Iterator[str]:
    if not verdict.failures:
        yield f"{within(verdict).capitalize()} within tolerance."
        yield ""
        return
    yield "| out of tolerance | is | allowed | what |"
    yield "|---|---|---|---|"
    for one in verdict.failures:
        yield f"{_figures(one)} {_plain(one.text)} |"
    yield ""


def _listed(heading: str, lines: Sequence[str]) -> Iterator[str]:
    if not lines:
        return
    yield f"**{heading}**"
    yield ""
    yield from (f"- {_plain(line)}" for line in lines)
    yield ""


def _all(case: CheckedCase) -> Iterator[str]:
    measures = case.verdict.measures if case.verdict else ()
    yield f"<details><summary>All {len(measures)} figures, against {_html(case.baseline)}</summary>"
    yield ""
    yield "| figure | is | allowed |"
    yield "|---|---|---|"
    yield from (_figures(one) for one in measures)
    yield ""
    yield "</details>"
    yield ""


def _figures(one: Measure) -> str:
    return f"| {title(one)} | {value(one.value, one.unit)} | {value(one.allowed, one.unit)} |"


def _plain(text: str) -> str:
    """Text of a file or a recording that Markdown and HTML read as nothing else."""
    for letter in "\\`*_[]|~":
        text = text.replace(letter, f"\\{letter}")
    return _html(text)


def _html(text: str) -> str:
    """The same inside of an element, where Markdown reads no backslashes; always one line."""
    return " ".join(text.replace("&", "&amp;").replace("<", "&lt;").splitlines())
