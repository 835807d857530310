"""Calls of the program, one after the other in a process of their own: how each ends, in what time and memory."""

import json
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass

from tests.conftest import ROOT

MOST_S, MOST_MB = 2.0, 300
_PROGRAM = """
import io, json, resource, signal, sys, time
from timemap_cli.cli.main import main
from timemap_cli.cli.terminal import Terminal

resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))  # the test fails before the machine does

def stop(number, frame):
    raise SystemExit("it does not end")

signal.signal(signal.SIGALRM, stop)
for call in json.load(sys.stdin):
    out, err = io.StringIO(), io.StringIO()
    signal.alarm(60)
    began = time.process_time()
    try:
        code, trouble = main(call, Terminal(out, err, {})), ""
    except BaseException as error:
        code, trouble = -1, repr(error)
    signal.alarm(0)
    peak = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
    told = {"code": code, "out": out.getvalue(), "err": err.getvalue() or trouble}
    print(json.dumps(told | {"seconds": time.process_time() - began, "megabytes": int(peak.split()[1]) / 1000}))
"""


@dataclass(frozen=True, slots=True)
class Ended:
    """How a call ended."""

    code: int  # -1: with an exception
    out: str
    err: str
    seconds: float  # of the processor
    megabytes: float  # the most so far

    def is_one_error(self) -> bool:
        """Whether it is one sentence of bounded length and what to try, within the limits."""
        lines = self.err.splitlines()
        told = (
            bool(lines)
            and lines[0].startswith("error: ")
            and all(one.startswith("  try: ") for one in lines[1:])
        )
        within = self.seconds < MOST_S and self.megabytes < MOST_MB
        return (
            self.code in (1, 2)
            and told
            and within
            and len(lines[0]) < 600
            and "itself failed" not in self.err
        )


def ended(calls: Iterable[Iterable[object]]) -> list[Ended]:
    """Every call of `timemap` in turn; the first one warms up and is not told."""
    words = [["--version"], *([str(word) for word in call] for call in calls)]
    done = subprocess.run(
        [sys.executable, "-c", _PROGRAM],
        input=json.dumps(words),
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=False,
    )
    told = [Ended(**json.loads(line)) for line in done.stdout.splitlines()]
    assert len(told) == len(words), done.stderr
    return told[1:]
