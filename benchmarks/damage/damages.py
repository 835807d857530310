"""Damages of the kinds that disks, cables, full cards and pulled batteries do, drawn from a seed."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Random = np.random.Generator


@dataclass(frozen=True, slots=True)
class Damage:
    """What was done, in words, and the bytes after it."""

    kind: str
    content: bytes


def damaged(content: bytes, rng: Random) -> Damage:
    """The content (one byte at least) with one damage of a random kind at a random place."""
    kind = str(rng.choice(tuple(_KINDS)))
    return Damage(kind, bytes(_KINDS[kind](bytearray(content), rng)))


def damage_path(path: Path, rng: Random) -> str:
    """Damage the recording at ``path`` in place, one file of it if it is a folder; what was done."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    file = files[int(rng.integers(len(files)))]
    found = damaged(file.read_bytes(), rng)
    file.write_bytes(found.content)
    return f"{found.kind} of {file.name}"


def _place(content: bytearray, rng: Random) -> int:
    return int(rng.integers(len(content)))


def _flip_bit(content: bytearray, rng: Random) -> bytearray:
    content[_place(content, rng)] ^= 1 << int(rng.integers(8))
    return content


def _flip_bytes(content: bytearray, rng: Random) -> bytearray:
    for _ in range(int(rng.integers(2, 20))):
        content[_place(content, rng)] = int(rng.integers(256))
    return content


def _cut_off(content: bytearray, rng: Random) -> bytearray:
    return content[: _place(content, rng)]


def _fill(content: bytearray, rng: Random) -> bytearray:
    """Zeros, ones or noise over a stretch, as a lost sector leaves it."""
    begin, length = _place(content, rng), int(rng.choice([2, 4, 8, 64, 512, 4096]))
    stop = min(len(content), begin + length)
    fills = (bytes(stop - begin), b"\xff" * (stop - begin), rng.bytes(stop - begin))
    content[begin:stop] = fills[int(rng.integers(3))]
    return content


def _leave_out(content: bytearray, rng: Random) -> bytearray:
    begin = _place(content, rng)
    del content[begin : begin + int(rng.choice([1, 4, 100, 2000]))]
    return content


def _put_in(content: bytearray, rng: Random) -> bytearray:
    begin = _place(content, rng)
    content[begin:begin] = rng.bytes(int(rng.choice([1, 4, 100, 2000])))
    return content


def _repeat(content: bytearray, rng: Random) -> bytearray:
    """A stretch stands where another should."""
    source, target = _place(content, rng), _place(content, rng)
    piece = content[source : source + int(rng.choice([8, 64, 512, 4096]))]
    stop = min(len(content), target + len(piece))
    content[target:stop] = piece[: stop - target]
    return content


_KINDS: dict[str, Callable[[bytearray, Random], bytearray]] = {
    "a flipped bit": _flip_bit,
    "random bytes": _flip_bytes,
    "a cut": _cut_off,
    "a filled stretch": _fill,
    "bytes left out": _leave_out,
    "bytes put in": _put_in,
    "a stretch repeated": _repeat,
}
