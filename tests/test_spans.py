import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.spans import Span


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("50obs", 50.0, "obs"),
        ("34.7obs", 34.7, "obs"),
        ("30s", 30.0, "s"),
        ("0.2s", 0.2, "s"),
        (".5s", 0.5, "s"),
        ("10min", 600.0, "s"),
        ("12h", 43200.0, "s"),
        ("2d", 172800.0, "s"),
        (" 10 s ", 10.0, "s"),
    ],
)
def test_a_span_is_a_number_with_its_unit(text, value, unit):
    assert Span.parse(text) == Span(value, unit)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "5",
        "s",
        "5 weeks",
        "-5s",
        "5obs5",
        "nan s",
        "infs",
        "1e400 days",
        "5S",
        "1e999s",
        "\N{ARABIC-INDIC DIGIT THREE}s",
    ],
)
def test_anything_else_is_refused(text):
    with pytest.raises(ValueError, match="is not a number with one of the units"):
        Span.parse(text)


@pytest.mark.parametrize("text", ["50obs", "34.7obs", "30s", "0.2s", "10min", "12h", "90s", "0s"])
def test_a_span_is_written_as_people_write_it(text):
    assert str(Span.parse(text)) == text


@given(st.floats(0, 1e12), st.sampled_from(["obs", "s"]))
def test_a_written_span_reads_back_exactly(value, unit):
    assert Span.parse(str(Span(value, unit))) == Span(value, unit)
