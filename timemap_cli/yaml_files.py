"""Files that people write: YAML, read as nested mappings, with errors that name the line."""

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from timemap_cli.errors import UsageError, refuse_pipe
from timemap_cli.plain_yaml import SMALL, YamlError, plain_values, too_large

SHOWN = "timemap config shows how settings are written"


def read_yaml(path: Path, what: str = "settings", hint: str = SHOWN) -> Mapping[str, Any]:
    """A file of settings, or of something else, as nested mappings; UsageError where it is missing or not YAML."""
    refuse_pipe(path)
    try:
        with path.open("rb") as file:
            content = file.read(SMALL.octets + 1)
        text = content.decode("utf-8") if len(content) <= SMALL.octets else None
    except FileNotFoundError as error:
        raise UsageError(
            f"no {what} file {path}",
            hint=f"timemap config > {shlex.quote(str(path))}" if what == "settings" else hint,
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        reason = (error.strerror or str(error)).lower() if isinstance(error, OSError) else "it is not a text"
        raise UsageError(f"cannot read the {what} file {path}: {reason}", hint=hint) from error
    if text is None:
        raise UsageError(f"{path} {too_large(SMALL)}: it holds no {what}", hint=hint)
    return parsed_yaml(text, str(path), what, hint)


def parsed_yaml(text: str, place: str, what: str = "settings", hint: str = SHOWN) -> Mapping[str, Any]:
    """The text of such a file as nested mappings; `place` is what errors call it. UsageError where it is not YAML."""
    try:
        values = plain_values(text)
    except YamlError as error:
        raise UsageError(f"{place} {error}", hint=hint) from error
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise UsageError(f"{place} holds no {what}", hint=hint)
    return values
