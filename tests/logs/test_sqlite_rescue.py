"""Rows picked from the pages of a database are those that SQLite gives."""

from __future__ import annotations

import sqlite3

import pytest

from tests.logs import recorded
from tests.logs.recorded import ROS2, TOPICS, StoragePlugin
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.sqlite_file import SqliteFile
from timemap_cli.logs.sqlite_pages import Pages
from timemap_cli.logs.sqlite_rescue import Rescue

EVER = (-(2**63), 2**63 - 1, (-(2**63), 0))


@pytest.fixture
def database(tmp_path):
    folder = recorded.write_rosbag2(tmp_path / "run", recorded.drive(ROS2, 100), StoragePlugin.SQLITE3)
    return folder / "run.db3"


def test_an_undamaged_database_gives_what_sqlite_gives(database):
    rescue = Rescue(database)
    rows = sqlite3.connect(database).execute(
        "SELECT id, topic_id, timestamp, data FROM messages ORDER BY timestamp, id"
    )
    keys = {one.id for one in rescue.connections}
    assert list(rescue.messages(keys, *EVER)) == list(rows)
    assert rescue.connections == SqliteFile(database).connections
    assert rescue.missing == 0
    rescue.close()


@pytest.mark.parametrize("length", [10, 400, 4050, 4061, 4062, 5000, 8200, 100_000])
@pytest.mark.parametrize("page", [512, 4096, 65536])
def test_rows_that_go_on_on_other_pages_are_whole(tmp_path, length, page):
    path = tmp_path / "some.db3"
    connection = sqlite3.connect(path)
    connection.execute(f"PRAGMA page_size = {page}")
    connection.execute("CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id, timestamp, data BLOB)")
    content = bytes(i * 7 % 256 for i in range(length))
    connection.execute("INSERT INTO messages VALUES (300, 2, 1700000000000000000, ?)", (content,))
    connection.commit()
    connection.close()
    with path.open("rb") as file:
        pages = Pages(file)
        (row,) = [row for row in pages.rows() if row.rowid == 300]
        assert row.values[:3] == (None, 2, 1700000000000000000)
        assert pages.last_column(row.page, row.place) == content


def test_numbers_of_all_sizes_are_read(tmp_path):
    path = tmp_path / "some.db3"
    values = [0, 1, -1, 127, -128, 32767, -(2**23), 2**31 - 1, 2**47 - 1, -(2**47), 2**63 - 1, -(2**63)]
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE numbers (a, b)")
    connection.executemany("INSERT INTO numbers VALUES (?, 5)", [(value,) for value in values])
    connection.commit()
    connection.close()
    with path.open("rb") as file:
        found = [row.values[0] for row in Pages(file).rows() if len(row.values) == 2]
    assert sorted(found) == sorted(values)


def test_every_cut_gives_a_part_of_the_messages_or_an_error(database):
    content = database.read_bytes()
    with Recording(database) as whole:
        expected = recorded.rows([one for batches in whole.batches(TOPICS) for one in batches])
    counts = []
    for share in (0.99, 0.8, 0.6):
        database.write_bytes(content[: int(len(content) * share)])
        with Recording(database) as recording:
            found = recorded.rows([one for batches in recording.batches(TOPICS) for one in batches])
            assert "the database is damaged; what its whole pages hold is read" in recording.problems[0]
        assert all(set(found[key]) <= set(expected[key]) for key in found)
        counts.append(sum(map(len, found.values())))
    assert sum(map(len, expected.values())) > counts[0] > counts[1] > counts[2] > 50


def test_a_database_without_a_topic_is_refused(tmp_path):
    path = tmp_path / "some.db3"
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE people (name TEXT)")
    connection.commit()
    connection.close()
    with pytest.raises(ValueError, match="no topic is left in it"):
        Rescue(path)
