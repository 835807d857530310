"""Which numbers of a profile do not hold, because the settings file or an option says otherwise."""

import dataclasses
from typing import Any

from timemap_cli.config import Settings, load


def overridden(settings: Settings) -> list[str]:
    """What the profile sets and something later has changed: `map.radius 10.0 instead of 1.5`."""
    held, plain = _values_by_path(settings), _values_by_path(Settings())
    own = _values_by_path(load(None, {"profile": settings.profile}))
    return [
        f"{path} {held[path]} instead of {value}"
        for path, value in own.items()
        if value not in (plain[path], held[path])
    ]


def _values_by_path(settings: Any, path: str = "") -> dict[str, str]:
    """Whole name -> value as YAML has it, of all settings but the levels."""
    values: dict[str, str] = {}
    for field in dataclasses.fields(settings):
        name, value = f"{path}{field.metadata.get('key') or field.name}", getattr(settings, field.name)
        if "kind" in field.metadata:
            values[name] = field.metadata["kind"].show(value)
        elif dataclasses.is_dataclass(value):
            values |= _values_by_path(value, f"{name}.")
    return values
