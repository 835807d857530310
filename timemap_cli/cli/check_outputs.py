"""Where the verdict of a check goes: formats on standard output, in files, and in the summary of a GitHub job."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from timemap_cli.cli.chosen import begins_with
from timemap_cli.cli.outputs import STANDARD_OUTPUT, required_suffix
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import UsageError, refuse_pipe
from timemap_cli.file_names import shown

if TYPE_CHECKING:
    from timemap_cli.checks.verdict import CheckedCase
    from timemap_cli.results.atomic_file import AtomicFile

Output = tuple[str, Path | None]  # format, and the file it goes to; None: standard output

_HEADS = {  # each format, and how a file of it begins
    "text": (b"passed ", b"failed ", b"error "),
    "json": (b'{\n  "schema": "timemap.check/',),
    "junit": (b'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites name="timemap check"',),
    "github": (b"::notice ", b"::warning ", b"::error "),
    "markdown": (b"### ",),
}


_SUFFIXES = {  # each format, and what its file may be called, if the suffix says anything
    "text": (".txt", ".log"),
    "json": (".json",),
    "junit": (".xml",),
    "github": (".txt", ".log"),
    "markdown": (".md", ".markdown", ".txt"),
}
_TELLING = {".html", ".htm", ".mcap", ".bag", ".yaml", ".yml", ".png", ".svg", ".pdf"}.union(
    *_SUFFIXES.values()
)


def wanted(formats: Sequence[str]) -> list[tuple[str, Path | None]]:
    """Formats and the files they go to; None is standard output, which takes one at most."""
    found: list[Output] = []
    for word in formats or ("text",):
        name, equals, file = word.partition("=")
        if name not in _HEADS:
            raise UsageError(f"unknown format {name}", hint=f"one of {', '.join(_HEADS)}")
        if equals and not file:
            raise UsageError(
                f"--format {word} names no file", hint=f"--format {name}, or --format {name}=FILE"
            )
        found.append((name, _file(name, file) if equals and file != STANDARD_OUTPUT else None))
    if sum(file is None for _, file in found) > 1:
        raise UsageError("standard output takes one format", hint="--format junit=junit.xml --format github")
    return found


def _file(form: str, name: str) -> Path:
    """The file that a format goes to; UsageError where its name says that it is another one."""
    file = Path(name)
    if file.suffix.lower() in _TELLING:
        required_suffix(file, _SUFFIXES[form], f"a file of {form}", f"--format {form}=")
    return file


def require_writable(wanted: Sequence[Output]) -> None:
    """UsageError where a file cannot be written: before the work, not after it."""
    files = [file for _, file in wanted if file is not None]
    for one in files:
        if files.count(one) > 1:
            raise UsageError(
                f"two formats go to {one}", hint="--format junit=junit.xml --format json=check.json"
            )
    for form, file in wanted:
        if file is not None:
            with _opened(file, form):
                pass


def tell(
    terminal: Terminal, cases: "Sequence[CheckedCase]", wanted: Sequence[tuple[str, Path | None]]
) -> None:
    """Say every verdict in each of the formats wanted; warnings of the replays go to stderr."""
    for case in cases:
        for warning in case.warnings:
            terminal.warn(f"{case.name}: {warning}" if len(cases) > 1 else warning)
    for form, file in wanted:
        text = _formatted(form, cases)
        if file is None:
            terminal.result(text)
        else:
            _write(file, form, text)
        if form == "github" and (summary := terminal.variables.get("GITHUB_STEP_SUMMARY")):
            _append(terminal, Path(summary), _formatted("markdown", cases) + "\n")


def _append(terminal: Terminal, summary: Path, text: str) -> None:
    """Add to the job's summary; one that cannot be written changes no verdict."""
    try:
        refuse_pipe(summary)
        with summary.open("a", encoding="utf-8") as stream:
            stream.write(shown(text))
    except UsageError as error:
        terminal.warn(f"cannot write the job's summary: {error.message}")
    except OSError as error:
        terminal.warn(f"cannot write the job's summary {summary}: {(error.strerror or str(error)).lower()}")


def _write(path: Path, form: str, text: str) -> None:
    """Write what a check says into a file of its own, in place of what an earlier check said there."""
    with _opened(path, form) as file:
        file.write((shown(text).rstrip("\n") + "\n").encode())
        file.commit()


def _opened(path: Path, form: str) -> "AtomicFile":
    from timemap_cli.results.atomic_file import AtomicFile

    may_replace = begins_with(*_HEADS[form])
    return AtomicFile(path, force=True, may_replace=may_replace, replaced=f"the {form} of a check")


def _formatted(form: str, cases: "Sequence[CheckedCase]") -> str:
    from timemap_cli.reports.check_github import check_github
    from timemap_cli.reports.check_json import check_json
    from timemap_cli.reports.check_junit import check_junit
    from timemap_cli.reports.check_markdown import check_markdown
    from timemap_cli.reports.check_text import check_text

    writers = {
        "text": check_text,
        "json": check_json,
        "junit": check_junit,
        "github": check_github,
        "markdown": check_markdown,
    }
    return writers[form](cases)
