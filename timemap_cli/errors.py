"""What may go wrong that a user can mend, and the exit codes."""

import os
import shlex
import stat
from enum import IntEnum
from pathlib import Path


class ExitCode(IntEnum):
    """What the program tells the shell."""

    DONE = 0
    FAILED = 1
    USAGE = 2  # options, settings, missing or existing files, selection
    DATA_LOST = 3  # done, but a recording was cut off or too many scans were dropped
    DIFFERENT = 4  # a check failed, or there are differences and the caller asked for this code
    INTERRUPTED = 130


class TimemapError(Exception):
    """An expected failure: one sentence that names the value and the place, and a hint what to try.

    The hint may hold several lines, each of them something to do or to paste.
    """

    def __init__(
        self, message: str, *, hint: str | None = None, exit_code: ExitCode = ExitCode.FAILED
    ) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint
        self.exit_code = exit_code


class UsageError(TimemapError):
    """The call cannot be carried out as it was given: nothing was computed or written."""

    def __init__(self, message: str, *, hint: str | None = None) -> None:
        super().__init__(message, hint=hint, exit_code=ExitCode.USAGE)


def no_such_file(path: Path, otherwise: str) -> UsageError:
    """The error for a path at which nothing is: what is called much like it is proposed, or `otherwise`."""
    from difflib import get_close_matches

    names = [one.name for one in path.parent.iterdir()] if path.parent.is_dir() else []
    near = [str(path.with_name(name)) for name in get_close_matches(path.name, sorted(names), 1)]
    return UsageError(f"there is no file {path}", hint=near[0] if near else otherwise)


def refuse_pipe(path: Path) -> None:
    """UsageError for a pipe, a socket or a device: to read from one is to wait for somebody, or never to end.

    The null device is as good as an empty file; of what is missing whoever opens it tells.
    """
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return
    if stat.S_ISREG(mode) or stat.S_ISDIR(mode) or str(path) == os.devnull:
        return
    what = "a pipe" if stat.S_ISFIFO(mode) else "a socket" if stat.S_ISSOCK(mode) else "a device"
    raise UsageError(f"{path} is {what}, not a file", hint="write what comes from it into a file first")


def as_word(name: str) -> str:
    """A name as one word of a line to paste into a shell, whatever a recording calls its topics and frames."""
    return shlex.quote("".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in name))
