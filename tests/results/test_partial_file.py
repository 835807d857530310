"""The hidden file beside an output: whose it is, and when it may be removed."""

import os
import signal
import subprocess
import sys
import time

import pytest

from timemap_cli.results.atomic_file import AtomicFile
from timemap_cli.results.partial_file import PartialFile, remove_abandoned

HOLDS = (
    "import sys, time; from pathlib import Path; from timemap_cli.results.atomic_file import AtomicFile\n"
    "out = AtomicFile(Path(sys.argv[1]), force=True); out.write(b'half'); print('there', flush=True); time.sleep(60)"
)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def writing(tmp_path):
    """A program that is writing out.bin."""
    command = [sys.executable, "-c", HOLDS, str(tmp_path / "out.bin")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "there\n"
        yield process
        process.kill()


def test_what_kill_9_left_is_removed_by_the_next_one_who_writes_there(writing, tmp_path):
    writing.kill()
    writing.wait()
    assert [name[:17] for name in names(tmp_path)] == [".out.bin.timemap-"]
    with AtomicFile(tmp_path / "out.bin") as out:
        out.write(b"new")
        out.commit()
    assert names(tmp_path) == ["out.bin"]


def test_the_file_of_a_program_that_still_runs_stays(writing, tmp_path):
    (theirs,) = names(tmp_path)
    with AtomicFile(tmp_path / "out.bin", force=True) as out:
        out.write(b"new")
        out.commit()
    assert names(tmp_path) == [theirs, "out.bin"]
    assert (tmp_path / "out.bin").read_bytes() == b"new"


def test_two_writers_in_one_program_leave_each_other_alone(tmp_path):
    path = tmp_path / "out.bin"
    with AtomicFile(path, force=True) as first, AtomicFile(path, force=True) as second:
        first.write(b"first")
        second.write(b"second")
        second.commit()
        assert path.read_bytes() == b"second"
        first.commit()
        assert path.read_bytes() == b"first"
    assert names(tmp_path) == ["out.bin"]


@pytest.mark.parametrize(
    "name",
    [
        ".out.bin.timemap-0123abc.part",  # one digit less
        ".out.bin.timemap-0123ABCD.part",
        ".out.bin.timemap-0123abcd.part2",
        ".out_bin.timemap-0123abcd.part",
        ".other.bin.timemap-0123abcd.part",
        "out.bin.timemap-0123abcd.part",
        ".out.bin.swp",
        "out.bin~",
    ],
)
def test_files_that_are_called_only_much_alike_stay(tmp_path, name):
    (tmp_path / name).write_bytes(b"mine")
    remove_abandoned(tmp_path / "out.bin")
    assert names(tmp_path) == [name]


def test_links_folders_and_pipes_of_that_name_stay_and_nothing_waits_for_a_pipe(tmp_path):
    mine = tmp_path / "mine.txt"
    mine.write_bytes(b"mine")
    (tmp_path / ".out.bin.timemap-00000001.part").symlink_to(mine)
    (tmp_path / ".out.bin.timemap-00000002.part").mkdir()
    os.mkfifo(tmp_path / ".out.bin.timemap-00000003.part")
    before = names(tmp_path)
    remove_abandoned(tmp_path / "out.bin")
    assert names(tmp_path) == before
    assert mine.read_bytes() == b"mine"


def test_an_abandoned_file_of_that_name_goes(tmp_path):
    (tmp_path / ".out.bin.timemap-0123abcd.part").write_bytes(b"half")
    remove_abandoned(tmp_path / "out.bin")
    assert names(tmp_path) == []


def test_a_name_full_of_signs_is_taken_literally(tmp_path):
    (tmp_path / ".a+b.timemap-0123abcd.part").write_bytes(b"half")
    (tmp_path / ".aab.timemap-0123abcd.part").write_bytes(b"mine")
    remove_abandoned(tmp_path / "a+b")
    assert names(tmp_path) == [".aab.timemap-0123abcd.part"]


def test_a_folder_that_is_not_there_is_no_failure(tmp_path):
    remove_abandoned(tmp_path / "nowhere" / "out.bin")


def test_a_file_taken_for_abandoned_before_it_was_locked_is_made_anew(tmp_path, monkeypatch):
    """Between making and locking another program may find it."""
    made = []
    locks = PartialFile.__init__.__globals__["_lock"]

    def taken_once(handle, path):
        made.append(path)
        if len(made) == 1:
            remove_abandoned(tmp_path / "out.bin")
        return locks(handle, path)

    monkeypatch.setattr("timemap_cli.results.partial_file._lock", taken_once)
    file = PartialFile(tmp_path / "out.bin")
    assert len(made) == 2
    assert names(tmp_path) == [made[1].name]
    file.stream.close()
    file.remove()
    assert names(tmp_path) == []


def test_the_file_goes_with_the_program_when_an_interrupt_strikes_before_anybody_holds_it(tmp_path):
    code = (
        "import sys; from pathlib import Path; from timemap_cli.results.partial_file import PartialFile\n"
        "PartialFile._kept = PartialFile(Path(sys.argv[1])); raise KeyboardInterrupt"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path / "out.bin")], capture_output=True, check=False)
    assert names(tmp_path) == []


def test_a_forked_process_that_ends_takes_nothing_away(tmp_path):
    file = PartialFile(tmp_path / "out.bin")
    child = os.fork()
    if child == 0:
        file.remove()
        os._exit(0)
    os.waitpid(child, 0)
    assert names(tmp_path) == [file.path.name]
    file.stream.close()
    file.remove()


def test_a_killed_program_whose_forked_process_lives_on_is_cleared_up_later(tmp_path):
    """The forked process holds the lock, too; nothing may be taken away while anybody might be writing."""
    code = HOLDS.replace("print('there'", "import os; child = os.fork(); child and print(child")
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "out.bin")], stdout=subprocess.PIPE, text=True
    )
    child = int(process.stdout.readline())
    process.kill()
    process.wait()
    process.stdout.close()
    (left,) = names(tmp_path)
    remove_abandoned(tmp_path / "out.bin")
    assert names(tmp_path) == [left]
    os.kill(child, signal.SIGKILL)
    until = time.monotonic() + 10
    while names(tmp_path) and time.monotonic() < until:
        time.sleep(0.02)
        remove_abandoned(tmp_path / "out.bin")
    assert names(tmp_path) == []
