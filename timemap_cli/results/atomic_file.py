"""A file that is there whole or not at all."""

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.results.partial_file import PartialFile, remove_abandoned


class AtomicFile:
    """A file for writing that takes its name only when it is complete.

    It is written beside its place under a hidden name; `commit` puts it there. Leaving the context without
    `commit`, by an exception or Ctrl-C too, removes it. A symbolic link is followed, as the shell does.
    What a killed program left beside the same path is removed.

    Raises UsageError if the path exists and `force` is not given, if it is a folder, write-protected or nothing
    that `may_replace` allows (`replaced` says what that is), or if its folder is missing; TimemapError where the
    system refuses to write.
    """

    def __init__(
        self,
        path: Path,
        *,
        force: bool = False,
        may_replace: Callable[[Path], bool] | None = None,
        replaced: str = "a result of timemap",
    ) -> None:
        self._named = path
        self._path = Path(os.path.realpath(path))
        self._force = force
        self._may_replace = may_replace
        self._replaced = replaced
        self._refuse_existing()
        folder = self._path.parent
        if not folder.is_dir():
            raise UsageError(f"cannot write {path}: there is no folder {folder}", hint=f"mkdir -p {folder}")
        remove_abandoned(self._path)
        try:
            self._beside = PartialFile(self._path)
        except OSError as error:
            raise self._failure(error) from error
        self._stream = self._beside.stream

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.discard()

    def write(self, data: bytes) -> int:
        """Append bytes; returns their number."""
        try:
            return self._stream.write(data)
        except OSError as error:
            raise self._failure(error) from error

    def tell(self) -> int:
        """Bytes so far."""
        return self._stream.tell()

    def commit(self) -> None:
        """Make sure that the bytes are on the disk, then give the file its name."""
        try:
            self._stream.flush()
            os.fsync(self._stream.fileno())
            self._refuse_existing()
            self._take_place()
            self._stream.close()
            _sync_folder(self._path.parent)
        except OSError as error:
            raise self._failure(error) from error

    def discard(self) -> None:
        """Remove what was written, unless it was committed."""
        with suppress(OSError):  # a full disk refuses the last bytes again; they are not wanted
            self._stream.close()
        self._beside.remove()

    def _take_place(self) -> None:
        """Give the file its name; without `force` only if nothing has that name, whoever writes at the same time."""
        if not self._force:
            try:
                return os.link(self._beside.path, self._path)  # unlike a renaming it never replaces
            except FileExistsError:
                self._refuse_existing()
            except OSError:  # a file system without hard links
                pass
        self._beside.path.replace(self._path)
        return None

    def _refuse_existing(self) -> None:
        if self._path.is_dir():
            raise UsageError(f"cannot write {self._named}: it is a folder", hint="-o FILE writes elsewhere")
        if not os.path.lexists(self._path):
            return
        if self._may_replace is not None and not self._may_replace(self._path):
            raise UsageError(
                f"{self._named} exists and is not {self._replaced}: it is not replaced",
                hint="-o FILE writes somewhere else",
            )
        if not self._force:
            raise UsageError(
                f"{self._named} exists already", hint="--force replaces it, -o FILE writes somewhere else"
            )
        if not self._path.stat().st_mode & 0o222:
            raise UsageError(
                f"{self._named} is write-protected: it is not replaced", hint=f"chmod u+w {self._named}"
            )

    def _failure(self, error: OSError) -> TimemapError:
        return TimemapError(f"cannot write {self._named}: {(error.strerror or str(error)).lower()}")


def _sync_folder(folder: Path) -> None:
    """Have the new name survive a power cut, on systems that can."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    with suppress(OSError):  # some file systems cannot sync a folder; the file itself is safe
        os.fsync(handle)
    os.close(handle)
