"""What the libraries that read files raise, turned into one error that names the file and the reason."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import apsw
import zstandard
from mcap.exceptions import McapError
from rosbags.rosbag2 import ReaderError
from rosbags.typesys import TypesysError

from timemap_cli.errors import TimemapError
from timemap_cli.logs.bag_records import DamagedBagError
from timemap_cli.logs.mcap_chunks import DamagedChunkError

# Of rosbags, mcap, apsw, the decompressors, and of Python where bytes are not what they should be: whole families,
# since damage finds its way to all of them.
FOREIGN_ERRORS = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    DamagedBagError,
    DamagedChunkError,
    EOFError,
    LookupError,
    McapError,
    MemoryError,
    OSError,
    ReaderError,
    RuntimeError,
    TypeError,
    TypesysError,
    ValueError,
    apsw.Error,
    struct.error,
    zstandard.ZstdError,
)


IN_WORDS = (DamagedBagError, DamagedChunkError, McapError, OSError, ReaderError, TypesysError, ValueError)


@contextmanager
def translated(path: Path) -> Iterator[None]:
    """Errors of the libraries that read files become a TimemapError that names the file and the reason."""
    try:
        yield
    except TimemapError:
        raise
    except FOREIGN_ERRORS as error:
        raise TimemapError(f"{path} cannot be read: {reason(error, path)}") from error


def reason(error: Exception, path: Path) -> str:
    """What went wrong, in words for who does not know the library; the file, where it is one of a folder."""
    if isinstance(error, TimemapError):
        return error.message
    if isinstance(error, OSError) and error.strerror:
        within = error.filename if error.filename and Path(error.filename) != path else None
        return f"{within}: {error.strerror.lower()}" if within else error.strerror.lower()
    if not isinstance(error, IN_WORDS) or not str(error):
        return "its parts do not fit together; it is cut off or damaged"
    return str(error)
