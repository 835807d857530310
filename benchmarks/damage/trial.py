"""One damaged recording: made, replayed, judged."""

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
from timemap_cli.config import load
from timemap_cli.errors import TimemapError
from timemap_cli.replay import replay
from timemap_cli.results.reader import ResultReader

MOST_MB = 1024  # resident, of the whole process
# Every dropped scan counts as loss here: six seconds are too short for a share. The map is a coarse one, to be quick.
SETTINGS = {
    "input": {"max_dropped": 0.0},
    "map": {"angle_bins": 60, "radius": 5.0, "node_spacing": 2.0},
    "levels": [{"name": "short", "window": 5, "half_life": "5obs"}],
}


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
    """What a replay of one recording says: its exit code, one error or the warnings, and what it made."""

    code: int
    words: str
    used: int = 0  # scans that went into the result
    digest: int = 0  # of the result's estimates


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
        self._settings = load(None, SETTINGS)
        (folder / "good").mkdir()
        self._good = FORMATS[name](folder / "good" / "run")
        self.expected = self._replay(self._good)
        if self.expected.code:
            raise RuntimeError(f"the undamaged {name} is not read: {self.expected.words}")

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
        try:
            summary = replay([recording], result, self._settings)
        except TimemapError as error:
            return Outcome(error.exit_code, f"error: {error.message}")
        words = "\n".join(f"warning: {one}" for one in summary.warnings)
        return Outcome(3 if summary.data_lost else 0, words, summary.scans_used, _digest(result))

    def _judge(self, found: Outcome) -> tuple[Verdict, str]:
        if found.code in (1, 2):
            return Verdict.REFUSED, found.words
        if found.code == 3:
            return (Verdict.TOLD if found.words else Verdict.SILENT), found.words
        if found.used < self.expected.used:
            return Verdict.SILENT, f"{found.used} scans of {self.expected.used}\n{found.words}"
        return (Verdict.WHOLE if found.digest == self.expected.digest else Verdict.VALUES), found.words


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
