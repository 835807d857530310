"""Chunks are handed on in order of log time, however they overlap."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.logs import chunked
from timemap_cli.logs.chunked import ChunkSpan, in_log_order, stretches, within
from timemap_cli.logs.raw import Connection, RawMessages, from_messages

CONNECTIONS = [Connection(key, f"/{key}", "std_msgs/msg/String", "cdr", "", "", 0) for key in (0, 1)]


def messages(key: int, times) -> RawMessages:
    """Messages that hold their own connection and time."""
    return in_log_order(
        from_messages(CONNECTIONS[key], list(times), [b"%d %d" % (key, one) for one in times])
    )


def unpacked(lists):
    return [[part.message(index).decode() for part in parts for index in range(len(part))] for parts in lists]


chunks_of_times = st.lists(st.lists(st.tuples(st.integers(0, 1), st.integers(0, 40)), min_size=1), max_size=6)


@given(chunks_of_times, st.sampled_from([1, 20, 10_000]), st.sampled_from([15, 10_000]))
def test_every_message_comes_once_and_later_lists_are_not_earlier(chunks, joined, largest):
    contents = [
        [messages(key, [time for other, time in chunk if other == key]) for key in (0, 1)] for chunk in chunks
    ]
    spans = [
        ChunkSpan(index, min(time for _, time in chunk), max(time for _, time in chunk))
        for index, chunk in enumerate(chunks)
    ]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chunked, "STRETCH_BYTES", joined)
        patch.setattr(chunked, "LARGEST_STRETCH_BYTES", largest)
        lists = list(stretches(spans, lambda span: [part for part in contents[span.offset] if len(part)]))
    written = sorted(f"{key} {time}" for chunk in chunks for key, time in chunk)
    assert sorted(text for texts in unpacked(lists) for text in texts) == written
    times = [[int(text.split()[1]) for text in texts] for texts in unpacked(lists)]
    for earlier, later in pairwise(times):
        assert max(earlier) <= min(later)
    for parts in lists:
        assert len({part.connection.id for part in parts}) == len(parts)
        for part in parts:
            assert (np.diff(part.log_ns) >= 0).all()
            assert part.log_ns.tolist() == [int(part.message(index).split()[1]) for index in range(len(part))]


def test_small_chunks_are_joined():
    contents = [messages(0, [time]) for time in range(100)]
    spans = [ChunkSpan(time, time, time) for time in range(100)]
    assert len(list(stretches(spans, lambda span: [contents[span.offset]]))) == 1


def test_window_is_closed_at_its_start_and_open_at_its_end():
    part = messages(0, [1, 2, 2, 3, 4])
    assert within(part, 2, 4).log_ns.tolist() == [2, 2, 3]
    assert within(part, None, 2).log_ns.tolist() == [1]
    assert within(part, 5, None).log_ns.tolist() == []
    assert within(part, 4, 2).log_ns.tolist() == []


def test_messages_of_one_time_keep_their_order():
    part = from_messages(CONNECTIONS[0], [2, 1, 2, 1], [b"a", b"b", b"c", b"d"])
    assert [in_log_order(part).message(index) for index in range(4)] == [b"b", b"d", b"a", b"c"]


def test_chunks_that_all_overlap_are_not_held_together_beyond_a_bound(monkeypatch):
    held = []
    split = chunked.split_at
    monkeypatch.setattr(chunked, "split_at", lambda parts, now: held.append(len(parts)) or split(parts, now))
    monkeypatch.setattr(chunked, "MOST_HELD_BYTES", 40)
    spans = [ChunkSpan(number, number, 1000) for number in range(50)]
    lists = list(stretches(spans, lambda span: [messages(0, [span.offset, 1000])]))
    assert sorted(text for texts in unpacked(lists) for text in texts) == sorted(
        [f"0 {number}" for number in range(50)] + ["0 1000"] * 50
    )
    assert max(held) < 12
