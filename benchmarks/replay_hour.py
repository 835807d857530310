"""An hour of a 10 Hz, 1081-beam scanner: the whole `timemap replay` beside plain reading with rosbags.

`python benchmarks/replay_hour.py [--minutes 5] [--rounds 3] [--folder DIR]`. The recording is made first
if DIR does not hold it yet. Both sides run as processes of their own, in turns; what counts is the
processor time of the process with all its children, the time on the clock, and the peak of their memory
together (each page counted once, looked at ten times a second).
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from threading import Thread
from typing import Any

import click

ROOT = Path(__file__).resolve().parents[1]
READER = Path(__file__).with_name("read_with_rosbags.py")


@dataclass(frozen=True, slots=True)
class Cost:
    """What a process and its children took: processor and clock time [s], peak memory [MB]; what it printed."""

    cpu_s: float
    wall_s: float
    peak_mb: float
    output: str


def measured(command: Sequence[str]) -> Cost:
    """Run a command to its end; its exit code must be 0."""
    with tempfile.TemporaryFile("w+") as out:
        began = time.perf_counter()
        process = subprocess.Popen(command, stdout=out, cwd=ROOT)
        peak = _Peak(process.pid)
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise click.ClickException(f"{command[0]} ended with exit code {process.returncode}")
        out.seek(0)
        return Cost(usage.ru_utime + usage.ru_stime, wall_s, peak.megabytes(), out.read())


class _Peak:
    """Watches the memory of a process and its children."""

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._most_kb = 0
        self._thread = Thread(target=self._watch)
        self._thread.start()

    def megabytes(self) -> float:
        """The most there was, once the process has ended."""
        self._thread.join()
        return self._most_kb / 1024

    def _watch(self) -> None:
        while memory_kb := self._memory_kb():
            self._most_kb = max(self._most_kb, memory_kb)
            time.sleep(0.1)

    def _memory_kb(self) -> int:
        """Proportional set sizes together; 0 when the process has ended."""
        try:
            children = Path(f"/proc/{self._pid}/task/{self._pid}/children").read_text().split()
            own = _pss_kb(self._pid)
        except OSError:
            return 0
        return own + sum(_pss_kb(int(child)) for child in children) if own else 0


def _pss_kb(pid: int) -> int:
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in lines if line.startswith("Pss:")), 0)


def make_recording(folder: Path, minutes: float) -> Path:
    """Path of the recording, made now if it is not there yet."""
    command = [sys.executable, "-m", "benchmarks.make_hour", str(folder), "--minutes", str(minutes)]
    return Path(measured(command).output.strip())


def compare(recording: Path, rounds: int) -> tuple[list[Cost], list[Cost]]:
    """Costs of replaying and of plain reading, measured in turns after one unmeasured reading."""
    with tempfile.TemporaryDirectory() as folder:
        result = str(Path(folder) / "hour.timemap.mcap")
        timemap = str(Path(sys.executable).with_name("timemap"))
        replay = [timemap, "replay", str(recording), "-o", result, "--force", "--json"]
        read = [sys.executable, str(READER), str(recording)]
        measured(read)
        pairs = [(measured(replay), measured(read)) for _ in range(rounds)]
    return [pair[0] for pair in pairs], [pair[1] for pair in pairs]


def report(replays: Sequence[Cost], reads: Sequence[Cost]) -> str:
    """The table, its medians and ratios, and what the replay made of the recording."""
    made = json.loads(replays[-1].output)
    scans = made["scans"]
    lines = [
        f"{'':24}{'replay':>10}{'rosbags':>10}{'ratio':>8}",
        _row("processor time [s]", replays, reads, lambda cost: cost.cpu_s),
        _row("time on the clock [s]", replays, reads, lambda cost: cost.wall_s),
        _row("peak memory [MB]", replays, reads, lambda cost: cost.peak_mb),
        "",
        f"scans used  {scans['used']} of {scans['read']} ({_share(scans):.1%})",
        f"nodes       {made['nodes']}",
    ]
    return "\n".join(lines)


def _row(name: str, replays: Sequence[Cost], reads: Sequence[Cost], value: Callable[[Cost], float]) -> str:
    """Median of each side, and the median of the ratios of neighbouring runs."""
    ratio = median(value(a) / value(b) for a, b in zip(replays, reads, strict=True))
    ours, theirs = median(map(value, replays)), median(map(value, reads))
    return f"{name:24}{ours:10.2f}{theirs:10.2f}{ratio:8.2f}"


def _share(scans: dict[str, Any]) -> float:
    return float(scans["used"]) / max(1, int(scans["read"]))


@click.command()
@click.option(
    "--folder", type=click.Path(path_type=Path), default=ROOT / "build" / "bench", show_default=True
)
@click.option("--minutes", default=60.0, show_default=True, help="Length of the recording.")
@click.option("--rounds", default=3, show_default=True, help="How often each side runs.")
@click.option(
    "--recording", type=click.Path(path_type=Path, exists=True), help="Measure on this one instead."
)
def main(folder: Path, minutes: float, rounds: int, recording: Path | None) -> None:
    """Compare a replay with plain reading of the same topics."""
    path = recording or make_recording(folder.resolve(), minutes)
    click.echo(
        f"{path.name}: {sum(f.stat().st_size for f in _files(path)) / 1e6:.0f} MB, {rounds} rounds in turns"
    )
    click.echo(report(*compare(path.resolve(), rounds)))


def _files(path: Path) -> list[Path]:
    return [path] if path.is_file() else [file for file in path.iterdir() if file.is_file()]


if __name__ == "__main__":
    main()
