"""Where a command writes what it makes: the suffix says the format, and `-` is standard output."""

from collections.abc import Callable, Sequence
from pathlib import Path

from timemap_cli.cli.chosen import begins_with
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import UsageError

STANDARD_OUTPUT = "-"
RESULT = (".mcap",)
PAGE = (".html", ".htm")


def is_standard_output(output: Path) -> bool:
    """Whether an output is `-`, and not a file."""
    return str(output) == STANDARD_OUTPUT


def required_suffix(output: Path, suffixes: Sequence[str], what: str, option: str = "-o ") -> str:
    """The suffix of an output, in small letters; UsageError where it is none of those that `what` may have."""
    suffix = output.suffix.lower()
    if suffix not in suffixes:
        choice = " or ".join([", ".join(suffixes[:-1]), suffixes[-1]] if suffixes[1:] else suffixes)
        raise UsageError(
            f"{output} is no name of {what}, which ends in {choice}",
            hint=f"{option}{output.with_suffix(suffixes[0]) if output.name else 'NAME' + suffixes[0]}",
        )
    return suffix


def require_file(output: Path, what: str, option: str) -> None:
    """UsageError for `-`, where standard output does not do."""
    if is_standard_output(output):
        raise UsageError(f"{what} is a file: it does not go to standard output", hint=option)


def write_output(
    terminal: Terminal,
    output: Path,
    make: Callable[[], bytes],
    *,
    force: bool,
    heads: Sequence[bytes],
    replaced: str,
) -> None:
    """Write what `make` gives into a file that takes its name when it is whole, and tell its name; or to `-`.

    Only a file that begins with one of `heads` may give way, which `replaced` says what it is. UsageError where a file
    cannot be written or standard output is a terminal.
    """
    if is_standard_output(output):
        terminal.data(make())
        return
    from timemap_cli.results.atomic_file import AtomicFile

    with AtomicFile(output, force=force, may_replace=begins_with(*heads), replaced=replaced) as file:
        file.write(make())
        file.commit()
    terminal.result(str(output))
