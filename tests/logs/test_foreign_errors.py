"""What libraries raise about damaged files becomes one error that names the file."""

import struct
from pathlib import Path

import pytest
import zstandard

from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.foreign_errors import translated

PATH = Path("run.bag")


@pytest.mark.parametrize(
    "error",
    [
        AssertionError(),
        KeyError("op"),
        IndexError("index out of range"),
        OverflowError("Python int too large"),
        RecursionError("maximum recursion depth exceeded"),
        TypeError("'NoneType' object is not subscriptable"),
        struct.error("unpack requires a buffer of 4 bytes"),
        EOFError(),
    ],
)
def test_what_no_user_understands_is_said_in_plain_words(error):
    with pytest.raises(TimemapError) as caught, translated(PATH):
        raise error
    assert caught.value.message == (
        "run.bag cannot be read: its parts do not fit together; it is cut off or damaged"
    )
    assert caught.value.__cause__ is error


@pytest.mark.parametrize("error", [ValueError("its head is damaged"), OSError("its head is damaged")])
def test_words_about_the_file_are_kept(error):
    with pytest.raises(TimemapError, match=r"run\.bag cannot be read: its head is damaged"), translated(PATH):
        raise error


def test_errors_of_the_decompressors_are_translated():
    with pytest.raises(TimemapError), translated(PATH):
        zstandard.decompress(b"nothing of the kind")


def test_our_own_errors_pass():
    with pytest.raises(UsageError, match="as it is"), translated(PATH):
        raise UsageError("as it is")
