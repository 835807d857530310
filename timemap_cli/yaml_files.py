"""Files that people write: YAML, read as nested mappings, with errors that name the line."""

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from timemap_cli.errors import UsageError, refuse_pipe

SHOWN = "timemap config shows how settings are written"


def read_yaml(path: Path, what: str = "settings", hint: str = SHOWN) -> Mapping[str, Any]:
    """A file of settings, or of something else, as nested mappings; UsageError where it is missing or not YAML."""
    refuse_pipe(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise UsageError(
            f"no {what} file {path}",
            hint=f"timemap config > {shlex.quote(str(path))}" if what == "settings" else hint,
        ) from error
    except (OSError, UnicodeDecodeError) as error:
        reason = (error.strerror or str(error)).lower() if isinstance(error, OSError) else "it is not a text"
        raise UsageError(f"cannot read the {what} file {path}: {reason}", hint=hint) from error
    return parsed_yaml(text, str(path), what, hint)


def parsed_yaml(text: str, place: str, what: str = "settings", hint: str = SHOWN) -> Mapping[str, Any]:
    """The text of such a file as nested mappings; `place` is what errors call it. UsageError where it is not YAML."""
    # YAML is slow to import and most runs have no settings file.
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        values = YAML(typ="safe", pure=True).load(text)
    except RecursionError as error:
        raise UsageError(f"{place} is nested too deeply", hint=hint) from error
    except (YAMLError, ValueError, TypeError, AttributeError, ArithmeticError, LookupError) as error:
        raise UsageError(f"{place} is not YAML: {_yaml_trouble(error)}", hint=hint) from error
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise UsageError(f"{place} holds no {what}", hint=hint)
    return values


def _yaml_trouble(error: Exception) -> str:
    """What is wrong and in which line, without the library's own advice."""
    problem, mark = getattr(error, "problem", None), getattr(error, "problem_mark", None)
    what = " ".join(str(problem or error).replace('in "<unicode string>", ', "at ").split())
    return f"line {mark.line + 1}: {what}" if mark is not None else what
