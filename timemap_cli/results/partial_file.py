"""The hidden file beside an output while it is being written, and what a killed program left of one."""

import fcntl
import os
import re
import secrets
import weakref
from contextlib import suppress
from pathlib import Path


class PartialFile:
    """A new file `.NAME.timemap-XXXXXXXX.part` beside `path`, open for writing.

    It is locked until its stream is closed, so that `remove_abandoned` tells it from what a killed program left.
    `remove` takes its name away; at the latest the end of the program does, wherever an interrupt struck.
    Raises OSError where it cannot be made.
    """

    def __init__(self, path: Path) -> None:
        while True:
            self.path = path.with_name(f".{path.name}.timemap-{secrets.token_hex(4)}.part")
            self.remove = weakref.finalize(self, _remove, self.path, os.getpid())  # before there is anything
            try:
                self.stream = self.path.open("xb", buffering=1 << 20)
            except OSError:
                self.remove.detach()  # whatever stands there is not ours
                raise
            if _lock(self.stream.fileno(), self.path):
                return
            self.stream.close()
            self.remove()


def remove_abandoned(path: Path) -> None:
    """Remove the partial files of this output that nobody is writing: `kill -9` or a power cut left them.

    Files of any other name, of programs that still run, and where the file system knows no locks stay.
    """
    ours = re.compile(rf"\.{re.escape(path.name)}\.timemap-[0-9a-f]{{8}}\.part")
    with suppress(OSError), os.scandir(path.parent) as entries:
        for entry in entries:
            if ours.fullmatch(entry.name) and entry.is_file(follow_symlinks=False):
                _remove_if_abandoned(Path(entry.path))


def _remove_if_abandoned(path: Path) -> None:
    with suppress(OSError):
        handle = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)  # waits for nobody, follows no link
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if _is_still(handle, path):
                path.unlink()
        finally:
            os.close(handle)


def _lock(handle: int, path: Path) -> bool:
    """Lock a file that was just made; False if another program took it for abandoned before that."""
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # no locks on this file system: nobody can take it for abandoned
        return True
    return _is_still(handle, path)


def _is_still(handle: int, path: Path) -> bool:
    """Whether the open file still has this name."""
    try:
        return os.path.samestat(os.fstat(handle), path.lstat())
    except FileNotFoundError:
        return False


def _remove(path: Path, maker: int) -> None:
    if os.getpid() != maker:  # a forked process has a copy of what its parent holds
        return
    with suppress(OSError):  # a folder that is gone or locked; what led here was said already
        path.unlink()
