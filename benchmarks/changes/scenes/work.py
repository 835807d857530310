"""What every scene is told: where recordings belong, and how thorough it is to be."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Work:
    """How a scene is to be measured."""

    folder: Path  # of all recordings and results
    quick: bool = False  # fewer days or layouts
    again: bool = False  # replay anew what has been replayed before
    pallet_days: int = 10  # of each pallet hall
    data: Path | None = None  # where real recordings are
