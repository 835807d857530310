"""Where the fields of a serialised message lie: found on one message, valid for all that look like it.

Serialised ROS messages have no fixed layout: strings and sequences push what follows. But most messages of
a topic have the same strings and the same lengths, and so the same layout.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.message_types import Fields
from timemap_cli.logs.raw import RawMessages

LITTLE_ENDIAN_CDR = b"\x00\x01"  # first bytes of the encapsulation header
CDR_ORIGIN = 4  # alignment counts from behind the encapsulation header
WIDTHS = {"int32": 4, "uint32": 4, "float32": 4, "float64": 8}
JOINED_GAP = 128  # fixed parts of a message that are closer than this are compared together [bytes]
MOST_TRACES = 64  # of one length of message, before the rest is decoded one by one

_uint32 = struct.Struct("<I").unpack_from


@dataclass(frozen=True, slots=True)
class Element:
    """The fields of a message, or of one element of the sequence it consists of.

    ``offsets`` are in bytes from the beginning of the message, of a sequence's first value; ``lengths``
    numbers of values, of sequences only.
    """

    offsets: dict[str, int] = field(default_factory=dict)
    lengths: dict[str, int] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Trace:
    """The layout of a message, and the parts ``fixed`` (start, stop) that decide on it: lengths and strings."""

    elements: tuple[Element, ...]
    fixed: tuple[tuple[int, int], ...]


class _Walk:
    """A walk through the bytes of one message."""

    def __init__(self, raw: bytes, is_cdr: bool) -> None:
        self.raw = raw
        self.is_cdr = is_cdr
        self.position = CDR_ORIGIN if is_cdr else 0
        self.fixed = [(0, len(LITTLE_ENDIAN_CDR))] if is_cdr else []

    def align(self, width: int) -> None:
        if self.is_cdr:
            self.position += (CDR_ORIGIN - self.position) % width

    def length(self) -> int:
        """The number in front of a string or a sequence."""
        self.align(4)
        (value,) = _uint32(self.raw, self.position)
        self.fixed.append((self.position, self.position + 4))
        self.position += 4
        return int(value)

    def text(self) -> str:
        length = self.length()
        start, self.position = self.position, self.position + length
        self.fixed.append((start, self.position))
        ends_with_nul = self.is_cdr and length
        return self.raw[start : self.position - 1 if ends_with_nul else self.position].decode()

    def element(self, fields: Fields) -> Element:
        element = Element()
        for path, name in fields:
            base, _, size = name.partition("[")
            if base == "string":
                element.texts[path] = self.text()
                continue
            count = 1
            if size == "]":
                count = element.lengths[path] = self.length()
            elif size:
                count = int(size[:-1])
            self.align(WIDTHS[base])
            element.offsets[path] = self.position
            self.position += count * WIDTHS[base]
        return element


def trace(raw: bytes, fields: Fields, *, is_cdr: bool, repeated: bool) -> Trace | None:
    """Layout of the message; None where it is not what the fields ask for, or not in little-endian plain CDR."""
    if is_cdr and raw[: len(LITTLE_ENDIAN_CDR)] != LITTLE_ENDIAN_CDR:
        return None
    walk = _Walk(raw, is_cdr)
    try:
        count = walk.length() if repeated else 1
        elements = tuple(walk.element(fields) for _ in range(count))
    except (struct.error, UnicodeDecodeError):
        return None
    surplus = len(raw) - walk.position
    # Behind CDR a middleware may leave what it needs: its buffer is often longer than the message.
    if surplus < 0 or (surplus and not is_cdr):
        return None
    return Trace(elements, tuple(walk.fixed))


def traced_groups(
    messages: RawMessages, fields: Fields, *, is_cdr: bool, repeated: bool
) -> Iterator[tuple[RawMessages, Trace | None]]:
    """Groups of messages of the same layout, with it; None for messages whose layout is not understood."""
    for size in np.unique(messages.sizes):
        group = messages[messages.sizes == size]
        for _ in range(MOST_TRACES):
            if not len(group):
                break
            raw = group.message(0)
            found = trace(raw, fields, is_cdr=is_cdr, repeated=repeated)
            alike = np.arange(len(group)) == 0 if found is None else _alike(group, raw, found)
            yield group[alike], found
            group = group[~alike]
        if len(group):
            yield group, None


def _alike(messages: RawMessages, raw: bytes, found: Trace) -> NDArray[np.bool_]:
    """Which of the messages (n,), all as long as ``raw``, have the same bytes in its fixed parts."""
    model = np.frombuffer(raw, np.uint8)
    alike = np.ones(len(messages), bool)
    for block in _blocks(found.fixed):
        start, stop = block[0][0], block[-1][1]
        is_fixed = np.zeros(stop - start, np.uint8)
        for first, last in block:
            is_fixed[first - start : last - start] = 0xFF
        difference = (messages.columns(start, stop - start) ^ model[start:stop]) & is_fixed
        alike &= ~difference.any(axis=1)
    return alike


def _blocks(parts: tuple[tuple[int, int], ...]) -> list[list[tuple[int, int]]]:
    """Successive parts in groups without a gap of JOINED_GAP bytes between neighbours."""
    blocks: list[list[tuple[int, int]]] = []
    for part in parts:
        if blocks and part[0] - blocks[-1][-1][1] < JOINED_GAP:
            blocks[-1].append(part)
        else:
            blocks.append([part])
    return blocks
