import pytest

from timemap_cli.checks.tolerances import checked, parsed
from timemap_cli.errors import UsageError


def test_options_are_read():
    assert parsed(["ranges.moved=0.02", "events.new=1"]) == {"ranges.moved": 0.02, "events.new": 1.0}


@pytest.mark.parametrize(
    ("word", "message", "hint"),
    [
        ("range.moved=0.02", "unknown tolerance range.moved in --tolerance", "ranges.moved"),
        ("ranges.moved", "--tolerance ranges.moved has no value", "--tolerance ranges.moved=0.02"),
        (
            "ranges.moved=much",
            "--tolerance ranges.moved=much is not a number",
            "--tolerance ranges.moved=0.02",
        ),
        ("ranges.moved=-1", "tolerance ranges.moved in --tolerance is not a number from 0 on: -1.0", None),
        ("ranges.moved=nan", "tolerance ranges.moved in --tolerance is not a number from 0 on: nan", None),
    ],
)
def test_a_wrong_option_is_refused_by_name(word, message, hint):
    with pytest.raises(UsageError) as refused:
        parsed([word])
    assert (refused.value.message, refused.value.hint) == (message, hint)


@pytest.mark.parametrize("value", ["0.1", True, None, [1]])
def test_a_file_s_tolerance_is_a_number(value):
    with pytest.raises(UsageError, match="is not a number from 0 on"):
        checked({"ranges.moved": value}, "b.yaml")
