"""Where a command writes: streams, colour and whether somebody is watching."""

import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TextIO

from timemap_cli.errors import TimemapError

_RED, _YELLOW, _PLAIN = "\x1b[1;31m", "\x1b[1;33m", "\x1b[0m"


@dataclass(slots=True)
class Terminal:
    """The streams of one run: results go to `stdout`, everything else to `stderr`."""

    stdout: TextIO = field(default_factory=lambda: sys.stdout)
    stderr: TextIO = field(default_factory=lambda: sys.stderr)
    variables: Mapping[str, str] = field(default_factory=lambda: os.environ)
    is_interrupted: Callable[[], bool] = lambda: False

    def result(self, text: str) -> None:
        """Write a result; where the reader went away it has what it wanted, and nothing fails."""
        try:
            self.stdout.write(text if text.endswith("\n") else f"{text}\n")
            self.stdout.flush()
        except BrokenPipeError:
            # The interpreter flushes standard output once more on its way out and would complain.
            self._drop_results()

    def note(self, text: str) -> None:
        """Say something that is neither result nor trouble."""
        self.stderr.write(f"{text}\n")

    def warn(self, text: str) -> None:
        """Say that something is not as it should be, while the work goes on."""
        self.stderr.write(f"{self._painted('warning:', _YELLOW)} {text}\n")

    def error(self, error: TimemapError) -> None:
        """Say what went wrong and, below it, what to try."""
        self.stderr.write(f"{self._painted('error:', _RED)} {error.message}\n")
        self.hint(error.hint)

    def hint(self, lines: str | None) -> None:
        """Say what to try, below what was said before; nothing where there is nothing to try."""
        for line in (lines or "").splitlines():
            self.stderr.write(f"  try: {line}\n")

    def is_watched(self) -> bool:
        """Whether somebody looks at what goes to `stderr`."""
        return self.stderr.isatty()

    def _drop_results(self) -> None:
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, self.stdout.fileno())
        os.close(null)

    def _painted(self, word: str, colour: str) -> str:
        plain = self.variables.get("NO_COLOR") or self.variables.get("TERM") == "dumb"
        return word if plain or not self.is_watched() else f"{colour}{word}{_PLAIN}"
