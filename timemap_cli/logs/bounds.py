"""How much of a recording is ever taken into memory at once, and decompression that keeps to it.

A recording may come from anybody, and damage makes lengths of anything: no memory is taken because a file says so.
"""

from __future__ import annotations

import bz2

import lz4.frame  # type: ignore[import-untyped]
import zstandard

MOST_CHUNK_BYTES = (
    256 << 20
)  # of a chunk, or of a record outside of chunks; writers end a chunk after a few MB
MOST_MESSAGE_BYTES = 64 << 20  # of a message that is compressed by itself: ten million beams


class TooLargeError(Exception):
    """What is asked for is longer than anything that is read."""


def decompressed(compression: str, packed: bytes, size: int) -> bytes:
    """What ``packed`` holds by ``compression`` ("bz2", "lz4", "zstd"), whole or not, ``size + 1`` bytes at most.

    Raises TooLargeError where ``size`` is beyond what is read, and what the decompressors raise.
    """
    if size > MOST_CHUNK_BYTES:
        raise TooLargeError(f"it says it holds {size} bytes, more than {MOST_CHUNK_BYTES} are not read")
    if compression == "bz2":
        return bz2.BZ2Decompressor().decompress(packed, max_length=size + 1)
    if compression == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size + 1))
    with zstandard.ZstdDecompressor(max_window_size=MOST_CHUNK_BYTES).stream_reader(packed) as reader:
        return reader.read(size + 1)
