"""Trials in processes of their own, which may hang, die or grow without harm."""

import faulthandler
import multiprocessing
import os
import resource
import tempfile
import warnings
from collections.abc import Sequence
from multiprocessing.connection import Connection, wait
from pathlib import Path

from benchmarks.damage.trial import Bench, Trial, Verdict

MOST_SECONDS = 20.0  # of one trial; an undamaged one takes a few hundredths
ADDRESS_SPACE = 3 << 30  # what a process may ask for; what it holds is measured
PART = 250  # trials of one process, so that the most memory it ever held is that of few


def run(name: str, numbers: range, seed: int, workers: int) -> list[Trial]:
    """Trials of a format, in order of their numbers."""
    parts = [numbers[at : at + PART] for at in range(0, len(numbers), PART)]
    found: list[Trial] = []
    running: dict[Connection, tuple[range, list[Trial]]] = {}
    while parts or running:
        while parts and len(running) < workers:
            part = parts.pop(0)
            running[_started(name, part, seed)] = part, []
        for one in wait(list(running)):
            assert isinstance(one, Connection)
            part, done = running[one]
            try:
                done.append(one.recv())
            except EOFError:
                del running[one]
                one.close()
                if len(done) < len(part):
                    number = part[len(done)]
                    done.append(Trial(number, "", Verdict.HANG, "the process was ended"))
                    parts.insert(0, part[len(done) :])
                found += done
    return sorted(found, key=lambda trial: trial.number)


def _started(name: str, numbers: Sequence[int], seed: int) -> Connection:
    """The end of the pipe on which the trials come."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    context.Process(target=_work, args=(name, numbers, seed, sender), daemon=True).start()
    sender.close()
    return receiver


def _work(name: str, numbers: Sequence[int], seed: int, sender: Connection) -> None:
    # On one processor a replay is done in this process alone, whose memory is measured.
    os.sched_setaffinity(
        0, {min(os.sched_getaffinity(0))} if os.getpid() % 2 else {max(os.sched_getaffinity(0))}
    )
    warnings.simplefilter("error")
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    memory = Path("/dev/shm")  # a result is written through to the disk, which takes longer than all else
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        bench = Bench(name, Path(folder))
        for number in numbers:
            faulthandler.dump_traceback_later(MOST_SECONDS, exit=True)
            trial = bench.trial(number, seed)
            faulthandler.cancel_dump_traceback_later()
            sender.send(trial)
