"""How many messages of each topic a ROS 2 bag's `metadata.yaml` announces, read from the YAML's events alone."""

from __future__ import annotations

from pathlib import Path

from timemap_cli.logs.listed_names import INFORMATION, Open
from timemap_cli.plain_yaml import Kind, events

_TOPIC = [INFORMATION, "topics_with_message_count", None]
_MOST_CHARACTERS = 1_000_000  # hundreds of topics; of more the first are enough


def announced_counts(metadata: Path) -> dict[str, int]:
    """Messages by topic, as far as the metadata can be understood."""
    found: dict[str, int] = {}
    try:
        with metadata.open(encoding="utf-8") as file:
            _collect(file.read(_MOST_CHARACTERS), found)
    except ValueError:  # no YAML, nested too deeply, or no text
        pass
    return found


def _collect(text: str, found: dict[str, int]) -> None:
    """Put the topics of a YAML text into ``found``, one after the other."""
    opened: list[Open] = []
    name, count = "", ""
    for event in events(text):
        if event.kind is Kind.DOCUMENT:
            continue
        if event.kind in (Kind.MAPPING, Kind.SEQUENCE):
            opened.append(Open(event.kind is Kind.MAPPING))
            continue
        keys = [one.key for one in opened]
        if event.kind is Kind.END:
            if keys[:-1] == _TOPIC:
                if name and count.isdecimal() and len(count) < 16:
                    found[name] = int(count)
                name = count = ""
            opened.pop()
        elif event.kind is Kind.SCALAR and keys == [*_TOPIC, "topic_metadata", "name"]:
            name = event.text
        elif event.kind is Kind.SCALAR and keys == [*_TOPIC, "message_count"]:
            count = event.text
        if opened:
            opened[-1].take(event.text)
