"""Scans waiting until all that may precede them has come: stamp order within a window of header time."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.batches import Float32s, Float64s, Int64s, ScanBatch
from timemap_cli.model.state import State

WINDOW_NS = 10_000_000_000
# A sweep longer than this is a driver's mistake (seconds for milliseconds), not a scanner.
MAX_SWEEP_NS = 2_000_000_000
# So far apart one recorder logs a message that comes to it in two ways; damage shows one in the place of another.
COPIED_NS = 1_000_000_000
BEGINNING_NS = -(2**62)  # before all stamps

Entries = NDArray[np.void]
_ENTRY = np.dtype(
    [
        ("stamp", np.int64),
        ("log", np.int64),
        ("sweep", np.int64),  # [ns] from first to last beam
        ("recording", np.int64),
        ("topic", np.int64),  # rank among the chosen topics
        ("frame", np.int64),  # code of the scan's frame
        ("kind", np.int64),  # code of what scans of one block have in common
        ("chunk", np.int64),  # where the ranges are
        ("row", np.int64),
    ]
)


@dataclass(frozen=True, slots=True)
class Arrived:
    """What became of the scans that arrived; those not counted as anything but read are waiting."""

    read: int = 0
    malformed: int = 0  # with a stamp before 1970, which no result can hold
    late: int = 0
    outside: int = 0  # of the time span


@dataclass(frozen=True, slots=True)
class Kind:
    """What the scans of one block have in common."""

    scanner: int  # rank of its topic among the chosen ones
    angle_min: float  # [rad]
    angle_increment: float  # [rad]
    count: int
    clear_range: float  # [m]

    def bearings(self) -> Float64s:
        """Bearings (count,) [rad] of the beams in the scan's frame."""
        return _bearings(self.angle_min, self.angle_increment, self.count)


def sweep_durations(batch: ScanBatch) -> Int64s:
    """Time (n,) [ns] from the first to the last beam of each scan, 0 where the recording's number is none."""
    seconds = batch.time_increment.astype(np.float64) * max(batch.layout.count - 1, 0)
    believable = np.abs(seconds) <= MAX_SWEEP_NS / 1e9
    return np.rint(np.where(believable, seconds, 0.0) * 1e9).astype(np.int64)


class ScanWindow:
    """Scans on their way from log order to stamp order.

    The window's clock is the newest stamp of the scans that have arrived. Whatever is more than 10 s behind
    the clock when it arrives is late; whatever falls more than 10 s behind is ready. How often scans are
    taken out makes no difference to their order, nor to which are late. Scans outside ``span_ns`` (end
    exclusive) move the clock but do not come out. Nothing arrives any more once the clock is 10 s past the
    span's end: by log order, wherever reading pauses.
    """

    def __init__(self, span_ns: tuple[int, int]) -> None:
        self._span_ns = span_ns
        self.clock_ns = BEGINNING_NS
        self.nbytes = 0  # of the ranges held
        self._floor_ns = BEGINNING_NS
        self._coming = np.empty(0, _ENTRY)
        self._waiting = np.empty(0, _ENTRY)
        self._chunks: dict[int, tuple[Float32s, int]] = {}  # ranges, code of their kind
        self._chunk_count = 0
        self._kinds: dict[int, Kind] = {}
        self._kind_codes: dict[Kind, int] = {}

    def add(self, batch: ScanBatch, ranges: Float32s, kind: Kind, *, recording: int, frame: int) -> None:
        """Take in scans with their resolved ranges (n, beams); they arrive once ``arrive`` gets so far."""
        entries = np.empty(len(ranges), _ENTRY)
        entries["stamp"], entries["log"] = batch.stamps_ns, batch.log_ns
        entries["sweep"] = sweep_durations(batch)
        entries["recording"], entries["frame"] = recording, frame
        self._hold(entries, ranges, kind)
        self._coming = np.concatenate([self._coming, entries])

    def arrive(self, until_ns: int) -> Arrived:
        """Let in the scans recorded up to a log time, in log order.

        None arrives after the one that moves the clock past all that may come out.
        """
        here = self._coming["log"] <= until_ns
        arriving, self._coming = self._coming[here], self._coming[~here]
        arriving = _ordered(arriving, "log")
        malformed = arriving["stamp"] < 0
        clock = np.maximum.accumulate(
            np.append(self.clock_ns, np.where(malformed, BEGINNING_NS, arriving["stamp"]))
        )
        count = int(np.searchsorted(clock[:-1], self._span_ns[1] + WINDOW_NS))
        if not count:
            return Arrived()
        arriving, malformed, clock = arriving[:count], malformed[:count], clock[: count + 1]
        self.clock_ns = int(clock[-1])
        stamps = arriving["stamp"]
        outside = ((stamps < self._span_ns[0]) | (stamps >= self._span_ns[1])) & ~malformed
        late = ((stamps < clock[:-1] - WINDOW_NS) | (stamps <= self._floor_ns)) & ~outside & ~malformed
        self._waiting = np.concatenate([self._waiting, arriving[~(late | outside | malformed)]])
        return Arrived(count, *(int(np.count_nonzero(found)) for found in (malformed, late, outside)))

    @property
    def ready_before_ns(self) -> int:
        """Scans with a smaller stamp are ready."""
        return self.clock_ns - WINDOW_NS

    @property
    def oldest_ns(self) -> int:
        """No scan that comes out later has a smaller stamp, by what has arrived so far."""
        waiting = int(self._waiting["stamp"].min(initial=self.clock_ns))
        return min(waiting, self.ready_before_ns)

    def count_ready(self) -> int:
        """How many scans could be taken out."""
        return int(np.count_nonzero(self._waiting["stamp"] < self.ready_before_ns))

    def take_ready(self) -> Entries:
        """Take out the scans that are ready, in stamp order."""
        ready = self._waiting["stamp"] < self.ready_before_ns
        taken, self._waiting = self._waiting[ready], self._waiting[~ready]
        return _ordered(taken, "stamp")

    def take_all(self) -> Entries:
        """Take out all scans that have arrived, in stamp order; none that comes later may precede them."""
        taken = _ordered(self._waiting, "stamp")
        self._waiting = np.empty(0, _ENTRY)
        if len(taken):
            self._floor_ns = max(self._floor_ns, int(taken["stamp"][-1]))
        return taken

    def gather(self, entries: Entries) -> Float32s:
        """Ranges (n, beams) of scans of one kind, as ``add`` got them."""
        step = (np.diff(entries["chunk"]) != 0) | (np.diff(entries["row"]) != 1)
        starts = [0, *(np.flatnonzero(step) + 1).tolist(), len(entries)]
        chunks, rows = entries["chunk"].tolist(), entries["row"].tolist()
        pieces = [
            self._chunks[chunks[begin]][0][rows[begin] : rows[begin] + end - begin]
            for begin, end in pairwise(starts)
        ]
        return pieces[0] if len(pieces) == 1 else np.concatenate(pieces)

    def are_copies(self, entries: Entries, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Whether these scans (rows,), which have the stamp of the one before each, are that scan recorded twice.

        The ranges are the same then, and it was at once, or in another recording.
        """
        copies = np.zeros(len(rows), np.bool_)
        for i, row in enumerate(rows.tolist()):
            one, other = entries[row - 1 : row], entries[row : row + 1]
            at_once = abs(int(one["log"][0]) - int(other["log"][0])) <= COPIED_NS
            if one["kind"] == other["kind"] and (at_once or one["recording"] != other["recording"]):
                copies[i] = np.array_equal(self.gather(one), self.gather(other), equal_nan=True)
        return copies

    def kept(self) -> State:
        """What is coming and waiting, for `restore`."""
        entries = np.concatenate([self._coming, self._waiting])
        order = np.lexsort([entries["row"], entries["chunk"]])
        coming = np.arange(len(entries)) < len(self._coming)
        entries, coming = entries[order], coming[order]
        runs = self.cut(entries, len(entries), 2**62)
        state: State = {name: entries[name] for name in ("stamp", "log", "sweep", "frame")}
        return state | {
            "clock_ns": min(self.clock_ns, self._span_ns[1]),  # what lies behind the span is read once more
            "floor_ns": self._floor_ns,
            "coming": coming,
            "kinds": [dataclasses.astuple(kind) for kind, _ in runs],
            "starts": [run.start for _, run in runs],
            **{f"ranges{i}": self.gather(entries[run]) for i, (_, run) in enumerate(runs)},
        }

    def restore(self, state: State) -> int:
        """Take over what another window kept; this one must be empty. Returns how many scans wait."""
        self.clock_ns, self._floor_ns = state["clock_ns"], state["floor_ns"]
        entries = np.empty(len(state["stamp"]), _ENTRY)
        for name in ("stamp", "log", "sweep", "frame"):
            entries[name] = state[name]
        entries["recording"] = -1  # before those that are read now
        stops = [*state["starts"], len(entries)][1:]
        for i, (values, start, stop) in enumerate(zip(state["kinds"], state["starts"], stops, strict=True)):
            kind, ranges, run = Kind(*values), state[f"ranges{i}"], slice(start, stop)
            if ranges.shape != (stop - start, kind.count):
                raise ValueError("ranges that are not of these scans")
            self._hold(entries[run], ranges, kind)
        self._coming, self._waiting = entries[state["coming"]], entries[~state["coming"]]
        return len(self._waiting)

    def _hold(self, entries: Entries, ranges: Float32s, kind: Kind) -> None:
        """Hold the ranges (n, beams) of these scans (n,), and note in them where they are."""
        code = self._kind_codes.setdefault(kind, self._chunk_count)
        self._kinds[code] = kind
        entries["topic"], entries["kind"] = kind.scanner, code
        entries["chunk"], entries["row"] = self._chunk_count, np.arange(len(ranges))
        self._chunks[self._chunk_count] = ranges, code
        self._chunk_count += 1
        self.nbytes += ranges.nbytes

    def release(self) -> None:
        """Let go of the ranges of scans that are neither coming nor waiting; ``gather`` them first."""
        needed = {*self._coming["chunk"].tolist(), *self._waiting["chunk"].tolist()}
        for chunk in [chunk for chunk in self._chunks if chunk not in needed]:
            self.nbytes -= self._chunks.pop(chunk)[0].nbytes
        used = {code for _, code in self._chunks.values()}
        self._kinds = {code: kind for code, kind in self._kinds.items() if code in used}
        self._kind_codes = {kind: code for code, kind in self._kinds.items()}

    def cut(self, entries: Entries, most_scans: int, most_bytes: int) -> list[tuple[Kind, slice]]:
        """Cut into runs of one kind, none longer than so many scans or bytes of ranges (but one scan)."""
        borders = [0, *(np.flatnonzero(np.diff(entries["kind"])) + 1).tolist(), len(entries)]
        found = []
        for begin, end in pairwise(borders if len(entries) else ()):
            kind = self._kinds[int(entries["kind"][begin])]
            most = max(1, min(most_scans, most_bytes // (4 * kind.count)))
            found += [(kind, slice(at, min(at + most, end))) for at in range(begin, end, most)]
        return found


def repeats(entries: Entries) -> NDArray[np.bool_]:
    """Which scans (n,), in stamp order, have the same topic and stamp as the one before."""
    same = (np.diff(entries["stamp"]) == 0) & (np.diff(entries["topic"]) == 0)
    return np.append(False, same) if len(entries) else np.empty(0, bool)


@lru_cache(maxsize=16)
def _bearings(angle_min: float, angle_increment: float, count: int) -> Float64s:
    bearings: Float64s = angle_min + np.arange(count, dtype=np.float64) * angle_increment
    bearings.flags.writeable = False
    return bearings


def _ordered(entries: Entries, by: str) -> Entries:
    """Sort by time; what is equal, by topic, recording and the order in which it was read."""
    keys: list[Any] = [entries[name] for name in ("row", "chunk", "recording", "topic", by)]
    return entries[np.lexsort(keys)]
