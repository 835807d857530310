from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.errors import UsageError
from timemap_cli.times import format_time, parse_time

START = 1_700_000_000_000_000_000  # 2023-11-14T22:13:20Z
END = START + 60_000_000_000


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1700000000000000001", START + 1),
        ("2023-11-14T22:13:20Z", START),
        ("2023-11-14 22:13:20z", START),
        ("2023-11-14T23:13:20+01:00", START),
        ("2023-11-14T20:43:20-01:30", START),
        ("2023-11-14T22:13:20.5Z", START + 500_000_000),
        ("2023-11-14T22:13:20.000000001Z", START + 1),
        ("1969-12-31T23:59:59.25Z", -750_000_000),
        ("+10s", START + 10_000_000_000),
        ("start+10s", START + 10_000_000_000),
        ("+0.1s", START + 100_000_000),
        ("+250ms", START + 250_000_000),
        ("+1.5min", START + 90_000_000_000),
        ("+2h", START + 7_200_000_000_000),
        ("+1234567890.123456789s", START + 1_234_567_890_123_456_789),
        ("end-5s", END - 5_000_000_000),
        ("2023-11-14T22:13Z", START - 20_000_000_000),
        ("2023-11-14 23:13+01:00", START - 20_000_000_000),
        ("2023-11-14", 1_699_920_000_000_000_000),
        ("2023-11-14Z", 1_699_920_000_000_000_000),
        ("2023-11-14-01:30", 1_699_925_400_000_000_000),
        ("10s", END - 10_000_000_000),
        ("2d", END - 2 * 86_400_000_000_000),
        ("1.5d", END - 36 * 3_600_000_000_000),
        ("1h30min", END - 5_400_000_000_000),
        ("+1d12h", START + 36 * 3_600_000_000_000),
        ("end-2d", END - 2 * 86_400_000_000_000),
        ("start", START),
        ("end", END),
        (" end ", END),
    ],
)
def test_times_are_read_to_the_nanosecond(text, expected):
    assert parse_time(text, START, END) == expected


@pytest.mark.parametrize(
    "text",
    [
        *("", "soon", "-10s", "end+5s", "+5", "+5 weeks", "1.5", "2d3", "10s ago", "+", "end-", "9" * 5000),
        *("2023-11", "2023-13-14", "2023-02-29", "2023-11-14T22Z", "2023-11-14T22:60Z"),
        *("2023-13-14T22:13:20Z", "2023-11-14T25:13:20Z"),
        *("\N{ARABIC-INDIC DIGIT THREE}", "+\N{ARABIC-INDIC DIGIT THREE}s"),
    ],
)
def test_what_is_no_time_is_refused_with_examples(text):
    with pytest.raises(UsageError, match="is not a time") as caught:
        parse_time(text, START, END)
    assert "+10s" in caught.value.hint
    assert "2024-05-01T12:00:00Z" in caught.value.hint


YEAR_NS = 365 * 86_400_000_000_000


@pytest.mark.parametrize(
    "text",
    ["0", "10", "1700000000", "1700000000000", "20231114", str(START - 2 * YEAR_NS), str(END + 2 * YEAR_NS)],
)
def test_a_bare_number_years_outside_the_recording_is_refused_with_the_forms_there_are(text):
    with pytest.raises(UsageError, match=f"'{text}' alone is nanoseconds since 1970") as caught:
        parse_time(text, START, END)
    assert "2023-11-14T22:13:20Z to 2023-11-14T22:14:20Z" in caught.value.message
    forms = (
        "+10s",
        "10s",
        "end-5min",
        "2024-05-01",
        "2024-05-01T12:00Z",
        "2024-05-01T12:00:00Z",
        "nanoseconds",
    )
    assert all(form in caught.value.hint for form in forms)


@pytest.mark.parametrize("text", ["1", "10", "999999"])
def test_a_bare_number_below_a_millisecond_is_no_time_of_a_simulation_either(text):
    """Whose clock begins with 0: nobody means 10 ns."""
    with pytest.raises(UsageError, match="alone is nanoseconds since 1970"):
        parse_time(text, 0, 300 * 10**9)


@pytest.mark.parametrize("stamp_ns", [0, 10**9, 10**6, 300 * 10**9])
def test_nanoseconds_of_a_simulation_are_times(stamp_ns):
    assert parse_time(str(stamp_ns), 0, 300 * 10**9) == stamp_ns


@pytest.mark.parametrize("text", ["2023-11-14T22:13", "2023-11-14T22:13:20", "2023-11-14 22:13:20.5"])
def test_a_time_without_its_zone_is_refused_with_the_zone(text):
    with pytest.raises(UsageError, match=f"'{text}' has no time zone") as caught:
        parse_time(text, START, END)
    first, second = caught.value.hint.split(", or with an offset: ")
    assert parse_time(first, START, END) - parse_time(second, START, END) == 2 * 3600 * 10**9


def test_a_time_beyond_64_bits_is_refused():
    with pytest.raises(UsageError, match="64 bits"):
        parse_time("+99999999h", START, END)
    with pytest.raises(UsageError, match="64 bits"):
        parse_time("9" * 30, START, END)
    with pytest.raises(UsageError, match="64 bits"):
        parse_time("9999-12-31", START, END)


@pytest.mark.parametrize(
    ("stamp_ns", "expected"),
    [
        (0, "1970-01-01T00:00:00Z"),
        (START, "2023-11-14T22:13:20Z"),
        (START + 250_000_000, "2023-11-14T22:13:20.25Z"),
        (START + 1, "2023-11-14T22:13:20.000000001Z"),
        (-1, "1969-12-31T23:59:59.999999999Z"),
    ],
)
def test_times_are_written_in_utc_without_needless_digits(stamp_ns, expected):
    assert format_time(stamp_ns) == expected


@given(st.integers(-(2**63) + 1, 2**63 - 1))
def test_a_written_time_reads_back_exactly(stamp_ns):
    assert parse_time(format_time(stamp_ns), 0, 0) == stamp_ns


@given(st.integers(0, 2**32 - 1))
def test_reading_agrees_with_the_standard_library(seconds):
    moment = datetime.fromtimestamp(seconds, UTC)
    assert parse_time(moment.isoformat(), 0, 0) == seconds * 10**9


@given(st.integers(1, 10**6), st.sampled_from(["ms", "s", "min", "h"]))
def test_a_bare_span_counts_back_from_the_end(number, unit):
    assert parse_time(f"{number}{unit}", START, END) == parse_time(f"end-{number}{unit}", START, END)


@given(st.dates())
def test_a_date_is_its_midnight_in_utc(day):
    midnight = datetime(day.year, day.month, day.day, tzinfo=UTC)
    expected = round((midnight - datetime(1970, 1, 1, tzinfo=UTC)).total_seconds()) * 10**9
    if abs(expected) < 2**63:
        assert parse_time(day.isoformat(), START, END) == expected
