"""What comes out of the stream of scans, between the blocks of them and beside them."""

from __future__ import annotations

from dataclasses import dataclass, field

from timemap_cli.model.state import State
from timemap_cli.model.sweeps import Sweeps


@dataclass(frozen=True, slots=True)
class EndOfRecording:
    """Says that the last scan of a recording has come out."""

    recording: int


@dataclass(frozen=True, slots=True)
class Waiting:
    """Says that all recordings have been read, and what of them has not come out yet: `state` is for `sweeps`."""

    state: State


class Resumed:
    """Says that the scans to come are of the recordings, not such as an earlier replay left."""


Coming = Sweeps | EndOfRecording | Waiting | Resumed


@dataclass(slots=True)
class ScanCounts:
    """Every scan read, and why those were dropped that did not come out.

    Reasons: ``malformed`` (a stamp before 1970, or what decoding said), ``outside_time``, ``late`` (more than
    10 s behind the newest), ``ahead`` (of all others of its recording), ``duplicate`` (topic, stamp and
    ranges of another scan), ``same_stamp`` (other ranges), ``no_pose``, and those of ``PoseLimits``.
    """

    read: int = 0
    dropped: dict[str, int] = field(default_factory=dict)
    transforms_dropped: int = 0  # transforms and poses that could not be decoded or used

    def drop(self, reason: str, count: int) -> None:
        """Count scans that were dropped."""
        if count:
            self.dropped[reason] = self.dropped.get(reason, 0) + count
