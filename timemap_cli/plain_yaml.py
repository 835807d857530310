"""The one reader of YAML: texts, numbers, booleans, lists and mappings, and nothing that grows when it is read.

A settings file, a suite, a baseline or a result may come from anybody. Aliases and merge keys make gigabytes of a few
lines and tags make objects, so none of them is read; depth and size are bounded. Scalars are those of YAML 1.2.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from timemap_cli.errors import shown

DEEPEST = 20  # what we write is four deep


class Kind(Enum):
    """What an event of a YAML text is."""

    MAPPING = "mapping"  # one begins
    SEQUENCE = "sequence"  # one begins
    END = "end"  # of the mapping or sequence that began last
    SCALAR = "scalar"
    ALIAS = "alias"
    DOCUMENT = "document"  # one begins


@dataclass(frozen=True, slots=True)
class Event:
    """One step through a YAML text."""

    kind: Kind
    line: int  # from 1 on
    text: str = ""  # of a scalar
    is_plain: bool = False  # a scalar without quotes
    is_tagged: bool = False


@dataclass(frozen=True, slots=True)
class Bounds:
    """How large a text may be: reading takes a second for some ten thousand events, however short they are."""

    octets: int
    events: int


SMALL = Bounds(200_000, 10_000)  # settings, and a suite of eight hundred checks


class YamlError(ValueError):
    """Why a text is not read, to stand behind what is read: `is nested too deeply`."""


def plain_values(text: str, bounds: Bounds = SMALL) -> Any:
    """What a text of one document holds; None where it holds nothing. YamlError where it is not read."""
    if len(text) > bounds.octets:
        raise too_large(bounds)
    builder = _Builder()
    for number, event in enumerate(events(text)):
        if number > bounds.events:
            raise YamlError(f"holds more than {bounds.events} values, keys and brackets")
        builder.take(event)
    return builder.value


def too_large(bounds: Bounds) -> YamlError:
    """The trouble with a text that is longer than it may be."""
    return YamlError(f"is larger than {bounds.octets // 1000} kB")


def events(text: str) -> Iterator[Event]:
    """The events of a text, in order. YamlError where it is no YAML, or nested deeper than DEEPEST."""
    # YAML is slow to import and most runs have no settings file.
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    depth = 0
    try:
        for raw in YAML(typ="safe", pure=True).parse(text):
            event = _event(raw)
            if event is None:
                continue
            depth += {Kind.MAPPING: 1, Kind.SEQUENCE: 1, Kind.END: -1}.get(event.kind, 0)
            if depth > DEEPEST:
                raise YamlError("is nested too deeply")
            yield event
    except YamlError:
        raise
    except (YAMLError, ValueError, TypeError, AttributeError, ArithmeticError, LookupError) as error:
        raise YamlError(f"is not YAML: {_trouble(error)}") from error


def _event(raw: Any) -> Event | None:
    from ruamel.yaml import events as raws

    line = raw.start_mark.line + 1
    kinds = (
        (raws.MappingStartEvent, Kind.MAPPING),
        (raws.SequenceStartEvent, Kind.SEQUENCE),
        (raws.CollectionEndEvent, Kind.END),
        (raws.AliasEvent, Kind.ALIAS),
        (raws.DocumentStartEvent, Kind.DOCUMENT),
    )
    if isinstance(raw, raws.ScalarEvent):
        return Event(Kind.SCALAR, line, raw.value, raw.style is None, raw.tag is not None)
    for of, kind in kinds:
        if isinstance(raw, of):
            return Event(kind, line, is_tagged=getattr(raw, "tag", None) is not None)
    return None


@dataclass(slots=True)
class _Open:
    """A mapping or list that has begun and not ended."""

    values: dict[Any, Any] | list[Any]
    key: Any = None
    has_key: bool = False

    def put(self, value: Any, event: Event) -> None:
        """Put a key, or the value behind it, or the next of a list."""
        if isinstance(self.values, list):
            self.values.append(value)
        elif self.has_key:
            self.values[self.key], self.has_key = value, False
        elif isinstance(value, dict | list):
            raise YamlError(f"is not YAML that is read: line {event.line}: a key is a list or a mapping")
        elif event.is_plain and value == "<<":
            raise YamlError(f"holds a merge key in line {event.line}: write out what it stands for")
        elif value in self.values:
            raise YamlError(f"is not YAML: line {event.line}: the key {shown(event.text)} stands there twice")
        else:
            self.key, self.has_key = value, True


@dataclass(slots=True)
class _Builder:
    """Makes values of events."""

    value: Any = None
    opened: list[_Open] = field(default_factory=list)
    documents: int = 0

    def take(self, event: Event) -> None:
        """Take the next event."""
        if event.is_tagged:
            raise YamlError(f"is not YAML that is read: line {event.line}: it has a tag (!)")
        if event.kind is Kind.ALIAS:
            raise YamlError(f"holds an alias (*) in line {event.line}: write out what it stands for")
        if event.kind is Kind.DOCUMENT:
            self.documents += 1
            if self.documents > 1:
                raise YamlError(f"is not YAML that is read: line {event.line}: a second document begins")
        elif event.kind is Kind.END:
            self._put(self.opened.pop().values, event)
        elif event.kind is Kind.SCALAR:
            self._put(_scalar(event), event)
        else:
            self.opened.append(_Open({} if event.kind is Kind.MAPPING else []))

    def _put(self, value: Any, event: Event) -> None:
        if self.opened:
            self.opened[-1].put(value, event)
        else:
            self.value = value


_WORDS = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
_WHOLE = re.compile(r"[-+]?[0-9][0-9_]*")
_OTHER_BASE = re.compile(r"0x[0-9a-fA-F]+|0o[0-7]+")
_DECIMAL = re.compile(r"[-+]?(\.[0-9]+|[0-9][0-9_]*(\.[0-9_]*)?)([eE][-+]?[0-9]+)?")
_BOUNDLESS = re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
_MOST_DIGITS = 1000  # Python refuses to print a number of more than 4300


def _scalar(event: Event) -> str | int | float | bool | None:
    """A text, or what YAML 1.2 (core schema) takes a plain one for; digits may be parted by _ as in YAML 1.1."""
    text = event.text
    if not event.is_plain:
        return text
    if text in _WORDS:
        return _WORDS[text]
    if not text[0].isdecimal() and text[0] not in "+-.":
        return text
    is_whole, is_other = _WHOLE.fullmatch(text), _OTHER_BASE.fullmatch(text)
    if (is_whole or is_other) and len(text) > _MOST_DIGITS:
        raise YamlError(f"holds a number of {len(text)} digits in line {event.line}")
    if is_other:
        return int(text, 0)
    if is_whole:
        return int(text.replace("_", ""))
    if _DECIMAL.fullmatch(text):
        return float(text.replace("_", ""))
    return float(text.replace(".", "")) if _BOUNDLESS.fullmatch(text) else text


def _trouble(error: Exception) -> str:
    """What is wrong and in which line, without the library's own advice."""
    problem, mark = getattr(error, "problem", None), getattr(error, "problem_mark", None)
    what = " ".join(str(problem or error)[:1000].replace('in "<unicode string>", ', "at ").split())[:200]
    return f"line {mark.line + 1}: {what}" if mark is not None else what
