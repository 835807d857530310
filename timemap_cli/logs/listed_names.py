"""The files that a ROS 2 bag's `metadata.yaml` names, read from the YAML's events alone.

A recording may come from anybody. Nothing is made of what the YAML says (no merged mappings, which grow tenfold a
line; no dates, no numbers, no tags), nothing is followed deeper than metadata goes, and reading ends with the list.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    MappingStartEvent,
    ScalarEvent,
)

_LIST = ["rosbag2_bagfile_information", "relative_file_paths", None]
_MOST_CHARACTERS = 4_000_000  # ten thousand parts and a thousand topics need half of it
_DEEPEST = 20


def listed_names(metadata: Path) -> list[str]:
    """Names of the files, without any folder: they lie beside it.

    Raises FileNotFoundError, and ValueError where it is no metadata of a bag.
    """
    with metadata.open(encoding="utf-8") as file:
        text = file.read(_MOST_CHARACTERS)
    try:
        return [PurePath(path).name for path in _paths(YAML(typ="safe", pure=True).parse(text))]
    except YAMLError as error:
        raise ValueError(f"{metadata} is no YAML") from error


@dataclass(slots=True)
class _Open:
    """A mapping or sequence that has begun and not ended."""

    is_mapping: bool
    key: str | None = None  # of the value that comes next, in a mapping

    def take(self, text: str) -> None:
        """Take note of a key, or of the end of the value that it stands before."""
        if self.is_mapping:
            self.key = text if self.key is None else None


def _paths(events: Iterable[Any]) -> list[str]:
    opened: list[_Open] = []
    found: list[str] = []
    for event in events:
        if isinstance(event, CollectionStartEvent):
            if len(opened) == _DEEPEST:
                break
            opened.append(_Open(isinstance(event, MappingStartEvent)))
            continue
        is_in_list = [one.key for one in opened] == _LIST and not opened[-1].is_mapping
        if isinstance(event, CollectionEndEvent):
            if is_in_list:
                return found
            opened.pop()
        if isinstance(event, ScalarEvent) and is_in_list:
            found.append(event.value)
        if isinstance(event, ScalarEvent | AliasEvent | CollectionEndEvent) and opened:
            opened[-1].take(event.value if isinstance(event, ScalarEvent) else "")
    raise ValueError("it names no files")
