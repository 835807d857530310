"""Reading of MCAP files, whatever their profile, down to undecoded messages.

Whole chunks are taken apart at once with the message index that stands behind each of them. Files without
an index, and files that were cut off, are scanned from the beginning; what comes before the damage is read.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator
from functools import partial
from pathlib import Path
from typing import IO

import numpy as np
from mcap.records import Channel, Schema

from timemap_cli.logs.bounds import MOST_CHUNK_BYTES
from timemap_cli.logs.chunked import in_log_order, stretches, with_shortfall, within
from timemap_cli.logs.mcap_chunks import DamagedChunkError, chunk_content, from_index, walk, whole_records
from timemap_cli.logs.mcap_contents import McapSpan, from_summary, read_profile
from timemap_cli.logs.mcap_scan import scan
from timemap_cli.logs.raw import Connection, RawMessages, ros2_name
from timemap_cli.logs.shared_handles import HANDLES

DEFINITION_FORMATS = {"ros2msg": "msg", "ros1msg": "msg", "ros2idl": "idl", "omgidl": "idl"}


class McapFile:
    """An MCAP file that is open for reading (a ``Storage``)."""

    def __init__(self, path: Path) -> None:
        """Open it and read its summary; without one, scan it.

        Raises OSError, and McapError or ValueError where the file is not an MCAP at all.
        """
        self._file: IO[bytes] = HANDLES.open(path)
        try:
            profile = read_profile(self._file)
            contents = from_summary(self._file) or scan(self._file)
        except BaseException:
            self._file.close()
            raise
        self.format = {"ros2": "ROS 2 mcap", "ros1": "MCAP (ros1)"}.get(profile or "", "MCAP")
        self.metadata_names = contents.metadata_names
        self.start_ns, self.end_ns = contents.start_ns, contents.end_ns
        self.remarks: list[str] = list(contents.remarks)
        self.problems: list[str] = list(contents.problems)
        self.connections = tuple(
            _connection(channel, contents.schemas.get(channel.schema_id), contents.counts.get(key, 0))
            for key, channel in sorted(contents.channels.items())
        )
        self._spans = contents.spans

    def close(self) -> None:
        """Release the file."""
        self._file.close()

    def stretches(
        self, connections: Collection[int], start_ns: int | None, end_ns: int | None
    ) -> Iterator[list[RawMessages]]:
        """Messages of the connections with these ids, see ``Storage``."""
        wanted = {item.id: item for item in self.connections if item.id in connections}
        spans = [
            span
            for span in self._spans
            if (start_ns is None or span.end_ns >= start_ns)
            and (end_ns is None or span.start_ns < end_ns)
            and (span.channels is None or not span.channels.isdisjoint(wanted))
        ]
        found = stretches(spans, partial(self._load, wanted=wanted, start_ns=start_ns, end_ns=end_ns))
        is_whole = start_ns is None and end_ns is None
        return with_shortfall(found, wanted.values(), self.problems) if is_whole else found

    def _load(
        self, span: McapSpan, wanted: dict[int, Connection], start_ns: int | None, end_ns: int | None
    ) -> list[RawMessages]:
        """Messages of one chunk; none, and an entry in ``problems``, where it is damaged."""
        try:
            content, index = self._content(span)
            data = np.frombuffer(content, np.uint8)
            entries = from_index(data, index) or walk(content)
        except (DamagedChunkError, struct.error) as error:
            self.problems.append(f"the chunk at byte {span.offset} is damaged and left out: {error}")
            return []
        parts = [
            in_log_order(RawMessages(wanted[key], log_ns, data, starts, sizes))
            for key, (log_ns, starts, sizes) in entries.items()
            if key in wanted
        ]
        return [chosen for part in parts if len(chosen := within(part, start_ns, end_ns))]

    def _content(self, span: McapSpan) -> tuple[bytes, bytes]:
        """Uncompressed records of a chunk or run, and the message index behind it."""
        if span.length + span.index_length > MOST_CHUNK_BYTES:
            raise DamagedChunkError(
                f"it is {span.length} bytes long, more than {MOST_CHUNK_BYTES} are not read"
            )
        self._file.seek(span.offset)
        raw = self._file.read(span.length + span.index_length)
        if span.is_run:
            return raw, b""
        if span.is_cut:
            return whole_records(raw), b""
        return chunk_content(raw[: span.length]), raw[span.length :]


def _connection(channel: Channel, schema: Schema | None, count: int) -> Connection:
    definition_format = DEFINITION_FORMATS.get(schema.encoding, "") if schema else ""
    return Connection(
        id=channel.id,
        topic=channel.topic,
        msgtype=ros2_name(schema.name) if schema else "",
        encoding=channel.message_encoding,
        definition=schema.data.decode("utf-8", "replace") if schema and definition_format else "",
        definition_format=definition_format,
        count=count,
    )
