"""Work done ahead in a process of its own."""

import os
from itertools import count, islice

import pytest

from timemap_cli.ahead import ahead
from timemap_cli.errors import TimemapError, UsageError


@pytest.mark.parametrize("processors", [1, 2])
def test_items_come_in_their_order(processors):
    assert list(ahead(lambda: iter(range(50)), processors=processors)) == list(range(50))


def test_items_are_made_in_another_process():
    assert set(ahead(lambda: [os.getpid()], processors=2)) != {os.getpid()}
    assert set(ahead(lambda: [os.getpid()], processors=1)) == {os.getpid()}


@pytest.mark.parametrize("processors", [1, 2])
def test_an_error_is_raised_after_the_items_before_it(processors):
    def items():
        yield 1
        raise UsageError("no such topic", hint="--scan-topic /scan")

    found = ahead(items, processors=processors)
    assert next(found) == 1
    with pytest.raises(UsageError, match="no such topic") as raised:
        next(found)
    assert raised.value.hint == "--scan-topic /scan"


def test_items_that_nobody_takes_any_more_are_not_made_for_ever():
    found = ahead(count, processors=2)
    assert list(islice(found, 3)) == [0, 1, 2]
    found.close()


def test_a_process_that_ends_early_is_told():
    def items():
        yield 1
        os._exit(9)

    with pytest.raises(TimemapError, match="ended from outside"):
        list(ahead(items, processors=2))


class OddError(Exception):
    """Cannot be made again from what it hands to pickle."""

    def __init__(self, what, where):
        super().__init__(f"{what} at {where}")


def test_an_error_that_cannot_be_sent_comes_in_words():
    def items():
        yield 1
        raise OddError("a", "b")

    with pytest.raises(RuntimeError, match="OddError: a at b"):
        list(ahead(items, processors=2))
