"""Points in time as people write them: nanoseconds, RFC 3339, `+10s` and `end-5s` of a recording."""

import re
from datetime import UTC, datetime, timedelta
from decimal import Decimal

from timemap_cli.errors import UsageError

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_LATEST_NS = 2**63 - 1
_UNIT_NS = {"ms": 10**6, "s": 10**9, "min": 60 * 10**9, "h": 3600 * 10**9}
_RELATIVE = re.compile(r"(?:(\+)|(start\+)|(end-))([0-9]+(?:\.[0-9]+)?)(ms|s|min|h)")
_RFC_3339 = re.compile(
    r"([0-9]{4}-[0-9]{2}-[0-9]{2})[Tt ]([0-9]{2}:[0-9]{2}:[0-9]{2})"
    r"(?:\.([0-9]{1,9}))?([Zz]|[+-][0-9]{2}:[0-9]{2})"
)


def parse_time(text: str, start_ns: int, end_ns: int) -> int:
    """Nanoseconds since 1970 of a time as people write it.

    `+10s` counts from `start_ns`, `end-5s` back from `end_ns`; `start` and `end` are these themselves. The
    result may lie outside the two. UsageError for anything that is not a time.
    """
    text = text.strip()
    relative = _RELATIVE.fullmatch(text)
    if re.fullmatch("[0-9]+", text):
        stamp_ns = int(text)
    elif text in ("start", "end"):
        stamp_ns = start_ns if text == "start" else end_ns
    elif relative:
        *_, backwards, number, unit = relative.groups()
        distance_ns = round(Decimal(number) * _UNIT_NS[unit])
        stamp_ns = end_ns - distance_ns if backwards else start_ns + distance_ns
    else:
        stamp_ns = _parse_rfc_3339(text)
    if not -_LATEST_NS <= stamp_ns <= _LATEST_NS:
        raise UsageError(f"the time '{text}' is outside what 64 bits of nanoseconds can hold")
    return stamp_ns


def format_time(stamp_ns: int) -> str:
    """RFC 3339 in UTC, with as many digits of the second as it takes: `2024-05-01T12:00:00.25Z`."""
    seconds, fraction_ns = divmod(int(stamp_ns), 10**9)
    whole = (_EPOCH + timedelta(seconds=seconds)).strftime("%Y-%m-%dT%H:%M:%S")
    fraction = f"{fraction_ns:09d}".rstrip("0")
    return f"{whole}.{fraction}Z" if fraction else f"{whole}Z"


def _parse_rfc_3339(text: str) -> int:
    match = _RFC_3339.fullmatch(text)
    if match is None and _RFC_3339.fullmatch(f"{text}Z"):
        raise UsageError(f"'{text}' has no time zone", hint=f"{text}Z, or with an offset: {text}+02:00")
    if match is None:
        raise _not_a_time(text)
    date, clock, fraction, offset = match.groups()
    try:
        moment = datetime.fromisoformat(f"{date}T{clock}{offset.upper()}")
    except ValueError as error:
        raise _not_a_time(text) from error
    # timedelta // timedelta stays in whole numbers, where timestamp() would round.
    return (moment - _EPOCH) // timedelta(seconds=1) * 10**9 + int((fraction or "0").ljust(9, "0"))


def _not_a_time(text: str) -> UsageError:
    return UsageError(
        f"'{text}' is not a time",
        hint="+10s or end-5min, counted from the start or the end (ms, s, min or h)\n"
        "2024-05-01T12:00:00Z, or with an offset: 2024-05-01T14:00:00+02:00\n"
        "1714564800000000000 (nanoseconds since 1970)",
    )
