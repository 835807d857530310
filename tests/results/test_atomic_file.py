import errno
import os
import resource
import shutil
import sys
from pathlib import Path

import pytest

from timemap_cli.errors import ExitCode, TimemapError, UsageError
from timemap_cli.results.atomic_file import AtomicFile


def test_file_appears_at_commit_and_not_before(tmp_path):
    path = tmp_path / "out.bin"
    with AtomicFile(path) as out:
        out.write(b"abc")
        assert out.tell() == 3
        assert not path.exists()
        out.commit()
        assert path.read_bytes() == b"abc"
    assert [p.name for p in tmp_path.iterdir()] == ["out.bin"]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_nothing_is_left_after_an_exception(tmp_path, error):
    def fail_midway():
        with AtomicFile(tmp_path / "out.bin") as out:
            out.write(b"abc")
            raise error

    with pytest.raises(error):
        fail_midway()
    assert list(tmp_path.iterdir()) == []


def test_existing_file_is_refused_and_kept(tmp_path):
    path = tmp_path / "out.bin"
    path.write_bytes(b"old")
    with pytest.raises(UsageError, match=r"out\.bin exists already") as caught:
        AtomicFile(path)
    assert caught.value.exit_code is ExitCode.USAGE
    assert "--force" in caught.value.hint
    assert path.read_bytes() == b"old"


def test_file_that_appears_meanwhile_is_kept(tmp_path):
    path = tmp_path / "out.bin"
    with AtomicFile(path) as out:
        path.write_bytes(b"somebody else's")
        with pytest.raises(UsageError, match="exists already"):
            out.commit()
    assert path.read_bytes() == b"somebody else's"
    assert list(tmp_path.iterdir()) == [path]


def test_force_replaces_only_at_commit(tmp_path):
    path = tmp_path / "out.bin"
    path.write_bytes(b"old")
    with AtomicFile(path, force=True) as out:
        out.write(b"new")
        assert path.read_bytes() == b"old"
        out.commit()
    assert path.read_bytes() == b"new"


def test_folder_as_file_and_missing_folder_are_named(tmp_path):
    with pytest.raises(UsageError, match="it is a folder"):
        AtomicFile(tmp_path, force=True)
    with pytest.raises(UsageError, match=r"there is no folder .*nowhere"):
        AtomicFile(tmp_path / "nowhere" / "out.bin")


def test_what_may_not_be_replaced_is_kept_with_force_too(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("mine")
    for force in (False, True):
        with pytest.raises(
            UsageError, match=r"notes\.txt exists and is not .*: it is not replaced"
        ) as caught:
            AtomicFile(path, force=force, may_replace=lambda found: found != path)
        assert "--force" not in caught.value.hint
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("notes.txt", "mine")]


def test_a_link_stays_and_what_it_points_to_is_replaced(tmp_path):
    target, link = tmp_path / "inner" / "one.bin", tmp_path / "newest.bin"
    target.parent.mkdir()
    target.write_bytes(b"old")
    link.symlink_to(target)
    with AtomicFile(link, force=True) as out:
        out.write(b"new")
        out.commit()
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_a_link_to_nothing_yet_is_followed(tmp_path):
    link = tmp_path / "newest.bin"
    link.symlink_to("one.bin")
    with AtomicFile(link) as out:
        out.write(b"new")
        out.commit()
    assert link.is_symlink()
    assert (tmp_path / "one.bin").read_bytes() == b"new"


def test_a_link_that_leads_nowhere_is_refused(tmp_path):
    link = tmp_path / "loop.bin"
    link.symlink_to(link)
    with pytest.raises(UsageError, match="exists already"):
        AtomicFile(link)
    assert link.readlink() == link


@pytest.mark.skipif(sys.platform != "linux", reason="/proc is a folder nobody can write to")
def test_folder_that_cannot_be_written_to_is_one_clear_error():
    with pytest.raises(TimemapError, match=r"^cannot write /proc/out\.bin: ") as caught:
        AtomicFile(Path("/proc/out.bin"))
    assert caught.value.exit_code is ExitCode.FAILED


def test_full_disk_is_one_clear_error_and_leaves_nothing(tmp_path):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, before[1]))
    try:
        with AtomicFile(tmp_path / "out.bin") as out:
            out.write(bytes(1 << 17))
            with pytest.raises(TimemapError, match=r"cannot write .*out\.bin: file too large"):
                out.commit()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list(tmp_path.iterdir()) == []


def test_a_disk_without_room_is_one_clear_error_and_leaves_nothing(tmp_path, monkeypatch):
    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = tmp_path / "out.bin"
    path.write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", full)
    with AtomicFile(path, force=True) as out:
        out.write(b"new")
        with pytest.raises(TimemapError, match=r"^cannot write .*out\.bin: no space left on device$"):
            out.commit()
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("out.bin", b"old")]


def test_a_folder_that_vanishes_meanwhile_is_one_clear_error(tmp_path):
    folder = tmp_path / "stick"
    folder.mkdir()
    with AtomicFile(folder / "out.bin") as out:
        out.write(b"abc")
        shutil.rmtree(folder)
        with pytest.raises(TimemapError, match=r"cannot write .*out\.bin: no such file or directory"):
            out.commit()
    assert list(tmp_path.iterdir()) == []


def test_without_force_a_file_that_appears_at_the_very_last_moment_is_kept(tmp_path, monkeypatch):
    path = tmp_path / "out.bin"
    out = AtomicFile(path)
    out.write(b"mine")
    looks = out._refuse_existing

    def too_early():
        looks()
        if not path.exists():
            path.write_bytes(b"somebody else's")

    monkeypatch.setattr(out, "_refuse_existing", too_early)
    with out, pytest.raises(UsageError, match="exists already"):
        out.commit()
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("out.bin", b"somebody else's")]


def test_a_file_system_without_hard_links_will_do(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(os, "link", refused)
    with AtomicFile(tmp_path / "out.bin") as out:
        out.write(b"abc")
        out.commit()
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("out.bin", b"abc")]


def test_a_write_protected_file_is_kept_with_force_too(tmp_path):
    path = tmp_path / "out.bin"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(UsageError, match=r"out\.bin is write-protected"):
        AtomicFile(path, force=True)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("out.bin", b"old")]
