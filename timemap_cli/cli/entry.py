"""Entry of the `timemap` command: streams and signals are in order before anything is imported that takes time."""

import os
import signal
import sys


class Interrupts:
    """Ctrl-C and SIGTERM, as a KeyboardInterrupt that is remembered.

    Python loses an exception that arises where it cannot be raised, as in a destructor: whoever works for long
    asks now and then.
    """

    def __init__(self) -> None:
        self._seen = False

    def listen(self) -> None:
        """Catch both from now on; Ctrl-C stays ignored where the shell said so."""
        if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
            signal.signal(signal.SIGINT, self._interrupt)
        signal.signal(signal.SIGTERM, self._interrupt)

    def were_seen(self) -> bool:
        """Whether one has come."""
        return self._seen

    def _interrupt(self, _signal: int, _frame: object) -> None:
        self._seen = True
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
        print("interrupted", file=sys.stderr)  # noqa: T201
        code = 130
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is done
    sys.exit(code)


def _mend_streams() -> None:
    """Have both streams, closed ones (`>&-`) too, and let them show what their encoding lacks."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            # Takes the free number 1 or 2, so that no file that is opened later gets it.
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: PTH123, SIM115
        # A topic's name may hold letters that the terminal's encoding lacks.
        getattr(sys, name).reconfigure(errors="backslashreplace")
