"""Replays that are stopped at random moments: what was there before must stay readable and as it was.

`make kill-bench`, or `python -m benchmarks.stopped_replays [--kills 50] [--others 10] [LOG ...]`. Each replay
writes over an earlier result with --force and is stopped by `kill -9`, Ctrl-C, SIGTERM or SIGHUP. Judged afterwards:
the result in its place, what lies beside it, the exit code, what was said, and whether the second process is gone.
"""

import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from timemap_cli.results.reader import ResultReader

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = (ROOT / "sample_logs" / "patrol_monday.mcap",)
PYTHON_S = 0.3  # until then Python itself is starting, and answers Ctrl-C with its own words
_WAIT_S = 10.0


@dataclass(frozen=True, slots=True)
class Stop:
    """One replay that was stopped, and what was found afterwards."""

    number: signal.Signals
    after_s: float
    in_place: str  # "earlier", "new" (it was done already), or what is wrong with it
    beside: int  # files beside the result
    exit_code: int
    said: str
    alive: tuple[int, ...]  # processes of it that are still there

    @property
    def trouble(self) -> tuple[str, ...]:
        """What should not be so."""
        killed = self.number is signal.SIGKILL
        expected = {-signal.SIGKILL, 0} if killed else {130, 0}
        checks = {
            f"the result in its place is {self.in_place}": self.in_place in ("earlier", "new"),
            f"{self.beside} files beside it": self.beside <= killed,
            f"exit code {self.exit_code}": self.exit_code in expected,
            f"it said {self.said!r}": "Traceback" not in self.said,
            f"processes {self.alive} live on": not self.alive,
        }
        return tuple(what for what, is_right in checks.items() if not is_right)


class Trial:
    """An earlier result and the replay that is to replace it, in a folder of their own."""

    def __init__(self, folder: Path, logs: Sequence[Path]) -> None:
        self.output = folder / "output" / "building.timemap.mcap"
        self.output.parent.mkdir()
        self._command = [sys.executable, "-m", "timemap_cli", "replay", *map(str, logs), "--force", "-o"]
        self._earlier, self._new = folder / "earlier.timemap.mcap", folder / "new.timemap.mcap"
        self._replay(self._earlier, "--seed", "1")
        began = time.perf_counter()
        self._replay(self._new)
        self.whole_s = time.perf_counter() - began
        shutil.copy(self._earlier, self.output)

    def stop(self, number: signal.Signals, after_s: float) -> Stop:
        """Begin the replay, stop it, look at what is there; the earlier result is in its place again then."""
        process = subprocess.Popen(
            [*self._command, str(self.output)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        time.sleep(after_s)
        both = (process.pid, *_children(process.pid))
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
        alive = _alive_after(_WAIT_S, both)
        found = Stop(
            number,
            after_s,
            self._in_place(),
            len(self.beside()),
            process.returncode,
            said,
            alive,
        )
        if found.in_place != "earlier":
            shutil.copy(self._earlier, self.output)
        return found

    def beside(self) -> list[str]:
        """Names of what lies beside the result."""
        return sorted(path.name for path in self.output.parent.iterdir() if path != self.output)

    def finish(self) -> str:
        """Replay once more, to the end; says what is in the result's place then."""
        self._replay(self.output)
        return self._in_place()

    def _replay(self, output: Path, *options: str) -> None:
        subprocess.run(
            [*self._command, str(output), *options], check=True, stdout=subprocess.DEVNULL, timeout=600
        )

    def _in_place(self) -> str:
        with ResultReader(self.output) as result:  # raises where anything is damaged
            for level in result.levels:
                result.estimates(level)
            result.changes  # noqa: B018 - reads it
        found = self.output.read_bytes()
        for name, path in (("earlier", self._earlier), ("new", self._new)):
            if found == path.read_bytes():
                return name
        return "neither the earlier nor the new one"


def stops(trial: Trial, numbers: Sequence[signal.Signals], seed: int) -> list[Stop]:
    """One stopped replay for each signal, at random moments."""
    chance = random.Random(seed)
    found = []
    for number in numbers:
        least_s = 0.0 if number is signal.SIGKILL else PYTHON_S
        found.append(trial.stop(number, chance.uniform(least_s, trial.whole_s)))
    return found


def _children(pid: int) -> tuple[int, ...]:
    try:
        return tuple(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split()))
    except OSError:
        return ()


def _alive_after(seconds: float, pids: Sequence[int]) -> tuple[int, ...]:
    """Those of the processes that are there after so long, or none as soon as all have ended."""
    until = time.monotonic() + seconds
    while alive := tuple(pid for pid in pids if _is_alive(pid)):
        if time.monotonic() > until:
            break
        time.sleep(0.02)
    return alive


def _is_alive(pid: int) -> bool:
    try:
        return ") Z " not in Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return False


@click.command()
@click.argument("logs", nargs=-1, type=click.Path(exists=True, path_type=Path))
@click.option("--kills", default=50, help="Replays stopped by `kill -9`.")
@click.option("--others", default=10, help="Replays stopped by each of Ctrl-C, SIGTERM and SIGHUP.")
@click.option("--seed", default=0)
def main(logs: tuple[Path, ...], kills: int, others: int, seed: int) -> None:
    """Stop replays at random moments and tell what was found."""
    numbers = [signal.SIGKILL] * kills + [signal.SIGINT, signal.SIGTERM, signal.SIGHUP] * others
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(Path(folder), logs or SAMPLES)
        click.echo(f"a whole replay takes {trial.whole_s:.2f} s")
        found = stops(trial, numbers, seed)
        for number, some in sorted(Counter((stop.number.name, stop.in_place) for stop in found).items()):
            click.echo(f"{number[0]:8} {some:3} times, in place then: the {number[1]} result")
        for stop in found:
            for what in stop.trouble:
                click.echo(f"TROUBLE {stop.number.name} after {stop.after_s:.3f} s: {what}")
        left = sum(stop.beside > 0 for stop in found)
        click.echo(f"partial files were left by {left} of them; {len(trial.beside())} now")
        click.echo(
            f"after one more replay: the {trial.finish()} result, {len(trial.beside())} files beside it"
        )
    if any(stop.trouble for stop in found):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
