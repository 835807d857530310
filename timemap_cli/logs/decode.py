"""From undecoded messages to batches."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar, cast

import numpy as np
import zstandard
from numpy.typing import NDArray

from timemap_cli.logs.batches import BadBatch, Batch, PoseBatch, ScanBatch, TransformBatch
from timemap_cli.logs.block_decoding import UNDECODABLE, decode_block
from timemap_cli.logs.bounds import MOST_MESSAGE_BYTES, decompressed
from timemap_cli.logs.message_types import MESSAGE_TYPES, DecoderCache
from timemap_cli.logs.raw import RawMessages, from_messages
from timemap_cli.logs.single_decoding import decode_singly
from timemap_cli.logs.tracing import traced_groups

ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"

Timed = TypeVar("Timed", ScanBatch, TransformBatch, PoseBatch)


def decode(parts: Iterable[RawMessages], decoders: DecoderCache) -> list[Batch]:
    """Batches of all messages of these connections, which must be of the types in ``MESSAGE_TYPES``.

    Of scans of one topic, frame and layout, of transforms of one pair of frames, and of poses of one topic
    and pair of frames there is one batch, in log-time order. Messages that cannot be decoded are in a
    ``BadBatch``.
    """
    return merged(batch for part in parts for batch in _decode_connection(part, decoders))


def _decode_connection(messages: RawMessages, decoders: DecoderCache) -> list[Batch]:
    connection = messages.connection
    messages, batches = _decompressed(messages)
    standard = decoders.standard_fields(connection)
    if standard is None:
        return batches + decode_singly(messages, decoders.deserialiser(connection))
    is_cdr, repeated = connection.encoding == "cdr", MESSAGE_TYPES[connection.msgtype].repeated
    for group, trace in traced_groups(messages, standard, is_cdr=is_cdr, repeated=repeated):
        if trace is None:
            batches += decode_singly(group, decoders.deserialiser(connection))
        else:
            batches += decode_block(group, trace)
    return batches


def _decompressed(messages: RawMessages) -> tuple[RawMessages, list[Batch]]:
    """Messages without the compression rosbag2 may put on each, and a count of those where it is damaged.

    The first bytes tell: those of a zstd frame are no CDR encapsulation header.
    """
    connection = messages.connection
    if connection.encoding != "cdr" or not _are_packed(messages).any():
        return messages, []
    times, contents = [], []
    for index in range(len(messages)):
        try:
            contents.append(_unpacked(messages.message(index)))
            times.append(int(messages.log_ns[index]))
        except (zstandard.ZstdError, MemoryError):
            continue
    n_bad = len(messages) - len(times)
    bad: list[Batch] = [BadBatch(connection.topic, UNDECODABLE, n_bad)] if n_bad else []
    return from_messages(connection, times, contents), bad


def _are_packed(messages: RawMessages) -> NDArray[np.bool_]:
    """Which of the messages that are long enough (n,) begin like a zstd frame."""
    long_enough = messages[messages.sizes >= len(ZSTD_MAGIC)]
    packed: NDArray[np.bool_] = (
        long_enough.columns(0, len(ZSTD_MAGIC)) == np.frombuffer(ZSTD_MAGIC, np.uint8)
    ).all(axis=1)
    return packed


def _unpacked(message: bytes) -> bytes:
    """A message without its compression, cut where it is longer than any that is read."""
    if not message.startswith(ZSTD_MAGIC):
        return message
    return decompressed("zstd", message, MOST_MESSAGE_BYTES)


def merged(batches: Iterable[Batch]) -> list[Batch]:
    """The same with one batch for each kind, in order of first appearance; inside of each in log-time order."""
    groups: dict[Hashable, list[Batch]] = {}
    for batch in batches:
        groups.setdefault(_identity(batch), []).append(batch)
    whole: list[Batch] = []
    for group in groups.values():
        first = group[0]
        if isinstance(first, BadBatch):
            count = sum(cast(BadBatch, batch).count for batch in group)
            whole.append(replace(first, count=count))
        else:
            whole.append(_concatenated(cast("list[Any]", group)))
    return whole


def _identity(batch: Batch) -> Hashable:
    """What batches must have in common to be one."""
    if isinstance(batch, ScanBatch):
        return ScanBatch, batch.topic, batch.frame_id, batch.layout
    if isinstance(batch, TransformBatch):
        return TransformBatch, batch.static, batch.parent, batch.child
    if isinstance(batch, PoseBatch):
        return PoseBatch, batch.topic, batch.frame_id, batch.child_frame_id, batch.covariance is None
    return BadBatch, batch.topic, batch.reason


def _concatenated(batches: Sequence[Timed]) -> Timed:
    """One batch with the messages of all, in log-time order."""
    first = batches[0]
    log_ns = np.concatenate([batch.log_ns for batch in batches])
    is_sorted = bool((log_ns[1:] >= log_ns[:-1]).all())
    if is_sorted and len(batches) == 1:
        return first
    order = slice(None) if is_sorted else np.argsort(log_ns, kind="stable")
    arrays: dict[str, Any] = {
        field.name: np.concatenate([getattr(batch, field.name) for batch in batches])[order]
        for field in fields(first)
        if isinstance(getattr(first, field.name), np.ndarray)
    }
    return replace(first, **arrays)
