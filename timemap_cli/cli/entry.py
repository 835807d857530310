"""Entry of the `timemap` command: streams and signals are in order before anything is imported that takes time."""

import os
import signal
import sys
import time
from contextlib import suppress

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_CLEARING_UP_S = 1.0  # no second interrupt within it: `timeout` and a closing terminal send theirs twice


class Interrupts:
    """Ctrl-C, SIGTERM and SIGHUP, as a KeyboardInterrupt that is remembered.

    Python loses an exception that arises where it cannot be raised, as in a destructor: whoever works for long
    asks now and then.
    """

    def __init__(self) -> None:
        self._seen_at: float | None = None

    def listen(self) -> None:
        """Catch them from now on; what the shell or `nohup` said to ignore stays ignored."""
        for number in _SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._interrupt)

    def were_seen(self) -> bool:
        """Whether one has come."""
        return self._seen_at is not None

    def _interrupt(self, _signal: int, _frame: object) -> None:
        now = time.monotonic()
        if self._seen_at is None or now - self._seen_at > _CLEARING_UP_S:
            self._seen_at = now
            raise KeyboardInterrupt


def run() -> None:
    """Run the program on the command line's words and end with its exit code."""
    interrupts = Interrupts()
    try:
        interrupts.listen()
        _mend_streams()
        from timemap_cli.cli.main import main
        from timemap_cli.cli.terminal import Terminal

        code = main(sys.argv[1:], Terminal(is_interrupted=interrupts.were_seen))
    except KeyboardInterrupt:  # outside of main: while it was being imported
        with suppress(OSError):  # the terminal may be gone
            print("interrupted", file=sys.stderr)  # noqa: T201
        code = 130
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)  # all is done
    # Python notes an interrupt that leaves an exec of text, as those within `dataclass`, and with `-m` dies of SIGINT
    # at its end although it was caught; every exec of text begins by clearing that note.
    exec("")
    sys.exit(code)


def _mend_streams() -> None:
    """Have both streams, closed ones (`>&-`) too, and let them show what their encoding lacks."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            # Takes the free number 1 or 2, so that no file that is opened later gets it.
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115
        # A topic's name may hold letters that the terminal's encoding lacks.
        getattr(sys, name).reconfigure(errors="backslashreplace")
