"""Which result a command is about, and what may give way to what it writes."""

from collections.abc import Callable
from pathlib import Path

from timemap_cli.cli.terminal import Terminal

HTML = b"<!doctype html>"  # begins a page of ours


def chosen_result(terminal: Terminal, result: Path | None) -> Path:
    """The result that was named, else the newest of the current folder, which is told on stderr."""
    from timemap_cli.comparing import newest_result

    if result is None:
        result = newest_result(Path())
        terminal.note(f"using {result}, the newest result in this folder")
    return result


def title_of(result: Path) -> str:
    """A result's name without its endings."""
    return result.name.removesuffix(".mcap").removesuffix(".timemap")


def begins_with(*heads: bytes) -> Callable[[Path], bool]:
    """Whether a file is of a kind, told by its first bytes in small letters: only such a file may give way."""

    def is_one(path: Path) -> bool:
        if not path.is_file():  # opening a pipe would wait for somebody to write
            return False
        with path.open("rb") as file:
            begin = file.read(max(map(len, heads))).lower()
        return any(begin.startswith(head.lower()) for head in heads)

    return is_one
