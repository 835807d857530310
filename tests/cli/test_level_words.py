import pytest

from timemap_cli.cli.level_words import spread_levels


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("--level long mid", "--level long --level mid"),
        ("r.mcap --level long mid", "r.mcap --level long --level mid"),
        ("--level long mid r.mcap", "--level long --level mid r.mcap"),
        ("--level long mid dir/r", "--level long --level mid dir/r"),
        ("--level long r.mcap", "--level long r.mcap"),
        ("--level long ./r", "--level long ./r"),
        ("--level long r.mcap s.mcap", "--level long r.mcap s.mcap"),
        ("r.mcap s.mcap --level long", "r.mcap s.mcap --level long"),
        ("r.mcap --level long s.mcap", "r.mcap --level long s.mcap"),
        ("--level long", "--level long"),
        ("--level=long mid", "--level=long --level mid"),
        ("--level=long r.mcap", "--level=long r.mcap"),
        ("--level=long --json", "--level=long --json"),
        ("--level long --level mid", "--level long --level mid"),
        ("--level long --json mid", "--level long --json mid"),
        ("--json --level long mid --exit-code", "--json --level long --level mid --exit-code"),
        ("--level mid --between start end", "--level mid --between start end"),
        ("--between start end --level mid", "--between start end --level mid"),
        ("--at end --level long mid", "--at end --level long --level mid"),
        ("--level long mid short", "--level long --level mid short"),
        ("--level long Mid", "--level long Mid"),
        ("--level long 5min", "--level long 5min"),
        ("--level l_2 m_1", "--level l_2 --level m_1"),
        ("--level", "--level"),
        ("--level --json mid", "--level --json mid"),
        ("r.mcap -- --level long mid", "r.mcap -- --level long mid"),
        ("", ""),
    ],
)
def test_a_second_word_belongs_to_level_if_it_can_be_a_levels_name(given, expected):
    assert spread_levels(given.split()) == expected.split()


def test_the_given_arguments_stay_as_they_are():
    given = ["--level", "long", "mid"]
    spread_levels(given)
    assert given == ["--level", "long", "mid"]
