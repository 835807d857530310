"""Values of a file that people edit, each of the type that is asked for."""

import math
from collections.abc import Mapping

from timemap_cli.errors import shown


class Fields:
    """A mapping of a file; every method raises ValueError, with the place, where a value is missing or another type.

    The file as a whole has the place "".
    """

    def __init__(self, values: object, place: str) -> None:
        if not isinstance(values, Mapping):
            raise ValueError(f"{place or 'the file'} is no mapping of names to values")
        self._values = values
        self._place = place

    def part(self, key: str | int) -> "Fields":
        """A mapping in this one."""
        return Fields(self._value(key), self._at(key))

    def parts(self) -> "dict[str, Fields]":
        """Every value as a mapping, by its key, which is a text."""
        return {name: self.part(name) for name in self._names()}

    def rows(self, key: str) -> "list[Fields]":
        """A list of mappings."""
        values = self._value(key)
        if not isinstance(values, list):
            raise ValueError(f"{self._at(key)} is no list")
        return [Fields(value, f"{self._at(key)}[{i}]") for i, value in enumerate(values)]

    def numbered(self) -> "dict[int, Fields]":
        """Every value as a mapping, by its key, which is a whole number."""
        for key in self._values:
            if isinstance(key, bool) or not isinstance(key, int):
                raise ValueError(f"{self._at(key)} is not a whole number")
        return {key: self.part(key) for key in self._values}

    def text(self, key: str) -> str:
        """A text."""
        value = self._value(key)
        if not isinstance(value, str):
            raise ValueError(f"{self._at(key)} is not a text: {shown(value)}")
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts."""
        values = self._value(key)
        if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
            raise ValueError(f"{self._at(key)} is no list of texts")
        return tuple(values)

    def number(self, key: str) -> float:
        """A finite number."""
        value = self._value(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"{self._at(key)} is not a number: {shown(value)}")
        if not -1e12 < value < 1e12:  # False for NaN
            raise ValueError(f"{self._at(key)} is out of all range")
        return float(value)

    def whole(self, key: str, least: int = 0, most: int = 10**12) -> int:
        """A whole number in a range, both ends included."""
        value = self.number(key)
        if not least <= value <= most or value != math.floor(value):
            raise ValueError(f"{self._at(key)} is not a whole number from {least} to {most}: {value:g}")
        return int(value)

    def numbers(self) -> dict[str, float]:
        """Every value as a finite number, by its key, which is a text."""
        return {name: self.number(name) for name in self._names()}

    def wholes(self) -> dict[str, int]:
        """Every value as a count, by its key, which is a text."""
        return {name: self.whole(name) for name in self._names()}

    def flag(self, key: str) -> bool | None:
        """True or false; None where it is missing."""
        value = self._values.get(key)
        if not isinstance(value, bool | None):
            raise ValueError(f"{self._at(key)} is neither true nor false")
        return value

    def plain(self) -> dict[str, object]:
        """The values as they are, by their keys, which are texts."""
        return {name: self._values[name] for name in self._names()}

    def has(self, key: str) -> bool:
        """Whether there is something else than null."""
        return self._value(key) is not None

    def _at(self, key: object) -> str:
        return f"{self._place}.{shown(key)}" if self._place else shown(key)

    def _names(self) -> list[str]:
        for key in self._values:
            if not isinstance(key, str):
                raise ValueError(f"{self._at(key)} is not a name")
        return list(self._values)

    def _value(self, key: str | int) -> object:
        if key not in self._values:
            raise ValueError(f"{self._at(key)} is missing")
        return self._values[key]
