"""What was compared with what."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ComparedSide:
    """One side of a comparison."""

    result: str  # name of the result file
    level: str
    stamp_ns: int  # each node's newest estimate not later than this
