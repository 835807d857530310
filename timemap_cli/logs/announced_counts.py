"""How many messages of each topic a ROS 2 bag's `metadata.yaml` announces, read from the YAML's events alone."""

from __future__ import annotations

from pathlib import Path

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    MappingStartEvent,
    ScalarEvent,
)

from timemap_cli.logs.listed_names import INFORMATION, Open

_TOPIC = [INFORMATION, "topics_with_message_count", None]
_MOST_CHARACTERS = 1_000_000  # hundreds of topics; of more the first are enough
_DEEPEST = 20


def announced_counts(metadata: Path) -> dict[str, int]:
    """Messages by topic, as far as the metadata can be understood."""
    found: dict[str, int] = {}
    try:
        with metadata.open(encoding="utf-8") as file:
            _collect(file.read(_MOST_CHARACTERS), found)
    except (YAMLError, UnicodeDecodeError):
        pass
    return found


def _collect(text: str, found: dict[str, int]) -> None:
    """Put the topics of a YAML text into ``found``, one after the other."""
    opened: list[Open] = []
    name, count = "", ""
    for event in YAML(typ="safe", pure=True).parse(text):
        if isinstance(event, CollectionStartEvent):
            if len(opened) == _DEEPEST:
                return
            opened.append(Open(isinstance(event, MappingStartEvent)))
            continue
        keys = [one.key for one in opened]
        if isinstance(event, CollectionEndEvent):
            if keys[:-1] == _TOPIC:
                if name and count.isdecimal() and len(count) < 16:
                    found[name] = int(count)
                name = count = ""
            opened.pop()
        elif isinstance(event, ScalarEvent) and keys == [*_TOPIC, "topic_metadata", "name"]:
            name = event.value
        elif isinstance(event, ScalarEvent) and keys == [*_TOPIC, "message_count"]:
            count = event.value
        if isinstance(event, ScalarEvent | AliasEvent | CollectionEndEvent) and opened:
            opened[-1].take(event.value if isinstance(event, ScalarEvent) else "")
