"""A stretch of observations or of time: `50obs`, `0.2s`, `10min`, `12h`, `2d`."""

import math
import re
from dataclasses import dataclass
from typing import Literal, Self

SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
_PATTERN = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?|\.[0-9]+)\s*(obs|s|min|h|d)\s*")


@dataclass(frozen=True, slots=True)
class Span:
    """So many scans of a node that passed the gate (`obs`), or so many seconds (`s`)."""

    value: float
    unit: Literal["obs", "s"]

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read `50obs`, `34.7obs`, `30s`, `10min`, `12h`, `2d`; ValueError for anything else."""
        match = _PATTERN.fullmatch(text)
        if match is None or math.isinf(float(match[1])):
            raise ValueError(f"'{text}' is not a number with one of the units obs, s, min, h, d")
        number, unit = match.groups()
        if unit == "obs":
            return cls(float(number), "obs")
        return cls(float(number) * SECONDS[unit], "s")

    def __str__(self) -> str:
        if self.unit == "obs":
            return f"{plain(self.value)}obs"
        for unit in ("h", "min"):
            whole, rest = divmod(self.value, SECONDS[unit])
            if whole and not rest:
                return f"{plain(whole)}{unit}"
        return f"{plain(self.value)}s"


def plain(value: float) -> str:
    """The shortest decimal number that reads back to the same float, without a trailing `.0`."""
    return repr(value).removesuffix(".0")
