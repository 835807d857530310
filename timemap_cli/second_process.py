"""A stage of the work in a process of its own, while this process makes what comes next."""

import multiprocessing
import os
import pickle
import signal
import sys
import traceback
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from multiprocessing.connection import Connection
from queue import SimpleQueue
from threading import Thread
from typing import Any, TypeVar

from timemap_cli.errors import TimemapError

T = TypeVar("T")
R = TypeVar("R")

_MOST_UNDER_WAY = 4  # items handed over whose results were not taken yet
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_PIPE_BYTES = 1 << 20  # what Linux lets anybody have: two or three blocks of scans


def mapped(
    make: Callable[[], Callable[[T], R]], items: Iterable[T], *, processors: int | None = None
) -> Generator[R, None, None]:
    """Yield `work(item)` of each item in turn, where `work = make()` lives and remembers in a second process.

    Items and results are pickled on their way. What `work` raises is raised here; TimemapError if the process is
    ended from outside. With one processor, or where a process cannot be forked, all is done in this one.
    """
    may_fork = (processors or len(_usable_processors())) > 1 and sys.platform.startswith("linux")
    worker = _started(make) if may_fork else None
    if worker is None:
        yield from map(make(), items)
        return
    under_way = 0
    try:
        for item in items:
            worker.send(item)
            under_way += 1
            while under_way >= _MOST_UNDER_WAY or worker.has_result:
                yield worker.result()
                under_way -= 1
        for _ in range(under_way):
            yield worker.result()
    finally:
        worker.stop()


def _started(make: Callable[[], Callable[[T], R]]) -> "_Worker | None":
    """A second process; None where the system grants none."""
    try:
        return _Worker(make)
    except OSError:  # too many processes, too many open files, too little memory
        return None


class _Worker:
    """The second process, as the first one sees it."""

    def __init__(self, make: Callable[[], Callable[[Any], Any]]) -> None:
        context = multiprocessing.get_context("fork")  # a copy of this process: `make` needs no pickling
        inbox, self._inbox = _pipe()
        self._outbox, outbox = _pipe()
        ours, theirs = (self._inbox, self._outbox), (inbox, outbox)
        self._process = context.Process(target=_serve, args=(make, inbox, outbox, ours), daemon=True)
        # The new process must not meet a signal before it has said what it makes of it.
        waiting = signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
        try:
            self._process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, waiting)
        for end in theirs:
            end.close()
        # Takes results at once, so that the worker never waits for us while we wait for it.
        self._results: SimpleQueue[bytes | None] = SimpleQueue()
        self._receiver = Thread(target=_receive_all, args=(self._outbox, self._results), daemon=True)
        self._receiver.start()

    @property
    def has_result(self) -> bool:
        return not self._results.empty()

    def send(self, item: Any) -> None:
        with suppress(BrokenPipeError):  # it has ended: the results tell why
            self._inbox.send(item)

    def result(self) -> Any:
        message = self._results.get()
        if message is None:
            self._results.put(None)
            raise TimemapError(
                "the process that remembers was ended from outside",
                hint="look whether the memory was used up: dmesg | grep -i 'out of memory'",
            )
        result, error = pickle.loads(message)
        if error is not None:
            raise error
        return result

    def stop(self) -> None:
        self._inbox.close()
        self._process.terminate()
        self._process.join()
        self._receiver.join()
        self._outbox.close()


def _serve(
    make: Callable[[], Callable[[Any], Any]],
    inbox: Connection,
    outbox: Connection,
    others: Iterable[Connection],
) -> None:
    """Answer each item with its result, or with what went wrong; end when nobody asks or listens any more."""
    for end in others:
        end.close()  # else the pipes would stay open when the first process dies
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # they come to both processes: the first one decides
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
    with suppress(EOFError, BrokenPipeError):
        try:
            work = make()
            while True:
                outbox.send((work(inbox.recv()), None))
        except (EOFError, BrokenPipeError):
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, it belongs to who asked
            outbox.send((None, _sendable(error)))


def _receive_all(outbox: Connection, results: "SimpleQueue[bytes | None]") -> None:
    with suppress(EOFError, OSError, MemoryError):  # between two messages, or within one
        while True:
            results.put(outbox.recv_bytes())
    results.put(None)


def _sendable(error: Exception) -> Exception:
    """The error itself if it survives pickling, else its traceback in words."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - what an error's own code raises can be anything
        return RuntimeError("".join(traceback.format_exception(error)))
    return error


def _pipe() -> tuple[Connection, Connection]:
    """Receiving and sending end, with room for more than one item where the system grants it."""
    receiver, sender = multiprocessing.Pipe(duplex=False)
    import fcntl

    with suppress(OSError):
        fcntl.fcntl(sender.fileno(), fcntl.F_SETPIPE_SZ, _PIPE_BYTES)
    return receiver, sender


def _usable_processors() -> set[int]:
    return os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
