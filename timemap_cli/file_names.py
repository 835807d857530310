"""Names of files in texts: a name may hold any bytes, a text is UTF-8 and JSON of whole characters."""

import json
import re
from collections.abc import Mapping
from typing import Any

# What Python makes of a byte that is no UTF-8, and of halves of a character that JSON may hold alone.
_HALVES = re.compile("[\ud800-\udfff]")
_FIRST_BYTE, _LAST_BYTE = 0xDC80, 0xDCFF


def shown(text: str) -> str:
    """Text that can be written as UTF-8: a byte of a file's name that is none stands in it as `\\xff`."""
    return _HALVES.sub(_in_letters, text)


def json_text(document: Any, *, indent: int | None = None) -> str:
    """A document as JSON without NaN or Infinity, its texts as they are shown: others refuse half characters."""
    return json.dumps(_all_shown(document), indent=indent, allow_nan=False)


def _in_letters(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\x{code - 0xDC00:02x}" if _FIRST_BYTE <= code <= _LAST_BYTE else f"\\u{code:04x}"


def _all_shown(value: Any) -> Any:
    if isinstance(value, str):
        return shown(value)
    if isinstance(value, Mapping):
        return {_all_shown(key): _all_shown(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_all_shown(one) for one in value]
    return value
