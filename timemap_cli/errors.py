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


def as_expected(error: Exception) -> TimemapError:
    """Any error as one that can be told in a sentence; one that nobody expected says where it arose."""
    if isinstance(error, TimemapError):
        return error
    if isinstance(error, OSError):
        reason = (error.strerror or str(error)).lower()
        return TimemapError(f"{error.filename}: {reason}" if error.filename else reason)
    if isinstance(error, MemoryError):
        return TimemapError("there is not enough memory")
    place = ""
    if error.__traceback__ is not None:
        import traceback

        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f" in {Path(last.filename).name}, line {last.lineno}"
    return TimemapError(
        f"timemap itself failed: {type(error).__name__}{place}: {shown(str(error))}",
        hint="report it, with the file that it fails on",
    )


def no_such_file(path: Path, otherwise: str) -> UsageError:
    """The error for a path at which nothing is: what is called much like it is proposed, or `otherwise`."""
    from difflib import get_close_matches

    names = [one.name for one in path.parent.iterdir()] if path.parent.is_dir() else []
    near = [str(path.with_name(name)) for name in get_close_matches(path.name, sorted(names), 1)]
    return UsageError(f"there is no file {path}", hint=near[0] if near else otherwise)


_MOST_SHOWN = 60


def shown(value: object) -> str:
    """A value of a file as a message shows it: in one line, and short, whatever it is and however large."""
    if isinstance(value, str):
        text = value[: 10 * _MOST_SHOWN]  # of a gigabyte the beginning is enough
    else:
        import reprlib

        text = reprlib.repr(value)
    text = " ".join(text.split())
    return text if len(text) <= _MOST_SHOWN else f"{text[: _MOST_SHOWN - 3]}..."


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
