"""One damaged recording: made, replayed, judged."""

import io
import json
import re
import resource
import shutil
import traceback
import zlib
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

from benchmarks.damage.damages import damage_path
from benchmarks.damage.recordings import FORMATS
from timemap_cli.cli.main import main
from timemap_cli.cli.terminal import Terminal
from timemap_cli.results.reader import ResultReader

MOST_MB = 1024  # resident, of the whole process
# Every dropped scan counts as loss here: six seconds are too short for a share.
OPTIONS = ("--max-dropped", "0", "--json")


class Verdict(StrEnum):
    """What became of a damaged recording; the last four must never come."""

    REFUSED = "refused"  # one error, exit code 1 or 2
    TOLD = "told"  # a result, exit code 3
    WHOLE = "whole"  # exit code 0, and the result is the undamaged recording's
    VALUES = "values"  # exit code 0, all scans are used, the result differs: numbers were changed
    SILENT = "SILENT"  # exit code 0, and scans are missing
    CRASH = "CRASH"
    MEMORY = "MEMORY"
    HANG = "HANG"


BAD = (Verdict.SILENT, Verdict.CRASH, Verdict.MEMORY, Verdict.HANG)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What the program said about one recording."""

    code: int
    out: str
    err: str
    digest: int | None  # of the result's estimates

    @property
    def used(self) -> int:
        """Scans that went into the result."""
        return int(json.loads(self.out)["scans"]["used"])


@dataclass(frozen=True, slots=True)
class Trial:
    """One case, and what came of it."""

    number: int
    damage: str
    verdict: Verdict
    words: str


class Bench:
    """An undamaged recording of one format in a folder, and what its replay gives."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name = name
        self._folder = folder
        (folder / "good").mkdir()
        self._good = FORMATS[name](folder / "good" / "run")
        self.expected = self._replay(self._good)
        if self.expected.code:
            raise RuntimeError(f"the undamaged {name} is not read: {self.expected.err}")

    def trial(self, number: int, seed: int) -> Trial:
        """Damage a copy by the case's own random numbers, replay it and judge."""
        rng = np.random.default_rng([seed, zlib.crc32(self.name.encode()), number])
        copy = self._folder / self._good.name
        self.copy_to(copy)
        damage = damage_path(copy, rng)
        try:
            verdict, words = self._judge(self._replay(copy))
        except Exception:  # noqa: BLE001 - that is what is looked for
            verdict, words = Verdict.CRASH, traceback.format_exc()
        if verdict not in BAD and peak_mb() > MOST_MB:
            verdict, words = Verdict.MEMORY, f"{peak_mb():.0f} MB"
        return Trial(number, damage, verdict, words)

    def copy_to(self, path: Path) -> None:
        """The undamaged recording, at another place."""
        if self._good.is_dir():
            shutil.rmtree(path, ignore_errors=True)
            shutil.copytree(self._good, path)
        else:
            shutil.copyfile(self._good, path)

    def _replay(self, recording: Path) -> Outcome:
        result = self._folder / "result.mcap"
        result.unlink(missing_ok=True)
        out, err = io.StringIO(), io.StringIO()
        code = main(["replay", str(recording), "-o", str(result), *OPTIONS], Terminal(out, err, {}))
        return Outcome(code, out.getvalue(), err.getvalue(), _digest(result) if code in (0, 3) else None)

    def _judge(self, found: Outcome) -> tuple[Verdict, str]:
        if found.code in (1, 2):
            lines = [line for line in found.err.splitlines() if line.startswith("error: ")]
            return (Verdict.REFUSED if len(lines) == 1 else Verdict.CRASH), found.err
        if found.code == 3:
            return (Verdict.TOLD if "warning: " in found.err else Verdict.SILENT), found.err
        if found.code != 0:
            return Verdict.CRASH, f"exit code {found.code}: {found.err}"
        if found.used < self.expected.used:
            return Verdict.SILENT, f"{found.out}{found.err}"
        if found.digest == self.expected.digest:
            return Verdict.WHOLE, found.err
        return Verdict.VALUES, found.err


def peak_mb() -> float:
    """The most memory this process ever held [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def sentence(words: str) -> str:
    """An error or warning without what differs from case to case."""
    line = next((one for one in words.splitlines() if one.startswith(("error: ", "warning: "))), "")
    return re.sub(r"\d+", "N", re.sub(r"/\S+/", "", line))


def _digest(result: Path) -> int:
    """A checksum over the estimates of all levels and nodes."""
    crc = 0
    with ResultReader(result) as reader:
        for level in reader.levels:
            for number, estimate in sorted(reader.estimates(level).items()):
                crc = zlib.crc32(repr(number).encode() + estimate.ranges.tobytes(), crc)
    return crc
