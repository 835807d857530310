import json
import os

from timemap_cli.file_names import json_text, shown

RAW = os.fsdecode(b"m\xff\xfe")


def test_a_byte_that_is_no_utf8_is_shown_as_such():
    assert shown(RAW) == r"m\xff\xfe"
    assert shown("\ud83d") == r"\ud83d"  # half a character, as JSON may hold one


def test_other_names_are_shown_as_they_are():
    assert shown("größe 数 \U0001f600 \\xff") == "größe 数 \U0001f600 \\xff"


def test_json_holds_whole_characters_only():
    text = json_text({"a": [RAW, ("x", {RAW: 1})], "b": None, "c": 1.5, "d": "\U0001f4ff"})
    assert "\\ud" in text  # the two halves of one character
    assert json.loads(text) == {
        "a": [r"m\xff\xfe", ["x", {r"m\xff\xfe": 1}]],
        "b": None,
        "c": 1.5,
        "d": "\U0001f4ff",
    }
    text.encode()
