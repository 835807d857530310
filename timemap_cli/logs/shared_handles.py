"""Files that share a few handles of the system: a recording may have more parts than a process may have open.

The usual limit is 1024 open files (`ulimit -n`), 256 on some systems; a robot that begins a new file every minute
passes it within a day.
"""

from __future__ import annotations

import errno
import io
import os
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

MOST_HANDLES = 64  # more than recordings are read side by side, and few enough for the least limit


class SharedHandles:
    """The newest used of some files are open; another one is opened when it is read, and the oldest makes room."""

    def __init__(self, most: int = MOST_HANDLES) -> None:
        self._most = most
        self._open: OrderedDict[_File, io.FileIO] = OrderedDict()

    def __len__(self) -> int:
        """How many are open."""
        return len(self._open)

    def open(self, path: Path) -> io.BufferedReader:
        """A file for reading; OSError where it cannot be opened, and at any read later where it was replaced."""
        file = _File(path, self)
        self.handle(file)
        return io.BufferedReader(file)

    def handle(self, file: _File) -> io.FileIO:
        """The open handle of a file, which is the newest used then."""
        handle = self._open.get(file)
        if handle is None:
            while len(self._open) >= self._most:
                self._open.popitem(last=False)[1].close()
            handle = self._open[file] = file.opened()
        self._open.move_to_end(file)
        return handle

    def close(self, file: _File) -> None:
        """Give the handle of a file back, if it has one."""
        handle = self._open.pop(file, None)
        if handle is not None:
            handle.close()


class _File(io.RawIOBase):
    """A file that knows its place, and takes a handle whenever it is read."""

    def __init__(self, path: Path, handles: SharedHandles) -> None:
        self._path = path.absolute()
        self._handles = handles
        self._seen: os.stat_result | None = None  # when it was opened first
        self._place = 0

    def opened(self) -> io.FileIO:
        """A new handle; OSError where another file has taken the name since the first one."""
        handle = io.FileIO(self._path)
        stat = os.fstat(handle.fileno())
        if self._seen is not None and not _is_same(self._seen, stat):
            handle.close()
            raise OSError(
                errno.ESTALE, "another file took its place while it was being read", str(self._path)
            )
        self._seen = self._seen or stat
        return handle

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def tell(self) -> int:
        return self._place

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        if whence == io.SEEK_CUR:
            offset, whence = self._place + offset, io.SEEK_SET
        self._place = self._handles.handle(self).seek(offset, whence)
        return self._place

    def readinto(self, buffer: WriteableBuffer) -> int | None:
        handle = self._handles.handle(self)
        handle.seek(self._place)
        count = handle.readinto(buffer)
        self._place += count or 0
        return count

    def close(self) -> None:
        self._handles.close(self)
        super().close()


def _is_same(one: os.stat_result, other: os.stat_result) -> bool:
    """Whether two looks at a name found one file; some network file systems number their files anew."""
    return os.path.samestat(one, other) or (one.st_size, one.st_mtime_ns) == (
        other.st_size,
        other.st_mtime_ns,
    )


HANDLES = SharedHandles()
