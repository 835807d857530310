"""Recordings of more files than a process may have open, and what comes of sharing a few handles."""

import resource

import pytest

from tests.logs import recorded
from tests.logs.recorded import ROS1, ROS2
from timemap_cli.errors import TimemapError
from timemap_cli.logs.recordings import Recording, open_recordings
from timemap_cli.logs.shared_handles import MOST_HANDLES, SharedHandles

PARTS = 200
LIMIT = 128


@pytest.fixture
def few_open_files():
    """As under `ulimit -n 128`."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (LIMIT, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


def parts_of_drive(folder, suffix):
    """A drive of as many scans as parts; each part holds a scan, and what was logged with it."""
    store, write = (ROS1, recorded.write_bag) if suffix == "bag" else (ROS2, recorded.write_mcap)
    messages = recorded.drive(store, PARTS)
    folder.mkdir()
    for part in range(PARTS):
        of_part = messages[:6] if part == 0 else messages[1 + 5 * part : 6 + 5 * part]
        write(folder / f"run_{part}.{suffix}", of_part)
    return folder, recorded.drive_rows(store, PARTS)


def read_all(recordings):
    return recorded.rows(
        [one for some in recordings for batches in some.batches(recorded.TOPICS) for one in batches]
    )


@pytest.mark.parametrize("suffix", ["mcap", "bag"])
def test_a_folder_of_more_parts_than_files_may_be_open_is_read(tmp_path, few_open_files, suffix):
    folder, expected = parts_of_drive(tmp_path / "run", suffix)
    with Recording(folder) as recording:
        assert read_all([recording]) == expected
        assert recording.problems == ()


def test_more_recordings_than_files_may_be_open_are_read(tmp_path, few_open_files):
    folder, expected = parts_of_drive(tmp_path / "run", "mcap")
    recordings = open_recordings(sorted(folder.iterdir()))
    try:
        assert read_all(recordings) == expected
    finally:
        for one in recordings:
            one.close()


def test_only_so_many_files_are_open_and_the_one_read_last_is_among_them(tmp_path):
    handles = SharedHandles(2)
    for name in ("a", "b", "c"):
        (tmp_path / name).write_bytes(name.encode() * 9000)
    files = [handles.open(tmp_path / name) for name in ("a", "b", "c")]
    assert len(handles) == 2
    for _ in range(2):  # each goes on where it was
        assert [file.read(4500) for file in files] == [b"a" * 4500, b"b" * 4500, b"c" * 4500]
    assert [file.read() for file in files] == [b"", b"", b""]
    assert [file.seek(-1, 2) for file in files] == [8999, 8999, 8999]
    assert len(handles) == 2
    for file in files:
        file.close()
    assert len(handles) == 0


def test_a_file_that_another_one_took_the_place_of_is_not_read_on(tmp_path):
    handles = SharedHandles(1)
    (tmp_path / "a").write_bytes(b"a" * 9000)
    (tmp_path / "b").write_bytes(b"b")
    file, other = handles.open(tmp_path / "a"), handles.open(tmp_path / "b")
    (tmp_path / "new").write_bytes(b"n" * 9001)
    (tmp_path / "new").replace(tmp_path / "a")
    with pytest.raises(OSError, match="another file took its place"):
        file.read(1)
    file.close()
    other.close()


def test_a_part_that_is_replaced_while_it_is_read_is_one_error(tmp_path, monkeypatch):
    folder, _ = parts_of_drive(tmp_path / "run", "mcap")
    with Recording(folder) as recording:
        last = folder / f"run_{MOST_HANDLES}.mcap"
        recorded.write_mcap(folder / "new", recorded.drive(ROS2, 3))
        (folder / "new").replace(last)
        with pytest.raises(TimemapError, match="another file took its place while it was being read"):
            read_all([recording])


def test_a_file_that_grows_while_it_is_read_is_the_same(tmp_path):
    handles = SharedHandles(1)
    (tmp_path / "a").write_bytes(b"a" * 10)
    (tmp_path / "b").write_bytes(b"b")
    file, other = handles.open(tmp_path / "a"), handles.open(tmp_path / "b")
    with (tmp_path / "a").open("ab") as growing:
        growing.write(b"more")
    assert file.read() == b"a" * 10 + b"more"
    file.close()
    other.close()
