import shlex

from timemap_cli.errors import ExitCode, TimemapError, UsageError, as_word, no_such_file


def test_exit_codes_are_those_of_the_readme():
    assert [int(code) for code in ExitCode] == [0, 1, 2, 3, 4, 130]


def test_an_error_carries_message_hint_and_code():
    error = TimemapError("log.mcap is cut off", hint="mcap recover log.mcap", exit_code=ExitCode.DATA_LOST)
    assert (str(error), error.message) == ("log.mcap is cut off", "log.mcap is cut off")
    assert (error.hint, error.exit_code) == ("mcap recover log.mcap", 3)


def test_an_error_without_more_said_means_failed_and_has_no_hint():
    error = TimemapError("disk full")
    assert (error.hint, error.exit_code) == (None, 1)


def test_a_usage_error_is_a_timemap_error_with_code_2():
    error = UsageError("no such topic", hint="timemap info log.mcap")
    assert isinstance(error, TimemapError)
    assert (error.hint, error.exit_code) == ("timemap info log.mcap", 2)


def test_for_a_missing_file_what_is_called_much_like_it_is_proposed(tmp_path):
    for name in ("monday.mcap", "notes.txt"):
        (tmp_path / name).touch()
    error = no_such_file(tmp_path / "mondya.mcap", "a recording")
    assert (error.message, error.hint) == (
        f"there is no file {tmp_path}/mondya.mcap",
        f"{tmp_path}/monday.mcap",
    )
    assert no_such_file(tmp_path / "x", "a recording").hint == "a recording"
    assert no_such_file(tmp_path / "nowhere" / "x", "a recording").hint == "a recording"


def test_a_name_becomes_one_word_of_a_command_to_paste():
    """As POSIX shells read it."""
    assert as_word("/scan") == "/scan"
    assert shlex.split(as_word("/a b; rm -rf $(x)")) == ["/a b; rm -rf $(x)"]
    assert as_word("/a\nrm\x1b[2J") == "'/a\\nrm\\x1b[2J'"
