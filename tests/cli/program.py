"""Running the program inside the test, with its own streams."""

import io
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from timemap_cli.cli.main import main
from timemap_cli.cli.terminal import Terminal


class Screen(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self):
        return True


@dataclass(frozen=True, slots=True)
class Outcome:
    code: int
    out: str
    err: str


def timemap(*args: object, variables: Mapping[str, str] | None = None, screen: bool = False) -> Outcome:
    """What a call of `timemap` prints and returns."""
    out, err = (Screen(), Screen()) if screen else (io.StringIO(), io.StringIO())
    code = main([str(arg) for arg in args], Terminal(out, err, variables or {}))
    return Outcome(code, out.getvalue(), err.getvalue())


def python(code: str, **more):
    """A Python process that runs some lines."""
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False, **more
    )
