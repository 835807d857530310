"""Which files metadata.yaml names, whoever wrote it."""

import os
import time

import pytest
from rosbags.rosbag2 import Writer

from timemap_cli.errors import TimemapError
from timemap_cli.logs.listed_names import listed_names
from timemap_cli.logs.recordings import Recording

MERGES = "a0: &a0 {k: v}\n" + "".join(
    f"a{i}: &a{i} {{<<: [{', '.join([f'*a{i - 1}'] * 10)}]}}\n" for i in range(1, 10)
)
FILES = "rosbag2_bagfile_information:\n  relative_file_paths:\n"


def names(tmp_path, text):
    path = tmp_path / "metadata.yaml"
    path.write_text(text, encoding="utf-8")
    return listed_names(path)


def test_the_names_of_all_parts_are_found_in_what_rosbag2_writes(tmp_path):
    with Writer(tmp_path / "bag", version=9) as writer:
        writer.add_connection("/chatter", "std_msgs/msg/String", msgdef="string data", rihs01="RIHS01_0")
    assert listed_names(tmp_path / "bag" / "metadata.yaml") == ["bag.db3"]
    assert names(tmp_path, FILES + "    - a_0.db3\n    - a_1.db3\n  files: []\n") == ["a_0.db3", "a_1.db3"]


@pytest.mark.parametrize("path", ["../../etc/passwd", "/etc/passwd", "sub/passwd", "./passwd", "../passwd"])
def test_no_name_leads_out_of_the_folder(tmp_path, path):
    assert names(tmp_path, f"{FILES}    - {path}\n") == ["passwd"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "- a\n",
        "rosbag2_bagfile_information: [a.db3]\n",
        "rosbag2_bagfile_information: {relative_file_paths: a.db3}\n",
        "other: {relative_file_paths: [a.db3]}\n",
        "a: {rosbag2_bagfile_information: {relative_file_paths: [a.db3]}}\n",
        "rosbag2_bagfile_information: {relative_file_paths: [a.db3\n",
        "[" * 100_000,
        "\n".join(" " * depth + "a:" for depth in range(1000)),
        "a: b: c",
        "\x00",
        MERGES,
    ],
)
def test_what_names_no_files_is_an_error_at_once(tmp_path, text):
    began = time.perf_counter()
    with pytest.raises(ValueError):  # noqa: PT011 - whatever the reason
        names(tmp_path, text)
    assert time.perf_counter() - began < 5


@pytest.mark.parametrize(
    "before",
    [MERGES, "day: 2024-99-99\n", f"number: {'9' * 10_000}\n", "tag: !!python/object:os.system {}\n"],
)
def test_nothing_is_made_of_what_stands_around_the_list(tmp_path, before):
    assert names(tmp_path, f"{before}{FILES}    - a.db3\n") == ["a.db3"]


def test_keys_that_are_lists_or_aliases_do_not_disturb(tmp_path):
    text = "x: &x y\n? [relative_file_paths]\n: *x\n*x : [1, {a: b}]\n" + FILES + "    - a.db3\n"
    assert names(tmp_path, text) == ["a.db3"]


@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_a_name_that_is_no_file_is_missing_and_nothing_waits_for_it(tmp_path, kind):
    if kind == "pipe":
        os.mkfifo(tmp_path / "a.db3")
    else:
        (tmp_path / "a.db3").symlink_to("/dev/zero")
    (tmp_path / "metadata.yaml").write_text(f"{FILES}    - a.db3\n")
    with pytest.raises(TimemapError, match=r"holds none of the files that its metadata\.yaml names"):
        Recording(tmp_path)
