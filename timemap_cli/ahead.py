"""Work done ahead of who needs it, in a process of its own."""

import multiprocessing
import os
import pickle
import signal
import sys
import traceback
from collections.abc import Callable, Generator, Iterable
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from timemap_cli.errors import TimemapError

T = TypeVar("T")


def ahead(make: Callable[[], Iterable[T]], *, processors: int | None = None) -> Generator[T, None, None]:
    """Yield the items of `make()` in their order, each made in a second process while the one before is in use.

    Items are pickled on their way, and what `make` changes besides stays in its process. What it raises is raised here.
    With one processor, or where a process cannot be forked, the items are made in turn.
    """
    if (processors or len(_usable_processors())) < 2 or not sys.platform.startswith("linux"):
        yield from make()
        return
    context = multiprocessing.get_context(
        "fork"
    )  # a copy of this process: open files and all need no pickling
    receiver, sender = context.Pipe(duplex=False)
    worker = context.Process(target=_send_all, args=(make, receiver, sender), daemon=True)
    worker.start()
    sender.close()
    try:
        yield from _received(receiver)
    finally:
        receiver.close()
        worker.terminate()
        worker.join()


def _usable_processors() -> set[int]:
    return os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()


def _send_all(make: Callable[[], Iterable[Any]], receiver: Connection, sender: Connection) -> None:
    """Send each item, then None; or what went wrong."""
    receiver.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that reads us decides
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        for item in make():
            sender.send((item, None))
        sender.send(None)
    except BrokenPipeError:
        pass  # nobody wants the rest
    except Exception as error:  # noqa: BLE001 - whatever it is, it belongs to who asked
        sender.send((None, _sendable(error)))


def _sendable(error: Exception) -> Exception:
    """The error itself if it survives pickling, else its traceback in words."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - what an error's own code raises can be anything
        return RuntimeError("".join(traceback.format_exception(error)))
    return error


def _received(receiver: Connection) -> Generator[Any, None, None]:
    while True:
        try:
            message = receiver.recv()
        except (EOFError, OSError):  # between two messages, or within one
            raise TimemapError("the process that reads the recordings was ended from outside") from None
        if message is None:
            return
        item, error = message
        if error is not None:
            raise error
        yield item
