"""Points in time as people write them: dates and RFC 3339, spans from the start or the end, nanoseconds."""

import re
from datetime import UTC, datetime, timedelta
from decimal import Decimal

from timemap_cli.errors import UsageError
from timemap_cli.spans import SECONDS

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_LATEST_NS = 2**63 - 1
_YEAR_NS = 366 * 86400 * 10**9
_LEAST_NS = 10**6  # of a bare number in a simulation, whose clock begins with 0: nobody means 10 ns
_UNIT_NS = {"ms": 10**6} | {unit: round(seconds * 1e9) for unit, seconds in SECONDS.items()}
_PART = r"([0-9]+(?:\.[0-9]+)?)(ms|s|min|h|d)"
_RELATIVE = re.compile(rf"(\+|start\+|end-|)((?:{_PART})+)")
_RFC_3339 = re.compile(
    r"([0-9]{4}-[0-9]{2}-[0-9]{2})[Tt ]([0-9]{2}:[0-9]{2}(?::[0-9]{2})?)"
    r"(?:(?<=:[0-9]{2}:[0-9]{2})\.([0-9]{1,9}))?([Zz]|[+-][0-9]{2}:[0-9]{2})"
)
_DATE = re.compile(r"([0-9]{4}-[0-9]{2}-[0-9]{2})([Zz]|[+-][0-9]{2}:[0-9]{2})?")
_FORMS = (
    "+10s or end-5min, counted from the start or the end; 10s alone back from the end (ms, s, min, h or d)\n"
    "2024-05-01T12:00:00Z, 2024-05-01T12:00Z, or with an offset: 2024-05-01T14:00:00+02:00\n"
    "2024-05-01, where that day begins in UTC\n"
    "1714564800000000000 (nanoseconds since 1970)"
)


def parse_time(text: str, start_ns: int, end_ns: int) -> int:
    """Nanoseconds since 1970 of a time as people write it.

    `+10s` counts from `start_ns`, `end-5s` and a bare `5s` back from `end_ns`; `start` and `end` are these
    themselves. A date is its midnight in UTC. The result may lie outside the two, but a bare number not by years.
    UsageError for anything that is not a time.
    """
    text = text.strip()
    relative = _RELATIVE.fullmatch(text)
    if re.fullmatch("[0-9]{1,30}", text):
        stamp_ns = _parse_number(text, start_ns, end_ns)
    elif text in ("start", "end"):
        stamp_ns = start_ns if text == "start" else end_ns
    elif relative:
        distance_ns = _length_ns(relative[2])
        stamp_ns = start_ns + distance_ns if relative[1].endswith("+") else end_ns - distance_ns
    else:
        stamp_ns = _parse_rfc_3339(text)
    return _within_64_bits(stamp_ns, text)


def format_time(stamp_ns: int) -> str:
    """RFC 3339 in UTC, with as many digits of the second as it takes: `2024-05-01T12:00:00.25Z`."""
    seconds, fraction_ns = divmod(int(stamp_ns), 10**9)
    whole = (_EPOCH + timedelta(seconds=seconds)).strftime("%Y-%m-%dT%H:%M:%S")
    fraction = f"{fraction_ns:09d}".rstrip("0")
    return f"{whole}.{fraction}Z" if fraction else f"{whole}Z"


def _parse_number(text: str, start_ns: int, end_ns: int) -> int:
    """A bare number; UsageError where it can hardly be meant as nanoseconds, but perhaps as seconds or a date."""
    stamp_ns = _within_64_bits(int(text), text)
    if not start_ns - _YEAR_NS <= stamp_ns <= end_ns + _YEAR_NS or 0 < stamp_ns < _LEAST_NS:
        span = f"{format_time(start_ns)} to {format_time(end_ns)}"
        raise UsageError(
            f"'{text}' alone is nanoseconds since 1970, {format_time(stamp_ns)}, and the times go from {span}",
            hint=_FORMS,
        )
    return stamp_ns


def _within_64_bits(stamp_ns: int, text: str) -> int:
    if not -_LATEST_NS <= stamp_ns <= _LATEST_NS:
        raise UsageError(f"the time '{text}' is outside what 64 bits of nanoseconds can hold")
    return stamp_ns


def _length_ns(span: str) -> int:
    """Of a span such as `1h30min`."""
    return round(sum(Decimal(number) * _UNIT_NS[unit] for number, unit in re.findall(_PART, span)))


def _parse_rfc_3339(text: str) -> int:
    match = _RFC_3339.fullmatch(text)
    if match is None and _RFC_3339.fullmatch(f"{text}Z"):
        raise UsageError(f"'{text}' has no time zone", hint=f"{text}Z, or with an offset: {text}+02:00")
    if match is not None:
        date, clock, fraction, offset = match.groups()
    elif (day := _DATE.fullmatch(text)) is not None:
        date, clock, fraction, offset = day[1], "00:00", None, day[2] or "Z"
    else:
        raise _not_a_time(text)
    try:
        moment = datetime.fromisoformat(f"{date}T{clock}{offset.upper()}")
    except ValueError as error:
        raise _not_a_time(text) from error
    # timedelta // timedelta stays in whole numbers, where timestamp() would round.
    return (moment - _EPOCH) // timedelta(seconds=1) * 10**9 + int((fraction or "0").ljust(9, "0"))


def _not_a_time(text: str) -> UsageError:
    return UsageError(f"'{text}' is not a time", hint=_FORMS)
