"""Pauses between scans that no robot makes: a clock was wrong, and and days in between come too late."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from timemap_cli.times import format_time

_DAY_NS = 86_400_000_000_000
LONGEST_NS = 180 * _DAY_NS  # buildings close for a season, hardly for half a year


@dataclass(frozen=True, slots=True)
class Pause:
    """From one scan to the next."""

    begin_ns: int
    end_ns: int

    def told(self, resumed: Path | None) -> str:
        """A warning, with the way back: the result that was gone on from, if any."""
        days = round((self.end_ns - self.begin_ns) / _DAY_NS)
        way = (
            "leave out the recording whose clock was wrong"
            if resumed is None
            else f"keep {resumed}, and go on from it (--resume {resumed}) without the recording whose clock was wrong"
        )
        return (
            f"after a scan of {format_time(self.begin_ns)} the next is of {format_time(self.end_ns)}, {days} days later"
            f": no robot rests so long, and days in between cannot be added to this result; {way}"
        )


def longest(before_ns: int | None, stamps_ns: npt.NDArray[np.int64]) -> Pause | None:
    """The longest pause that no robot makes, after the scan before and between those of now (n,), if there is any."""
    stamps = stamps_ns if before_ns is None else np.append(before_ns, stamps_ns)
    steps = np.diff(stamps)
    if not (steps > LONGEST_NS).any():
        return None
    widest = int(steps.argmax())
    return Pause(int(stamps[widest]), int(stamps[widest + 1]))
