"""Rows of a damaged SQLite database, picked from its pages one by one.

Every page that holds rows says so itself, so none of the tree above it is needed. The layout is that of
https://www.sqlite.org/fileformat2.html, sections 1.5, 1.6 and 2.1.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import IO

from timemap_cli.logs.bounds import MOST_CHUNK_BYTES

TABLE_LEAF = 0x0D
FILE_HEAD_BYTES = 100  # in front of what the first page holds
INTEGER_BYTES = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}  # by serial type
MOST_COLUMNS = 16

Value = int | bytes | None


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a table, as far as its page holds it: whole, or with the beginning of its last column."""

    page: int
    place: int  # of its cell in the page
    rowid: int
    kinds: tuple[int, ...]  # serial type of each column
    values: tuple[Value, ...]  # numbers, and the bytes of texts and blobs; cut where the page ends
    missing: int  # bytes on other pages
    overflow: int  # the first of those pages; 0 where none is needed


class Pages:
    """The pages of a database file."""

    def __init__(self, file: IO[bytes]) -> None:
        """Read the file's head; ValueError where it tells no size of pages."""
        self._file = file
        file.seek(0)
        head = file.read(FILE_HEAD_BYTES)
        size = int.from_bytes(head[16:18], "big")
        self._size = 65536 if size == 1 else size
        if len(head) < FILE_HEAD_BYTES or self._size < 512 or self._size & (self._size - 1):
            raise ValueError("its head is damaged")
        self._usable = self._size - head[20]
        self._count = file.seek(0, 2) // self._size

    def rows(self) -> Iterator[Row]:
        """All rows of all tables in whole pages, in order of the pages; what cannot be a row is passed over."""
        for number in range(1, self._count + 1):
            page = self._page(number)
            at = FILE_HEAD_BYTES if number == 1 else 0
            if page[at] != TABLE_LEAF:
                continue
            count = min(int.from_bytes(page[at + 3 : at + 5], "big"), (len(page) - at - 8) // 2)
            for place in struct.unpack_from(f">{count}H", page, at + 8):
                try:
                    yield _row(page, number, place, self._usable)
                except (IndexError, ValueError):
                    continue

    def last_column(self, number: int, place: int) -> bytes | None:
        """The last column of the row at this place, its bytes on other pages included; None where those are missing."""
        row = _row(self._page(number), number, place, self._usable)
        last = row.values[-1]
        if not isinstance(last, bytes) or row.missing > MOST_CHUNK_BYTES:
            return None
        parts, missing, number = [last], row.missing, row.overflow
        while missing:
            if not 1 <= number <= self._count:
                return None
            page = self._page(number)
            part = page[4 : min(self._usable, 4 + missing)]
            parts.append(part)
            missing -= len(part)
            number = int.from_bytes(page[:4], "big")
        return b"".join(parts)

    def _page(self, number: int) -> bytes:
        self._file.seek((number - 1) * self._size)
        return self._file.read(self._size)


def _row(page: bytes, number: int, place: int, usable: int) -> Row:
    """The row at this place of a page; IndexError or ValueError where there is none."""
    length, at = _varint(page, place)
    rowid, at = _varint(page, at)
    local = _local(length, usable)
    payload = page[at : at + local]
    overflow = int.from_bytes(page[at + local : at + local + 4], "big") if local < length else 0
    kinds, at = _kinds(payload)
    widths = [_width(kind) for kind in kinds]
    if at + sum(widths) != length or at + sum(widths[:-1]) > len(payload) or rowid >= 1 << 63:
        raise ValueError("no row")
    values = []
    for kind, width in zip(kinds, widths, strict=True):
        values.append(_value(kind, payload[at : at + width]))
        at += width
    return Row(number, place, rowid, kinds, tuple(values), length - local, overflow)


def _local(length: int, usable: int) -> int:
    """How many bytes of a row of this length are on its own page."""
    most = usable - 35
    if length <= most:
        return length
    least = (usable - 12) * 32 // 255 - 23
    wanted = least + (length - least) % (usable - 4)
    return wanted if wanted <= most else least


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """An unsigned number of up to 64 bits, and where it ends; IndexError behind the data."""
    value = 0
    for index in range(8):
        byte = data[at + index]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, at + index + 1
    return value << 8 | data[at + 8], at + 9


def _kinds(payload: bytes) -> tuple[tuple[int, ...], int]:
    """Serial types of the columns, and where the first value begins."""
    stop, at = _varint(payload, 0)
    kinds: list[int] = []
    while at < stop and len(kinds) <= MOST_COLUMNS:
        kind, at = _varint(payload, at)
        kinds.append(kind)
    if at != stop or not kinds:
        raise ValueError("no row")
    return tuple(kinds), at


def _width(kind: int) -> int:
    """Bytes of a value."""
    if kind >= 12:
        return (kind - 12) // 2
    return 8 if kind == 7 else INTEGER_BYTES.get(kind, 0)


def _value(kind: int, raw: bytes) -> Value:
    if kind >= 12:
        return raw
    if kind in INTEGER_BYTES:
        return int.from_bytes(raw, "big", signed=True)
    return {8: 0, 9: 1}.get(kind)
