"""What the value of a setting may be: reading it, refusing it with unit and range, and printing it."""

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from timemap_cli.errors import shown
from timemap_cli.spans import Span, plain

_LONGEST_NAME = 255  # as in ROS 2; a longer one would fill the messages that name it
_SPAN_EXAMPLES = {"obs": "50obs", "s": "0.5s, 10min, 12h"}


class Kind(Protocol):
    """One kind of value. `read` raises ValueError with what is wrong, to stand behind the setting's name."""

    def read(self, value: object) -> Any:
        """The value as the settings hold it, from what YAML or an option gave."""

    def show(self, value: Any) -> str:
        """The value as YAML."""

    @property
    def allowed(self) -> str:
        """Unit and range, for the comment beside the setting; empty where there is nothing to say."""


@dataclass(frozen=True, slots=True)
class Number:
    """A number from low to high, both included, in a unit (empty: a plain count or share)."""

    low: float
    high: float
    unit: str = ""
    whole: bool = False

    def read(self, value: object) -> float:
        """An int for a whole number, a float otherwise; booleans, texts, NaN and infinities are refused."""
        noun = "a whole number" if self.whole else "a number"
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise _wrong(value, f"not {noun} ({self.allowed})")
        if not self.low <= value <= self.high:
            raise _wrong(value, f"outside {self.allowed}")
        if self.whole and value != int(value):
            raise _wrong(value, f"not {noun} ({self.allowed})")
        return int(value) if self.whole else float(value)

    def show(self, value: float) -> str:
        """The value without its unit, which stands in the comment."""
        return repr(value)

    @property
    def allowed(self) -> str:
        """For example `0.5 to 60 m`."""
        return f"{plain(self.low)} to {plain(self.high)} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class SpanOf:
    """A span of one of the given units."""

    low: float
    high: float
    units: Sequence[str]

    def read(self, value: object) -> Span:
        """A Span from a text such as `50obs` or `10min`."""
        try:
            span = Span.parse(str(value))
        except ValueError as error:
            examples = " or ".join(_SPAN_EXAMPLES[unit] for unit in self.units)
            raise _wrong(value, f"not a number with its unit, such as {examples}") from error
        if span.unit not in self.units or not self.low <= span.value <= self.high:
            raise _wrong(value, f"outside {self.allowed}")
        return span

    def show(self, value: Span) -> str:
        """The span with its unit."""
        return str(value)

    @property
    def allowed(self) -> str:
        """For example `0.1 to 1000000 s or obs`."""
        return f"{plain(self.low)} to {plain(self.high)} {' or '.join(self.units)}"


@dataclass(frozen=True, slots=True)
class Seconds:
    """A time with its unit in YAML and as plain seconds in the settings."""

    low: float
    high: float

    def read(self, value: object) -> float:
        """Seconds from a text such as `0.2s`; a bare 0 needs no unit."""
        if value == 0 and not isinstance(value, bool):
            value = "0s"
        return SpanOf(self.low, self.high, ("s",)).read(value).value

    def show(self, value: float) -> str:
        """The time with its unit."""
        return str(Span(value, "s"))

    @property
    def allowed(self) -> str:
        """For example `0 to 86400 s`."""
        return f"{plain(self.low)} to {plain(self.high)} s"


@dataclass(frozen=True, slots=True)
class OneOf:
    """One of a few words."""

    words: Sequence[str]

    def read(self, value: object) -> str:
        """The word itself."""
        if not isinstance(value, str) or value not in self.words:
            raise _wrong(value, f"not one of: {self.allowed}")
        return value

    def show(self, value: str) -> str:
        """The word itself."""
        return value

    @property
    def allowed(self) -> str:
        """The words."""
        return ", ".join(self.words)


@dataclass(frozen=True, slots=True)
class Text:
    """A text in printable characters, of a pattern where one is given."""

    pattern: str = ""

    def read(self, value: object) -> str:
        """The text itself."""
        if not isinstance(value, str) or not value.strip() or not value.isprintable():
            raise _wrong(value, "not a name")
        if len(value) > _LONGEST_NAME:
            raise _wrong(value, f"longer than {_LONGEST_NAME} letters")
        if self.pattern and not re.fullmatch(self.pattern, value):
            raise _wrong(value, f"not a name of the form {self.pattern}")
        return value

    def show(self, value: str) -> str:
        """The text, quoted where YAML could read something else."""
        is_plain = re.fullmatch(r"[/a-zA-Z][\w/]*", value, re.ASCII) and value.lower() not in _RESERVED
        return value if is_plain else json.dumps(value, ensure_ascii=False)

    @property
    def allowed(self) -> str:
        """Nothing to say."""
        return ""


@dataclass(frozen=True, slots=True)
class Frame(Text):
    """The name of a coordinate frame; a leading slash, as old recordings have it, is taken off."""

    def read(self, value: object) -> str:
        """The name without leading slashes."""
        return Text.read(self, value.lstrip("/") if isinstance(value, str) else value)


@dataclass(frozen=True, slots=True)
class Topics:
    """A list of topic names."""

    def read(self, value: object) -> tuple[str, ...]:
        """The names as a tuple, each of them once."""
        if not isinstance(value, list | tuple):
            raise _wrong(value, "not a list of topics")
        return tuple(dict.fromkeys(Text().read(topic) for topic in value))

    def show(self, value: Sequence[str]) -> str:
        """A YAML list in one line."""
        return f"[{', '.join(Text().show(topic) for topic in value)}]"

    @property
    def allowed(self) -> str:
        """Nothing to say."""
        return ""


# Words that some YAML readers take for a boolean, a number or nothing.
_RESERVED = frozenset(("true", "false", "yes", "no", "on", "off", "y", "n", "null", "inf", "nan"))


def _wrong(value: object, what: str) -> ValueError:
    """The refusal of a value, shown short and in one line."""
    if value is None:
        text = "empty"
    elif isinstance(value, bool):
        text = str(value).lower()  # as YAML has it
    else:
        text = shown(f"'{value}'" if isinstance(value, str) else value)
    return ValueError(f"is {text}, {what}")
