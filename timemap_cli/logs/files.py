"""From a path a user gives to the open files of one recording, each recognised by its first bytes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import zstandard

from timemap_cli.errors import TimemapError, UsageError, no_such_file, refuse_pipe
from timemap_cli.logs.announced_counts import announced_counts
from timemap_cli.logs.bag_file import BagFile
from timemap_cli.logs.bounds import MOST_CHUNK_BYTES
from timemap_cli.logs.foreign_errors import FOREIGN_ERRORS, reason
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
# A compressed file is unpacked on the disk: to so many times its size, and so many bytes at least.
MOST_TIMES, LEAST_BYTES = 200, 64 << 20
PACKED_BYTES = 1024
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
    refuse_pipe(path)
    if path.is_dir():
        listed = _files_of_folder(path)
    elif path.exists():
        listed = _Listed([path])
    else:
        raise no_such_file(path, READABLE)
    paths, problems = listed.paths, list(listed.problems)
    storages: list[Storage] = []
    for one in paths:
        try:
            storages.append(_open_file(one, stack))
        except (TimemapError, *FOREIGN_ERRORS) as error:
            # Of several files of a recording the others are read.
            if len(paths) == 1 or isinstance(error, ResultGivenError):
                raise
            problems.append(f"{one.name} cannot be read and is left out: {reason(error, one)}")
    if not storages:
        raise UsageError(f"{path} holds no recording that can be read ({'; '.join(problems)})", hint=READABLE)
    storages.sort(key=lambda storage: storage.start_ns)
    return OpenFiles(storages, problems or _shortfalls(listed.counts, storages), listed.remarks)


def _shortfalls(announced: Mapping[str, int], storages: Sequence[Storage]) -> list[str]:
    """A sentence for every topic of which the metadata of a folder announces more than its files hold."""
    held: Counter[str] = Counter()
    for one in (connection for storage in storages for connection in storage.connections):
        held[one.topic] += one.count
    return [
        f"{METADATA} announces {count} messages of {topic}, and {held[topic]} are there"
        for topic, count in announced.items()
        if held[topic] < count
    ]


class ResultGivenError(UsageError):
    """A result of ours is given as a recording."""


def _open_file(path: Path, stack: ExitStack) -> Storage:
    head, source, damage = _head(path), path, ""
    if head.startswith(ZSTD_MAGIC):
        source, damage = _decompressed(path, stack)
        head = _head(source)
    reader = _reader(head)
    if reader is None:
        raise _refusal(path, head, damage)
    storage = reader(source)
    stack.callback(storage.close)
    if damage:
        storage.problems.insert(0, damage)
    if isinstance(storage, McapFile) and RESULT_RECORD in storage.metadata_names:
        raise ResultGivenError(
            f"{path} is a result of timemap, not a recording",
            hint=f"timemap diff {path} --level long mid",
        )
    if storage.problems and _holds_only_ours(storage):
        raise ResultGivenError(
            f"{path} is a damaged result of timemap, not a recording",
            hint="make it again with `timemap replay`, or copy it again",
        )
    return storage


def _holds_only_ours(storage: Storage) -> bool:
    """Whether all topics are those of a result of ours, the record at whose end is lost."""
    topics = {connection.topic for connection in storage.connections} - {"/tf_static"}
    return bool(topics) and all(topic.startswith("/timemap/") for topic in topics)


def _reader(head: bytes) -> Callable[[Path], Storage] | None:
    return next((reader for magic, reader in READERS.items() if head.startswith(magic)), None)


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(32)


def _refusal(path: Path, head: bytes, damage: str) -> TimemapError:
    """What to say about a file that is no recording we read."""
    if damage:
        return TimemapError(f"{path} cannot be read: {damage.partition(';')[0]}")
    if old := OLD_BAG.match(head):
        version = old.group(1).decode()
        return UsageError(
            f"{path} is a ROS bag of version {version}; only version 2.0 is read",
            hint="convert it with ROS 1: rosbag fix OLD.bag NEW.bag",
        )
    reason = "it is empty" if not head else "it is neither a ROS 1 bag nor a ROS 2 bag nor an MCAP file"
    return UsageError(f"{path} is not a recording: {reason}", hint=READABLE)


def _decompressed(path: Path, stack: ExitStack) -> tuple[Path, str]:
    """The file without its compression, in a temporary folder that ``stack`` removes, and what is wrong with it."""
    folder = stack.enter_context(TemporaryDirectory(prefix="timemap-"))
    target = Path(folder) / path.stem
    most = max(LEAST_BYTES, MOST_TIMES * path.stat().st_size)
    unpacking = zstandard.ZstdDecompressor(max_window_size=MOST_CHUNK_BYTES).decompressobj()
    with path.open("rb") as packed, target.open("wb") as unpacked:
        try:
            # A kilobyte holds up to 32 MB.
            while not unpacking.eof and (block := packed.read(PACKED_BYTES)):
                unpacked.write(unpacking.decompress(block))
                if unpacked.tell() > most:
                    return target, f"it unpacks to more than {most} bytes; what comes before is read"
        except zstandard.ZstdError as error:
            return target, f"its compression is damaged ({error}); what comes before is read"
    return target, "" if unpacking.eof else "it is cut off; what could be unpacked is read"


@dataclass(frozen=True, slots=True)
class _Listed:
    """The files of a recording, and how many messages of each topic its metadata announces."""

    paths: Sequence[Path]
    problems: Sequence[str] = ()
    remarks: Sequence[str] = ()
    counts: Mapping[str, int] = field(default_factory=dict)


def _files_of_folder(folder: Path) -> _Listed:
    """The storage files of a bag folder, those its metadata names or all where it has none."""
    refuse_pipe(folder / METADATA)
    try:
        names = listed_names(folder / METADATA)
    except FileNotFoundError:
        return _Listed(_found_files(folder))
    except ValueError:
        return _Listed(_found_files(folder), remarks=[f"{METADATA} cannot be read; all files beside it are"])
    counts = announced_counts(folder / METADATA)
    paths, problems = [], []
    for name in dict.fromkeys(name for name in names if name and "\0" not in name):
        # Older rosbag2 names a compressed file without the suffix it gave it.
        either = (folder / name, folder / f"{name}.zstd")
        present = [one for one in either if one.is_file() or one.is_dir()]  # opening a pipe would wait
        if present:
            paths.append(present[0])
        else:
            problems.append(f"{name} is missing, although {METADATA} names it")
    if paths:
        return _Listed(paths, problems, counts=counts)
    try:
        found = _found_files(folder)
    except UsageError as error:
        raise UsageError(f"{folder} holds none of the files that its {METADATA} names") from error
    return _Listed(found, remarks=[f"{METADATA} names other files; those beside it are read"], counts=counts)


def _found_files(folder: Path) -> list[Path]:
    """The recording in a folder without metadata: one file, or the numbered parts of one recording."""
    heads = {one: _head(one) for one in sorted(folder.iterdir()) if one.is_file()}
    paths = [one for one, head in heads.items() if head.startswith(ZSTD_MAGIC) or _reader(head)]
    if not paths:
        raise UsageError(f"{folder} holds no recording", hint=READABLE)
    if len({_stem(one) for one in paths}) > 1:
        bags = sorted(one for one in folder.iterdir() if (one / METADATA).is_file())
        raise UsageError(
            f"{folder} holds several recordings; name those you want",
            hint="\n".join(str(one) for one in (*paths, *bags)),
        )
    return paths


def _stem(path: Path) -> tuple[str, Sequence[str]]:
    """What the numbered parts of one recording have in common: name without number, suffixes."""
    name, *suffixes = path.name.split(".")
    return re.sub(r"_\d+$", "", name), tuple(suffixes)
