"""Replays stopped at a few random moments; `make kill-bench` does it at many."""

import signal

import pytest

from benchmarks.stopped_replays import SAMPLES, Trial, stops


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    return Trial(tmp_path_factory.mktemp("trial"), SAMPLES)


def test_kill_9_leaves_the_earlier_result_readable_and_the_next_replay_clears_up(trial):
    for stop in stops(trial, [signal.SIGKILL] * 4, seed=1):
        assert stop.trouble == ()
    assert trial.finish() == "new"
    assert trial.beside() == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_what_can_be_caught_leaves_the_earlier_result_and_nothing_beside_it(trial, number):
    stop = trial.stop(number, trial.whole_s * 0.7)
    assert stop.trouble == ()
    assert stop.beside == 0
