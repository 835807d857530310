"""The files that a ROS 2 bag's `metadata.yaml` names, read from the YAML's events alone.

A recording may come from anybody. Nothing is made of what the YAML says (no merged mappings, which grow tenfold a
line; no dates, no numbers, no tags), nothing is followed deeper than metadata goes, and reading ends with the list.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePath

from timemap_cli.plain_yaml import Event, Kind, events

INFORMATION = "rosbag2_bagfile_information"
_LIST = [INFORMATION, "relative_file_paths", None]
_MOST_CHARACTERS = 4_000_000  # ten thousand parts and a thousand topics need half of it


def listed_names(metadata: Path) -> list[str]:
    """Names of the files, without any folder: they lie beside it.

    Raises FileNotFoundError, and ValueError where it is no metadata of a bag.
    """
    with metadata.open(encoding="utf-8") as file:
        text = file.read(_MOST_CHARACTERS)
    return [PurePath(path).name for path in _paths(events(text))]


@dataclass(slots=True)
class Open:
    """A mapping or sequence that has begun and not ended."""

    is_mapping: bool
    key: str | None = None  # of the value that comes next, in a mapping

    def take(self, text: str) -> None:
        """Take note of a key, or of the end of the value that it stands before."""
        if self.is_mapping:
            self.key = text if self.key is None else None


def _paths(steps: Iterable[Event]) -> list[str]:
    opened: list[Open] = []
    found: list[str] = []
    for event in steps:
        if event.kind is Kind.DOCUMENT:
            continue
        if event.kind in (Kind.MAPPING, Kind.SEQUENCE):
            opened.append(Open(event.kind is Kind.MAPPING))
            continue
        is_in_list = [one.key for one in opened] == _LIST and not opened[-1].is_mapping
        if event.kind is Kind.END:
            if is_in_list:
                return found
            opened.pop()
        if event.kind is Kind.SCALAR and is_in_list:
            found.append(event.text)
        if opened:
            opened[-1].take(event.text)
    raise ValueError("it names no files")
