"""Where a command writes: streams, colour and whether somebody is watching."""

import os
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TextIO

from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.file_names import shown

# C0 and C1 controls, and what turns the direction of writing (Unicode's Bidi_Control).
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
_RED, _YELLOW, _PLAIN = "\x1b[1;31m", "\x1b[1;33m", "\x1b[0m"


@dataclass(slots=True)
class Terminal:
    """The streams of one run: results go to `stdout`, everything else to `stderr`."""

    stdout: TextIO = field(default_factory=lambda: sys.stdout)
    stderr: TextIO = field(default_factory=lambda: sys.stderr)
    variables: Mapping[str, str] = field(default_factory=lambda: os.environ)
    is_interrupted: Callable[[], bool] = lambda: False

    def result(self, text: str) -> None:
        """Write a result; where the reader went away it has what it wanted, and nothing fails.

        Raises TimemapError where it cannot be written, on a full disk say.
        """
        self._written(lambda: self.stdout.write(_harmless(text if text.endswith("\n") else f"{text}\n")))

    def data(self, content: bytes) -> None:
        """Write the bytes of a file as they are, where a program reads them.

        Raises UsageError where that is a terminal, TimemapError where they cannot be written.
        """
        if self.stdout.isatty():
            raise UsageError(
                "standard output is a terminal, and what comes is not for people to read",
                hint="-o FILE, or a program that reads it: | ...",
            )
        self._written(lambda: self.stdout.buffer.write(content))

    def _written(self, write: Callable[[], int]) -> None:
        try:
            write()
            self.stdout.flush()
        except BrokenPipeError:
            _drop(self.stdout)
        except OSError as error:
            _drop(self.stdout)
            reason = (error.strerror or str(error)).lower()
            raise TimemapError(f"cannot write to standard output: {reason}") from error

    def note(self, text: str) -> None:
        """Say something that is neither result nor trouble."""
        self._say(_harmless(text))

    def warn(self, text: str) -> None:
        """Say that something is not as it should be, while the work goes on."""
        self._say(f"{self._painted('warning:', _YELLOW)} {_one_line(text)}")

    def error(self, error: TimemapError) -> None:
        """Say what went wrong and, below it, what to try."""
        self._say(f"{self._painted('error:', _RED)} {_one_line(error.message)}")
        self.hint(error.hint)

    def hint(self, lines: str | None) -> None:
        """Say what to try, below what was said before; nothing where there is nothing to try."""
        for line in lines.split("\n") if lines else ():
            self._say(f"  try: {_harmless(line)}")

    def is_watched(self) -> bool:
        """Whether somebody looks at what goes to `stderr`."""
        return self.stderr.isatty()

    def _say(self, line: str) -> None:
        """Write a line to `stderr`, to nobody where the terminal is gone: that is no reason to stop the work."""
        try:
            self.stderr.write(f"{line}\n")
            self.stderr.flush()
        except OSError:
            _drop(self.stderr)

    def _painted(self, word: str, colour: str) -> str:
        plain = self.variables.get("NO_COLOR") or self.variables.get("TERM") == "dumb"
        return word if plain or not self.is_watched() else f"{colour}{word}{_PLAIN}"


def _harmless(text: str) -> str:
    """Text in which no control character but tab and newline is left: names in a recording may hold any.

    A terminal would take them for orders: colours, titles, what stood there before.
    """
    return _CONTROL.sub(lambda found: found[0].encode("unicode_escape").decode(), shown(text))


def _one_line(text: str) -> str:
    """A sentence, in which a name may hold line feeds: what follows one must not look like our own words."""
    return _harmless(text).replace("\n", "\\n")


def _drop(stream: TextIO) -> None:
    """Let a stream lead nowhere: the interpreter flushes it once more on its way out and would complain."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, stream.fileno())
    os.close(null)
