"""Which settings are others than they were, or than their profile has them."""

import dataclasses
from typing import Any

from timemap_cli.config import Settings, load


def overridden(settings: Settings) -> list[str]:
    """What the profile sets and something later has changed: `map.radius 10.0 instead of 1.5`."""
    plain = _values_by_path(Settings())
    own = _values_by_path(load(None, {"profile": settings.profile}))
    changed = differing(settings, load(None, {"profile": settings.profile}))
    return [text for path, text in changed.items() if path in plain and own[path] != plain[path]]


def differing(settings: Settings, others: Settings) -> dict[str, str]:
    """By whole name, what has another value: `{"levels.long.window": "levels.long.window 50 instead of 100"}`."""
    held, other = _values_by_path(settings), _values_by_path(others)
    return {
        path: f"{path} {held.get(path, 'none')} instead of {other.get(path, 'none')}"
        for path in {**other, **held}
        if held.get(path) != other.get(path)
    }


def _values_by_path(settings: Any, path: str = "") -> dict[str, str]:
    """Whole name -> value as YAML has it, of all settings; a level is called by its name and has its place."""
    values: dict[str, str] = {}
    for field in dataclasses.fields(settings):
        name, value = f"{path}{field.metadata.get('key') or field.name}", getattr(settings, field.name)
        if "kind" in field.metadata:
            values[name] = field.metadata["kind"].show(value)
        elif dataclasses.is_dataclass(value):
            values |= _values_by_path(value, f"{name}.")
        else:
            values["levels"] = ", ".join(level.name for level in value)
            for level in value:
                values |= _values_by_path(level, f"levels.{level.name}.")
    return values
