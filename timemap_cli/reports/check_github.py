"""A check as GitHub's workflow commands: annotations at the baseline, the worst first."""

from collections.abc import Iterator, Sequence

from timemap_cli.checks.verdict import CheckedCase
from timemap_cli.reports.check_values import compared, outcome, title, within

_MOST = 10  # GitHub shows so many errors of one step


def check_github(cases: Sequence[CheckedCase]) -> str:
    """Lines `::error file=...,title=...::message`; what passed is a notice."""
    return "\n".join(line for case in cases for line in _case(case))


def _case(case: CheckedCase) -> Iterator[str]:
    name = f"timemap check {case.name}"
    if case.verdict is None:
        yield _command("error", case, name, case.error.message if case.error else "nothing was compared")
        return
    if outcome(case) == "passed":
        told = f"{within(case.verdict)} within tolerance"
        yield _command("warning" if case.lost else "notice", case, name, "\n".join([told, *case.warnings]))
        return
    causes = [f"likely: {cause}" for cause in case.verdict.causes]
    for one in case.verdict.failures[:_MOST]:
        lines = [f"{one.text} ({compared(one)})", *causes]
        causes = []  # the first annotation tells them
        yield _command("error", case, f"{name}: {title(one)}", "\n".join(lines))
    if case.warnings:
        yield _command("warning", case, name, "\n".join(case.warnings))
    if case.verdict.unequal:
        yield _command("error", case, f"{name}: exact", "\n".join(case.verdict.unequal))


def _command(kind: str, case: CheckedCase, name: str, message: str) -> str:
    return f"::{kind} file={_property(case.baseline)},title={_property(name)}::{_data(message)}"


def _data(text: str) -> str:
    """As the runner unescapes a message: `%`, CR and LF."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    """As the runner unescapes a property: a message's, and `:` and `,`."""
    return _data(text).replace(":", "%3A").replace(",", "%2C")
