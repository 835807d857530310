"""Recordings that are made once, in a folder named after the scripts that make them, and their replays.

A replay's result is kept beside its recordings under a name that tells the recordings and the options of the replay,
but not the program: who changes what a replay does asks for it `again`.
"""

import hashlib
import json
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import click
from rosbags.rosbag2 import StoragePlugin

from sample_logs.drives import Drive
from sample_logs.recorder import write_ros2_folder

ROOT = Path(__file__).resolve().parents[2]
TIMEMAP = str(Path(sys.executable).with_name("timemap"))
_DATA_LOST = 3  # exit code of a replay that is done, but left out more scans than it should


@dataclass(frozen=True, slots=True)
class Replayed:
    """A result, and how many scans were read and dropped, by reason."""

    result: Path
    read: int
    dropped: Mapping[str, int]

    @property
    def lost(self) -> str:
        """The shares of dropped scans in words."""
        shares = [f"{reason} {count / self.read:.2%}" for reason, count in self.dropped.items() if count]
        return f"{self.read} scans, dropped: {', '.join(shares) or 'none'}"


def timemap_json(*arguments: str, also: Iterable[int] = ()) -> dict[str, Any]:
    """What a call of timemap prints with --json; RuntimeError where it ends with neither 0 nor one of `also`."""
    ran = subprocess.run([TIMEMAP, *arguments, "--json"], capture_output=True, text=True, check=False)
    if ran.returncode not in {0, *also}:
        raise RuntimeError(f"timemap {arguments[0]} ended with {ran.returncode}: {ran.stderr.strip()}")
    document: dict[str, Any] = json.loads(ran.stdout)
    return document


def folder_of(folder: Path, world: str, modules: Iterable[ModuleType]) -> Path:
    """Where recordings of a world that these modules and the simulator make as they are now belong."""
    made_by = sorted((ROOT / "sample_logs").glob("*.py")) + [Path(str(m.__file__)) for m in modules]
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in made_by))
    return folder / f"{world}_{digest.hexdigest()[:8]}"


def make(folder: Path, drives: Mapping[str, Drive]) -> list[Path]:
    """Write the recordings, given by name, that `folder` does not hold yet; the paths of all, in order."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, drive in drives.items():
        path = folder / name
        if not (path / "metadata.yaml").exists():
            shutil.rmtree(path, ignore_errors=True)  # left behind by a run that was interrupted
            write_ros2_folder(path, drive.events(), StoragePlugin.MCAP, compressed=True)
    return [folder / name for name in drives]


def replayed(recordings: Sequence[Path], result: Path, *options: str, again: bool = False) -> Replayed:
    """Replay all recordings into one result, unless it is there; RuntimeError where that fails."""
    told = result.with_suffix(".json")
    if again or not (result.exists() and told.exists()):
        result.parent.mkdir(parents=True, exist_ok=True)
        logs = map(str, recordings)
        document = timemap_json(
            "replay", *logs, "-o", str(result), "--force", "--quiet", *options, also=(_DATA_LOST,)
        )
        told.write_text(json.dumps(document), encoding="utf-8")
    else:
        click.echo(f"{result.name}: replayed before, kept (--again replays anew)", err=True)
    scans = json.loads(told.read_text(encoding="utf-8"))["scans"]
    return Replayed(result, scans["read"], scans["dropped"])


def known_as(recordings: Sequence[Path], *options: str) -> str:
    """A name for recordings that others made, from their bytes and the options of a replay."""
    digest = hashlib.sha256("\0".join(options).encode())
    for recording in recordings:
        files = sorted(recording.iterdir()) if recording.is_dir() else [recording]
        for file in files:
            digest.update(file.read_bytes())
    return digest.hexdigest()[:8]
