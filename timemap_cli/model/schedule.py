"""When the nodes that changed are estimated."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.state import State


@dataclass(frozen=True, slots=True)
class Period:
    """So many scans replayed, or so many nanoseconds on their stamps."""

    length: int
    in_scans: bool


class Schedule:
    """Cuts the stream of scans where estimates are due."""

    def __init__(self, period: Period) -> None:
        self._period = period
        self._scans = 0
        self._due_ns: int | None = None

    def kept(self) -> State:
        """Where the schedule stands, for `restore`."""
        return {"scans": self._scans, "due_ns": self._due_ns}

    def restore(self, state: State) -> None:
        """Go on where another schedule stopped."""
        self._scans, self._due_ns = state["scans"], state["due_ns"]

    def parts(self, stamps_ns: npt.NDArray[np.int64]) -> Iterator[tuple[slice, bool]]:
        """Consecutive parts of a block with ascending stamps (n,), and whether estimates are due after each.

        Where stamps begin anew, before those of an earlier block, so do the periods.

        Time is cut before the first scan at or after a whole number of periods since the first scan of all, so that the
        estimates show what was known before it. A part may be empty.
        """
        return self._by_count(len(stamps_ns)) if self._period.in_scans else self._by_time(stamps_ns)

    def _by_count(self, scans: int) -> Iterator[tuple[slice, bool]]:
        start = 0
        while start < scans:
            stop = min(scans, start + self._period.length - self._scans % self._period.length)
            self._scans += stop - start
            yield slice(start, stop), self._scans % self._period.length == 0
            start = stop

    def _by_time(self, stamps_ns: npt.NDArray[np.int64]) -> Iterator[tuple[slice, bool]]:
        start = 0
        while start < len(stamps_ns):
            now = int(stamps_ns[start])
            if self._due_ns is None or now < self._due_ns - self._period.length:
                self._due_ns = now + self._period.length
            elif now >= self._due_ns:
                yield slice(start, start), True
                self._due_ns += ((now - self._due_ns) // self._period.length + 1) * self._period.length
            stop = start + int(np.searchsorted(stamps_ns[start:], self._due_ns))
            yield slice(start, stop), False
            start = stop
