"""Bytes of one CDR message (XCDR1, little endian), written field by field.

For messages that come seldom; those written by the thousand have a fixed layout (`layouts.py`).
"""

import struct
from typing import Any

ENCAPSULATION = b"\x00\x01\x00\x00"  # plain CDR, little endian


class CdrBuilder:
    """Appends fields, each aligned to its own size counted from the end of the encapsulation header."""

    def __init__(self) -> None:
        self._buffer = bytearray(ENCAPSULATION)

    def __len__(self) -> int:
        """Bytes so far, the encapsulation header included."""
        return len(self._buffer)

    def align(self, size: int) -> None:
        """Pad with zeros to a multiple of `size`."""
        self._buffer += bytes((len(ENCAPSULATION) - len(self._buffer)) % size)

    def pack(self, code: str, *values: float) -> None:
        """Append numbers of one `struct` type."""
        self.align(struct.calcsize("<" + code))
        self._buffer += struct.pack(f"<{len(values)}{code}", *values)

    def string(self, text: str) -> None:
        """Append a string: its length with the closing zero, then the UTF-8 bytes and the zero."""
        raw = text.encode() + b"\x00"
        self.pack("I", len(raw))
        self._buffer += raw

    def octets(self, data: bytes) -> None:
        """Append a sequence of single bytes: their number, then themselves."""
        self.pack("I", len(data))
        self._buffer += data

    def time(self, stamp_ns: int) -> None:
        """Append a `builtin_interfaces/Time`."""
        sec, nanosec = divmod(stamp_ns, 1_000_000_000)
        self.pack("i", sec)
        self.pack("I", nanosec)

    def header(self, stamp_ns: int, frame_id: str) -> None:
        """Append a `std_msgs/Header`."""
        self.time(stamp_ns)
        self.string(frame_id)

    def message(self) -> bytes:
        """The whole message, encapsulation header included."""
        return bytes(self._buffer)


class CdrParser:
    """Takes fields off one message in order; struct.error or ValueError where it is too short."""

    def __init__(self, message: bytes) -> None:
        self._message = message
        self._place = len(ENCAPSULATION)

    def unpack(self, code: str, count: int = 1) -> tuple[Any, ...]:
        """The next numbers of one `struct` type."""
        size = struct.calcsize("<" + code)
        self._place += (len(ENCAPSULATION) - self._place) % size
        values = struct.unpack_from(f"<{count}{code}", self._message, self._place)
        self._place += size * count
        return values

    def string(self) -> str:
        """The next string."""
        (size,) = self.unpack("I")
        raw = self._message[self._place : self._place + size]
        self._place += size
        return raw[:-1].decode()

    def octets(self) -> bytes:
        """The next sequence of single bytes."""
        (size,) = self.unpack("I")
        raw = self._message[self._place : self._place + size]
        if len(raw) < size:
            raise ValueError("a message ends within a sequence")
        self._place += size
        return raw

    def header(self) -> tuple[int, str]:
        """Stamp [ns] and frame of the next `std_msgs/Header`."""
        (sec,), (nanosec,) = self.unpack("i"), self.unpack("I")
        return sec * 1_000_000_000 + nanosec, self.string()
