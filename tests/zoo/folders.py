"""Databases, folders and compressed files that are damaged or odd, and what is no recording at all."""

from __future__ import annotations

import gzip
import sqlite3
from pathlib import Path

import zstandard

from tests.logs.recorded import ROS2, StoragePlugin, write_mcap, write_rosbag2
from tests.zoo.making import Animal, cut, drive, mcap, overwritten

PAGE = 4096


def _folder(folder: Path, plugin: StoragePlugin = StoragePlugin.SQLITE3, mode: str = "none") -> Path:
    return write_rosbag2(folder / "run", drive(ROS2), plugin, mode)


def database(folder: Path) -> Path:
    """A lone .db3 of the drive."""
    return _folder(folder).joinpath("run.db3").rename(folder / "run.db3")


def _with_sql(folder: Path, *statements: str) -> Path:
    path = database(folder)
    connection = sqlite3.connect(path)
    for statement in statements:
        connection.execute(statement)
    connection.commit()
    connection.close()
    return path


def _zeroed_page(folder: Path) -> Path:
    """One of the pages with messages is all zeros."""
    path = database(folder)
    return overwritten(path, path.stat().st_size // PAGE * 3 // 4 * PAGE, bytes(PAGE))


def _journal(folder: Path) -> Path:
    path = database(folder)
    path.with_name("run.db3-wal").write_bytes(b"something")
    return path


def _foreign_database(folder: Path) -> Path:
    path = folder / "run.db3"
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE people (name TEXT)")
    connection.commit()
    connection.close()
    return path


def _metadata(folder: Path, text: str | None, plugin: StoragePlugin = StoragePlugin.MCAP) -> Path:
    """The folder with other metadata, or none."""
    path = _folder(folder, plugin)
    (path / "metadata.yaml").unlink()
    if text is not None:
        (path / "metadata.yaml").write_text(text)
    return path


def _announcing_more(folder: Path) -> Path:
    path = _folder(folder, StoragePlugin.MCAP)
    metadata = path / "metadata.yaml"
    text = metadata.read_text()
    assert "message_count: 60" in text
    metadata.write_text(text.replace("message_count: 60", "message_count: 70"))
    return path


def _parts(folder: Path, present: int = 2, *, damaged: bool = False) -> Path:
    """The drive in two files, of which so many are there."""
    path = folder / "run"
    path.mkdir()
    messages = drive(ROS2)
    for number, part in enumerate((messages[:70], messages[70:])[:present]):
        write_mcap(path / f"run_{number}.mcap", part)
    if damaged:
        (path / "run_1.mcap").write_bytes(b"nothing of a recording")
    names = "[run_0.mcap, run_1.mcap]"
    (path / "metadata.yaml").write_text(f"rosbag2_bagfile_information: {{relative_file_paths: {names}}}")
    return path


def _two_recordings(folder: Path) -> Path:
    path = folder / "run"
    path.mkdir()
    for name in ("monday.mcap", "tuesday.mcap"):
        write_mcap(path / name, drive(ROS2))
    return path


def _folder_of_damaged_messages(folder: Path) -> Path:
    """Three of the messages, each packed by itself, are cut short."""
    path = _folder(folder, StoragePlugin.SQLITE3, "message")
    connection = sqlite3.connect(path / "run.db3")
    connection.execute("UPDATE messages SET data = substr(data, 1, 30) WHERE id IN (62, 64, 66)")
    connection.commit()
    connection.close()
    return path


def _written(folder: Path, name: str, content: bytes) -> Path:
    path = folder / name
    path.write_bytes(content)
    return path


def _packed(folder: Path, share: float = 1.0, content: bytes | None = None) -> Path:
    packing = zstandard.ZstdCompressor().compressobj()
    content, packed = mcap(folder).read_bytes() if content is None else content, b""
    for at in range(0, len(content), 1 << 16 if len(content) > 1 << 20 else 1000):
        packed += packing.compress(content[at : at + (1 << 16 if len(content) > 1 << 20 else 1000)])
        packed += packing.flush(zstandard.COMPRESSOBJ_FLUSH_BLOCK)
    packed += packing.flush()
    return _written(folder, "run.mcap.zstd", packed[: int(len(packed) * share)])


def _bomb(folder: Path) -> Path:
    """A recording and 80 MB of zeros behind it, packed to some kilobytes."""
    return _packed(folder, content=mcap(folder).read_bytes() + bytes(80 << 20))


def _made(folder: Path) -> Path:
    path = folder / "run"
    path.mkdir()
    return path


def _result(folder: Path) -> Path:
    return mcap(folder, metadata="timemap")


DEEP = "[" * 5000 + "]" * 5000
OUTSIDE = "rosbag2_bagfile_information: {relative_file_paths: [../../../etc/passwd]}"
OTHER_NAME = "rosbag2_bagfile_information: {relative_file_paths: [before_it_was_renamed.mcap]}"
WHOLE, SOME = 60, range(1, 60)
FOLDERS = (
    Animal("db3_alone", database, "reads it without its folder", 0, "", WHOLE),
    Animal("db3_cut_off", lambda f: cut(database(f), 0.75), "reads what its whole pages hold and says so", 3, "the database is damaged", SOME),
    Animal("db3_with_a_page_of_zeros", _zeroed_page, "reads what the other pages hold and says so", 3, "the database is damaged", SOME),
    Animal("db3_whose_head_is_damaged", lambda f: overwritten(database(f), 16, b"\0\0\0\0"), "says in one sentence that it cannot be read", 1, "its head is damaged"),
    Animal("db3_whose_list_of_tables_is_damaged", lambda f: overwritten(database(f), 100, b"\xff\xff\xff\xff"), "reads what its pages hold and says so", 3, "the database is damaged", WHOLE),
    Animal("db3_of_somebody_else", _foreign_database, "says that it holds no recording", 1, "no topic"),
    Animal("db3_with_a_journal_beside", _journal, "says that the journal is not read", 3, "run.db3-wal are not read", WHOLE),
    Animal("db3_with_text_for_a_message", lambda f: _with_sql(f, "UPDATE messages SET data = 'text' WHERE id = 60"), "reads the messages and says that one is none", 3, "damaged|missing", range(59, 61)),
    Animal("db3_with_text_for_a_time", lambda f: _with_sql(f, "UPDATE messages SET timestamp = 'noon' WHERE id = 60"), "reads the messages and says that one is none", 3, "damaged|missing", range(59, 61)),
    Animal("db3_with_messages_of_no_topic", lambda f: _with_sql(f, "UPDATE messages SET topic_id = 99 WHERE id = 61 OR id = 63"), "reads the other messages and says so", 3, "damaged", range(58, 61)),
    Animal("db3_in_an_unknown_encoding", lambda f: _with_sql(f, "UPDATE topics SET serialization_format = 'avro'"), "names the encoding", 2, "avro"),
    Animal("db3_without_messages", lambda f: _with_sql(f, "DELETE FROM messages"), "says that there are no messages", 2, "there are no messages"),
    Animal("folder_without_metadata", lambda f: _metadata(f, None), "reads the file that is there", 0, "", WHOLE),
    Animal("folder_with_broken_metadata", lambda f: _metadata(f, "rosbag2: ["), "reads the file that is there and says so", 0, "metadata.yaml cannot be read", WHOLE),
    Animal("folder_with_metadata_too_deep", lambda f: _metadata(f, DEEP), "reads the file that is there and says so", 0, "metadata.yaml cannot be read", WHOLE),
    Animal("folder_with_metadata_that_is_a_number", lambda f: _metadata(f, "17"), "reads the file that is there and says so", 0, "metadata.yaml cannot be read", WHOLE),
    Animal("folder_whose_metadata_leads_outside", lambda f: _metadata(f, OUTSIDE), "reads no file outside of the folder", 0, "names other files", WHOLE),
    Animal("folder_whose_file_was_renamed", lambda f: _metadata(f, OTHER_NAME), "reads the file that is there and says so", 0, "names other files", WHOLE),
    Animal("folder_whose_metadata_announces_more", _announcing_more, "says how many messages are missing", 3, "announces 70 messages of /scan, and 60 are there", WHOLE),
    Animal("folder_without_its_second_part", lambda f: _parts(f, 1), "reads the first and says that one is missing", 3, "run_1.mcap is missing", SOME),
    Animal("folder_whose_second_part_is_no_recording", lambda f: _parts(f, damaged=True), "reads the first and says what is wrong with the other", 3, "run_1.mcap cannot be read and is left out", SOME),
    Animal("folder_that_is_empty", _made, "says that it holds no recording", 2, "holds no recording"),
    Animal("folder_of_two_recordings", _two_recordings, "names both", 2, "holds several recordings"),
    Animal("folder_with_messages_that_are_packed_and_damaged", _folder_of_damaged_messages, "counts those it cannot unpack", 3, "3 messages of /scan are damaged", 57, {"undecodable": 3}),
    Animal("zstd_file", _packed, "unpacks and reads it", 0, "", WHOLE),
    Animal("zstd_file_cut_off", lambda f: _packed(f, 0.5), "reads what could be unpacked", 3, "cut off", SOME),
    Animal("zstd_file_of_a_text", lambda f: _packed(f, content=b"some text"), "says that it is no recording", 2, "is not a recording"),
    Animal("zstd_bomb", _bomb, "unpacks no more than a bound", 3, "unpacks to more than", WHOLE),
    Animal("empty_file", lambda f: _written(f, "run.bag", b""), "says that it is empty", 2, "it is empty"),
    Animal("text_file", lambda f: _written(f, "run.bag", b"image: map.pgm\n"), "says what is read", 2, "is not a recording"),
    Animal("gzip_file", lambda f: _written(f, "run.bag.gz", gzip.compress(b"#ROSBAG V2.0\n")), "says what is read", 2, "is not a recording"),
    Animal("zeros", lambda f: _written(f, "run.bag", bytes(10_000)), "says what is read", 2, "is not a recording"),
    Animal("result_of_ours", _result, "says that it is a result", 2, "is a result of timemap"),
)  # fmt: skip
