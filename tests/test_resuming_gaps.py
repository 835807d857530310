"""A clock that was a year ahead for one recording: it is told, and so is the way back."""

import shutil

import pytest

from tests.logs.recorded import START_NS
from tests.test_replay import DAY_NS, standing_log
from timemap_cli.config import load
from timemap_cli.errors import UsageError
from timemap_cli.replay import replay

SETTINGS = load(None)


def days(tmp_path, *numbers):
    """A result after each of these days, each going on from the one before: `0.timemap.mcap`, ..."""
    done = None
    for number, day in enumerate(numbers):
        log = standing_log(tmp_path / f"day{day}.mcap", start_ns=START_NS + day * DAY_NS)
        resumed = None if done is None else done.result
        done = replay([log], tmp_path / f"{number}.timemap.mcap", SETTINGS, resume=resumed)
    return done


def gaps(summary):
    return [warning for warning in summary.warnings if "days later" in warning]


def test_a_gap_of_a_year_is_told_with_the_result_to_go_back_to(tmp_path):
    (warning,) = gaps(days(tmp_path, 0, 367))
    assert "2023-11-14T22:13:29.9Z" in warning
    assert "2024-11-15T22:13:20Z" in warning
    assert "367 days later" in warning
    assert f"--resume {tmp_path / '0.timemap.mcap'}" in warning


@pytest.mark.parametrize("pause", [0, 1, 100])
def test_a_weekend_or_a_season_is_not_told(tmp_path, pause):
    assert gaps(days(tmp_path, 0, pause + 1)) == []


def test_a_gap_between_recordings_of_one_replay_is_told(tmp_path):
    logs = [standing_log(tmp_path / f"{n}.mcap", start_ns=START_NS + n * DAY_NS) for n in (0, 1, 400)]
    (warning,) = gaps(replay(logs, tmp_path / "out.timemap.mcap", SETTINGS))
    assert "399 days later" in warning
    assert "--resume" not in warning
    cut = replay(logs, tmp_path / "out.timemap.mcap", SETTINGS, end="2024-01-01", force=True)
    assert gaps(cut) == []


def refused(tmp_path, day, resume, *, start=None):
    log = standing_log(tmp_path / f"day{day}.mcap", start_ns=START_NS + day * DAY_NS)
    with pytest.raises(UsageError, match=r"before .* ends") as raised:
        replay([log], tmp_path / "new.timemap.mcap", SETTINGS, resume=resume, start=start)
    return log, raised.value.hint


def test_a_right_day_after_it_is_refused_with_the_way_back_and_that_works(tmp_path):
    newest = days(tmp_path, 0, 367, 368).result
    log, hint = refused(tmp_path, 2, newest)
    before = tmp_path / "0.timemap.mcap"
    assert f"timemap replay {log} --resume {before}" in hint.splitlines()
    assert "--start" not in hint
    assert replay([log], tmp_path / "new.timemap.mcap", SETTINGS, resume=before).scans_used == 100


def test_where_the_result_before_it_is_gone_it_is_named(tmp_path):
    newest = days(tmp_path, 0, 367).result
    (tmp_path / "0.timemap.mcap").unlink()
    _, hint = refused(tmp_path, 2, newest)
    assert "0.timemap.mcap" in hint
    assert "--start" not in hint


def test_a_day_before_all_of_them_is_to_be_replayed_in_one_go(tmp_path):
    newest = days(tmp_path, 5, 6).result
    _, hint = refused(tmp_path, 2, newest)
    assert "in one go" in hint
    assert "--resume" not in hint


def test_where_something_else_took_its_place_it_is_named(tmp_path):
    newest = days(tmp_path, 0, 367).result
    (tmp_path / "0.timemap.mcap").write_bytes(b"something else")
    _, hint = refused(tmp_path, 2, newest)
    assert "0.timemap.mcap" in hint


def test_a_result_that_names_itself_ends_the_way_back(tmp_path):
    newest = days(tmp_path, 0, 367).result
    again = tmp_path / "0.timemap.mcap"
    shutil.copy(newest, again)
    _, hint = refused(tmp_path, 2, again)
    assert "in one go" in hint


def test_what_only_begins_before_the_end_may_still_be_cut(tmp_path):
    first = standing_log(tmp_path / "a.mcap", n_scans=600)
    one = replay([first], tmp_path / "one.timemap.mcap", SETTINGS, end="+30s").result
    with pytest.raises(UsageError) as raised:
        replay([first], tmp_path / "two.timemap.mcap", SETTINGS, resume=one)
    assert raised.value.hint.endswith("--start 2023-11-14T22:13:50Z")
