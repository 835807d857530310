"""What the JSON documents in a result must look like: a result may come from anybody, and hold any text there."""

import json
import math
import re
from collections.abc import Callable, Collection, Mapping
from typing import Any

from timemap_cli.changes.difference import Kind

CHANGES_FORMAT = "timemap.changes/1"
REPORT_FORMAT = "timemap.report/1"
_Check = Callable[[Any], bool]
_FARTHEST_M = 1e9
_MOST_NS = 2**63 - 1


def parsed(text: str) -> Any:
    """The value of a JSON text; ValueError where it is none, NaN and Infinity too."""
    try:
        return json.loads(text, parse_constant=_refused)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error


def check_changes(document: Any, levels: Collection[str], nodes: int) -> dict[str, Any]:
    """The document `timemap.changes/1` of a result with these levels and so many nodes; ValueError if it is none."""
    event = _event(set(levels), nodes)
    form = _form(
        {
            "schema": lambda schema: schema == CHANGES_FORMAT,
            "events": _list_of(event),
            "summary": _by_name(_is_count),
        }
    )
    return _checked(document, form)


def check_report(document: Any) -> dict[str, Any]:
    """The document `timemap.report/1` of a result; ValueError if it is none."""
    scans = _form({"read": _is_count, "used": _is_count, "dropped": _by_word(_is_count)})
    form = _form({"schema": lambda schema: schema == REPORT_FORMAT, "nodes": _is_count, "scans": scans})
    report = _checked(document, form)
    if not _is_text(report.get("no_return", "")) or not _by_name(_by_word(_is_share))(
        report.get("beams", {})
    ):
        raise ValueError("a missing return or beams that are not of their kind")
    return report


def check_inputs(document: Any) -> list[dict[str, str]]:
    """The recordings that a result's metadata names; ValueError if it is no list of names and checksums."""
    if not _list_of(_form({"name": _is_text, "sha256": _is_text}))(document):
        raise ValueError("not a list of recordings")
    inputs: list[dict[str, str]] = document
    return inputs


def check_dropped(document: Any) -> dict[str, int]:
    """The scans dropped by reason, as a result's metadata has them; ValueError if they are none."""
    if not _by_word(_is_count)(document):
        raise ValueError("not counts by reason")
    dropped: dict[str, int] = document
    return dropped


def _checked(document: Any, form: _Check) -> dict[str, Any]:
    if not form(document):
        raise ValueError("a field is missing, or not of its kind")
    checked: dict[str, Any] = document
    return checked


def _event(levels: set[str], nodes: int) -> _Check:
    is_node = _list_of(lambda node: _is_count(node) and node < nodes)
    return _form(
        {
            "id": _is_count,
            "kind": lambda kind: kind in [one.value for one in Kind],
            "x": _is_length,
            "y": _is_length,
            "bounds": _is_bounds,
            "outline": lambda corners: _list_of(_is_place)(corners) and len(corners) > 0,
            "support": _is_share,
            "moved_from": _or_none(_is_place),
            "nodes": is_node,
            "against": is_node,
            "first_seen_ns": _is_stamp,
            "last_seen_ns": _is_stamp,
            "looked_ns": _is_stamp,
            "closed_ns": _or_none(_is_stamp),
            "not_seen_since": _is_flag,
            "adopted": lambda by_level: _by_name(_or_none(_is_stamp))(by_level) and by_level.keys() <= levels,
            "recurring": _is_flag,
            "episodes": lambda some: _list_of(_EPISODE)(some) and len(some) > 0,
            "toggles": _is_count,
            "looks": _is_count,
            "share_held": _is_share,
        }
    )


def _form(fields: Mapping[str, _Check]) -> _Check:
    """An object with at least these fields."""
    return lambda value: (
        isinstance(value, dict)
        and all(name in value and check(value[name]) for name, check in fields.items())
    )


def _list_of(check: _Check) -> _Check:
    return lambda value: isinstance(value, list) and all(map(check, value))


def _by_name(check: _Check) -> _Check:
    return lambda value: isinstance(value, dict) and all(map(check, value.values()))


def _by_word(check: _Check) -> _Check:
    """By names that may stand anywhere: in a baseline, in a sentence."""
    return lambda value: _by_name(check)(value) and all(re.fullmatch(r"\w{1,100}", name) for name in value)


def _or_none(check: _Check) -> _Check:
    return lambda value: value is None or check(value)


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_flag(value: Any) -> bool:
    return isinstance(value, bool)


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 <= value <= _MOST_NS


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _is_length(value: Any) -> bool:
    return _is_number(value) and abs(value) <= _FARTHEST_M


def _is_share(value: Any) -> bool:
    return _is_number(value) and 0 <= value <= 1


def _is_place(value: Any) -> bool:
    return _list_of(_is_length)(value) and len(value) == 2


def _is_bounds(value: Any) -> bool:
    return _list_of(_is_length)(value) and len(value) == 4


def _is_stamp(value: Any) -> bool:
    """Nanoseconds as text, within 64 bits."""
    is_whole = isinstance(value, str) and re.fullmatch(r"-?[0-9]{1,19}", value)
    return bool(is_whole) and abs(int(value)) <= _MOST_NS


_EPISODE = _form({"since_ns": _is_stamp, "until_ns": _or_none(_is_stamp)})


def _refused(word: str) -> Any:
    raise ValueError(f"{word} is no number of JSON")
