"""From a path a user gives to the open files of one recording, each recognised by its first bytes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import zstandard

from timemap_cli.errors import TimemapError, UsageError, no_such_file
from timemap_cli.logs.bag_file import BagFile
from timemap_cli.logs.listed_names import listed_names
from timemap_cli.logs.mcap_file import McapFile
from timemap_cli.logs.raw import Storage
from timemap_cli.logs.sqlite_file import SqliteFile

ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
OLD_BAG = re.compile(rb"#ROS(?:BAG|RECORD) V(\d+\.\d+)")
READERS: dict[bytes, Callable[[Path], Storage]] = {
    b"#ROSBAG V2.0\n": BagFile,
    b"\x89MCAP0\r\n": McapFile,
    b"SQLite format 3\0": SqliteFile,
}
READABLE = "a ROS 1 bag, a ROS 2 bag (its folder or a file of it) or an MCAP file"
METADATA = "metadata.yaml"
RESULT_RECORD = "timemap"  # name of the metadata record in every result of ours


@dataclass(frozen=True, slots=True)
class OpenFiles:
    """The files of a recording in order of time, what of them is missing, and what is odd but costs nothing."""

    storages: Sequence[Storage]
    problems: Sequence[str] = ()
    remarks: Sequence[str] = ()


def open_files(path: Path, stack: ExitStack) -> OpenFiles:
    """Open the files of the recording at ``path``.

    ``stack`` closes them. Raises UsageError where there is no recording, and what the readers raise.
    """
    if path.is_dir():
        paths, problems, remarks = _files_of_folder(path)
    elif path.exists():
        paths, problems, remarks = [path], [], []
    else:
        raise no_such_file(path, READABLE)
    storages = [_open_file(one, stack) for one in paths]
    storages.sort(key=lambda storage: storage.start_ns)
    return OpenFiles(storages, problems, remarks)


def _open_file(path: Path, stack: ExitStack) -> Storage:
    head = _head(path)
    if head.startswith(ZSTD_MAGIC):
        unpacked = _decompressed(path, stack)
        head, source = _head(unpacked), unpacked
    else:
        source = path
    reader = _reader(head)
    if reader is None:
        raise _refusal(path, head)
    storage = reader(source)
    stack.callback(storage.close)
    if isinstance(storage, McapFile) and RESULT_RECORD in storage.metadata_names:
        raise UsageError(
            f"{path} is a result of timemap, not a recording",
            hint=f"timemap diff {path} --level long mid",
        )
    return storage


def _reader(head: bytes) -> Callable[[Path], Storage] | None:
    return next((reader for magic, reader in READERS.items() if head.startswith(magic)), None)


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(32)


def _refusal(path: Path, head: bytes) -> TimemapError:
    """What to say about a file that is no recording we read."""
    if old := OLD_BAG.match(head):
        version = old.group(1).decode()
        return UsageError(
            f"{path} is a ROS bag of version {version}; only version 2.0 is read",
            hint="convert it with ROS 1: rosbag fix OLD.bag NEW.bag",
        )
    reason = "it is empty" if not head else "it is neither a ROS 1 bag nor a ROS 2 bag nor an MCAP file"
    return UsageError(f"{path} is not a recording: {reason}", hint=READABLE)


def _decompressed(path: Path, stack: ExitStack) -> Path:
    """The file without its compression, in a temporary folder that ``stack`` removes."""
    folder = stack.enter_context(TemporaryDirectory(prefix="timemap-"))
    target = Path(folder) / path.stem
    with path.open("rb") as packed, target.open("wb") as unpacked:
        zstandard.ZstdDecompressor().copy_stream(packed, unpacked)
    return target


def _files_of_folder(folder: Path) -> tuple[list[Path], list[str], list[str]]:
    """The storage files of a bag folder, those its metadata names or all where it has none; problems and remarks."""
    try:
        names = listed_names(folder / METADATA)
    except FileNotFoundError:
        return _found_files(folder), [], []
    except ValueError:
        return _found_files(folder), [], [f"{METADATA} cannot be read; all files beside it are"]
    paths, problems = [], []
    for name in names:
        # Older rosbag2 names a compressed file without the suffix it gave it.
        either = (folder / name, folder / f"{name}.zstd")
        present = [one for one in either if one.is_file() or one.is_dir()]  # opening a pipe would wait
        if present:
            paths.append(present[0])
        else:
            problems.append(f"{name} is missing, although {METADATA} names it")
    if not paths:
        raise UsageError(f"{folder} holds none of the files that its {METADATA} names")
    return paths, problems, []


def _found_files(folder: Path) -> list[Path]:
    """The recording in a folder without metadata: one file, or the numbered parts of one recording."""
    heads = {one: _head(one) for one in sorted(folder.iterdir()) if one.is_file()}
    paths = [one for one, head in heads.items() if head.startswith(ZSTD_MAGIC) or _reader(head)]
    if not paths:
        raise UsageError(f"{folder} holds no recording", hint=READABLE)
    if len({_stem(one) for one in paths}) > 1:
        raise UsageError(
            f"{folder} holds several recordings; name those you want",
            hint="\n".join(str(one) for one in paths),
        )
    return paths


def _stem(path: Path) -> tuple[str, Sequence[str]]:
    """What the numbered parts of one recording have in common: name without number, suffixes."""
    name, *suffixes = path.name.split(".")
    return re.sub(r"_\d+$", "", name), tuple(suffixes)
