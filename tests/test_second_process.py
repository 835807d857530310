"""A stage of the work in a process of its own."""

import os
import signal
import subprocess
import sys
import time
from itertools import count, islice
from pathlib import Path

import pytest

from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.second_process import mapped


def doubling():
    return lambda item: 2 * item


def summing():
    """Remembers what it was given."""
    total = 0

    def work(item):
        nonlocal total
        total += item
        return total

    return work


@pytest.mark.parametrize("processors", [1, 2])
def test_results_come_in_the_order_of_the_items(processors):
    assert list(mapped(doubling, range(50), processors=processors)) == list(range(0, 100, 2))


@pytest.mark.parametrize("processors", [1, 2])
def test_the_work_remembers_from_item_to_item(processors):
    assert list(mapped(summing, [1, 2, 3], processors=processors)) == [1, 3, 6]


def test_the_work_is_done_in_another_process_and_the_items_are_made_in_this_one():
    items = (os.getpid() for _ in range(3))
    for theirs, mine in mapped(lambda: lambda item: (os.getpid(), item), items, processors=2):
        assert theirs != os.getpid()
        assert mine == os.getpid()
    assert set(mapped(lambda: lambda _: os.getpid(), [0], processors=1)) == {os.getpid()}


def test_items_are_not_made_far_ahead_of_their_results():
    made = []
    items = (made.append(i) or i for i in count())
    found = mapped(doubling, items, processors=2)
    assert list(islice(found, 3)) == [0, 2, 4]
    assert len(made) <= 3 + 4
    found.close()


@pytest.mark.parametrize("processors", [1, 2])
def test_items_and_results_larger_than_a_pipe_pass(processors):
    large = [bytes([i]) * 3_000_000 for i in range(9)]
    assert list(mapped(lambda: lambda item: item, iter(large), processors=processors)) == large


@pytest.mark.parametrize("processors", [1, 2])
def test_an_error_of_the_work_is_raised_after_the_results_before_it(processors):
    def make():
        def work(item):
            if item:
                raise UsageError("no such topic", hint="--scan-topic /scan")
            return item

        return work

    found = mapped(make, iter([0, 1, 2, 3, 4, 5, 6]), processors=processors)
    assert next(found) == 0
    with pytest.raises(UsageError, match="no such topic") as raised:
        next(found)
    assert raised.value.hint == "--scan-topic /scan"


@pytest.mark.parametrize("processors", [1, 2])
def test_an_error_of_the_items_is_raised(processors):
    def items():
        yield 1
        raise UsageError("cut off")

    with pytest.raises(UsageError, match="cut off"):
        list(mapped(doubling, items(), processors=processors))


class OddError(Exception):
    """Cannot be made again from what it hands to pickle."""

    def __init__(self, what, where):
        super().__init__(f"{what} at {where}")


def test_an_error_that_cannot_be_sent_comes_in_words():
    def make():
        def work(_):
            raise OddError("a", "b")

        return work

    with pytest.raises(RuntimeError, match="OddError: a at b"):
        list(mapped(make, [1], processors=2))


def test_a_process_that_ends_early_is_told():
    with pytest.raises(TimemapError, match="ended from outside"):
        list(mapped(lambda: lambda _: os._exit(9), range(100), processors=2))


def test_where_no_process_can_be_had_all_is_done_in_this_one(monkeypatch):
    def refused(_):
        raise BlockingIOError("too many processes")

    monkeypatch.setattr("multiprocessing.context.ForkProcess.start", refused)
    before = len(list(Path("/proc/self/fd").iterdir()))
    assert set(mapped(lambda: lambda _: os.getpid(), [0, 1], processors=2)) == {os.getpid()}
    assert len(list(Path("/proc/self/fd").iterdir())) == before


def test_too_little_memory_in_the_other_process_is_told():
    def make():
        def work(_):
            raise MemoryError

        return work

    with pytest.raises(MemoryError):
        list(mapped(make, [1], processors=2))


def test_a_result_for_which_there_is_no_memory_ends_the_waiting(monkeypatch):
    def exhausted(*_):
        raise MemoryError

    monkeypatch.setattr("multiprocessing.connection.Connection.recv_bytes", exhausted)
    with pytest.raises(TimemapError, match="ended from outside"):
        list(mapped(lambda: lambda _: 1, [1, 2, 3], processors=2))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_what_comes_from_the_terminal_is_left_to_the_first_process(number):
    """It comes to both, and the other one may just be starting."""

    def make():
        os.kill(os.getpid(), number)
        return lambda item: item

    assert list(mapped(make, [1, 2], processors=2)) == [1, 2]


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="looks for processes in /proc")
def test_the_second_process_ends_when_the_first_is_killed():
    code = (
        "import os, sys, time; from timemap_cli.second_process import mapped\n"
        "for pid in mapped(lambda: lambda _: os.getpid(), iter(int, 1), processors=2):\n"
        "    print(pid, flush=True); time.sleep(60)"
    )
    first = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    second = Path("/proc", first.stdout.readline().strip())
    assert second.exists()
    first.send_signal(signal.SIGKILL)
    first.wait()
    first.stdout.close()
    for _ in range(100):
        if not second.exists() or " Z " in second.joinpath("stat").read_text():
            break
        time.sleep(0.1)
    else:
        pytest.fail("the second process lives on")
