"""Results from somebody who wishes us ill: sound containers with anything in them. One clear error, or an answer."""

import json
import math
import struct

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import START, all_levels, write
from tests.results.rewriting import rewritten
from timemap_cli.errors import TimemapError
from timemap_cli.reports.page_data import page_data
from timemap_cli.results import channels
from timemap_cli.results.layouts import scan_layout, status_layout
from timemap_cli.results.reader import ResultReader

FRAME = len("timemap/node_0000") + 1
SCAN, STATUS = "/timemap/long/scan", "/timemap/long/status"
EVENT = {
    "id": 0,
    "kind": "appeared",
    "x": 1.0,
    "y": 2.0,
    "bounds": [0, 1, 2, 3],
    "outline": [[0, 1], [2, 1], [2, 3]],
    "support": 0.5,
    "moved_from": None,
    "nodes": [0],
    "against": [],
    "first_seen_ns": str(START),
    "last_seen_ns": str(START),
    "looked_ns": str(START),
    "closed_ns": None,
    "not_seen_since": False,
    "adopted": {"short": str(START), "mid": None, "long": None},
    "recurring": False,
    "episodes": [{"since_ns": str(START), "until_ns": None}],
    "toggles": 0,
    "looks": 1,
    "share_held": 1.0,
}


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return write(
        tmp_path_factory.mktemp("sound") / "r.mcap",
        [(0, all_levels(False)), (10, all_levels(True)), (20, all_levels(False))],
    )


def document(**fields):
    events = [EVENT | fields]
    return json.dumps({"schema": "timemap.changes/1", "events": events, "summary": {"open": 1}}).encode()


def put(place, form, value):
    def change(message):
        changed = bytearray(message)
        struct.pack_into(form, changed, place, value)
        return bytes(changed)

    return change


def answers(path):
    """Exit code and error of each way to read the result; a traceback would fail the test."""
    told = [
        timemap("changes", path),
        timemap("changes", path, "--json"),
        timemap("changes", path, "--csv", "--since", "+1s"),
        timemap("diff", path, "--level", "long", "mid", "--json"),
    ]
    for one in told:
        assert not any(ord(sign) < 32 and sign not in "\n\t" for sign in one.out + one.err)
    try:
        with ResultReader(path) as reader:
            json.dumps(page_data(reader), allow_nan=False)
        return [*((one.code, one.err) for one in told), (0, "")]
    except TimemapError as error:
        return [*((one.code, one.err) for one in told), (int(error.exit_code), error.message)]


def is_damaged(path):
    return any(code == 1 and "is damaged" in said for code, said in answers(path))


def test_the_sound_result_is_read_whole(sound, tmp_path):
    path = rewritten(sound, tmp_path / "r.mcap", attachments={channels.CHANGES: document()})
    assert [code for code, _ in answers(path)] == [0] * 5


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("levels", "a\x1b[31m,b"),
        ("levels", "<script>alert(1)</script>"),
        ("levels", "short,short"),
        ("levels", ""),
        ("angle_bins", "0"),
        ("angle_bins", "999999999999"),
        ("angle_bins", "9" * 5000),
        ("radius", "nan"),
        ("radius", "-1"),
        ("radius", "1e308"),
        ("nodes", "999999999"),
        ("inputs", "[["),
        ("inputs", "[" * 100_000),
        ("inputs", '[{"name": 5, "sha256": ""}]'),
    ],
)
def test_descriptions_that_no_replay_writes_are_damage(sound, tmp_path, name, value):
    assert is_damaged(rewritten(sound, tmp_path / "r.mcap", metadata={name: value}))


@pytest.mark.parametrize("field", EVENT)
@pytest.mark.parametrize(
    "value", ["<img src=x onerror=alert(1)>\x1b[2J", -1.5, math.nan, math.inf, [["a"]], {"a": 1}]
)
def test_events_that_no_replay_writes_are_damage(sound, tmp_path, field, value):
    places = ("x", "y")
    path = rewritten(sound, tmp_path / "r.mcap", attachments={channels.CHANGES: document(**{field: value})})
    if field in places and value == -1.5:
        assert not is_damaged(path)
    else:
        assert timemap("changes", path).code == 1
        assert "is damaged" in timemap("changes", path, "--json").err


@pytest.mark.parametrize(
    "fields",
    [
        {"nodes": [1]},  # there is one node, number 0
        {"adopted": {"<b>": None}},
        {"first_seen_ns": "9" * 5000},
        {"closed_ns": str(2**63)},
        {"episodes": []},
        {"outline": []},
        {"support": 1.1},
        {"id": 2**70},
    ],
)
def test_values_beyond_what_can_be_are_damage(sound, tmp_path, fields):
    assert is_damaged(
        rewritten(sound, tmp_path / "r.mcap", attachments={channels.CHANGES: document(**fields)})
    )


@pytest.mark.parametrize(
    "text", [b"{", b"[]", b"null", b"[" * 100_000, b"\xff", b"1" + b"0" * 10_000, b"NaN"]
)
@pytest.mark.parametrize("name", [channels.CHANGES, channels.REPORT])
def test_documents_that_are_none_are_damage(sound, tmp_path, name, text):
    assert is_damaged(rewritten(sound, tmp_path / "r.mcap", attachments={name: text}))


@pytest.mark.parametrize(
    "messages",
    [
        {SCAN: put(scan_layout(360, FRAME).fields["ranges"][1], "<f", -1.0)},
        {SCAN: put(scan_layout(360, FRAME).fields["ranges"][1], "<f", 3e38)},
        {SCAN: put(scan_layout(360, FRAME).fields["ranges"][1], "<f", -math.inf)},
        {SCAN: put(scan_layout(360, FRAME).fields["intensities"][1], "<f", math.nan)},
        {STATUS: put(status_layout(360, FRAME).fields["known"][1], "<f", 2.0)},
        {SCAN: put(12, "<I", 2**32 - 1)},  # length of the frame's name
        {SCAN: lambda message: b""},
        {STATUS: lambda message: message[:40]},
        {topic: lambda message: message.replace(b"_0000", b"_0007") for topic in (SCAN, STATUS)},
        {channels.TF_STATIC: put(4, "<I", 2**32 - 1)},
        {
            channels.TF_STATIC: lambda message: message.replace(
                struct.pack("<d", 1.0), struct.pack("<d", math.nan)
            )
        },
        {
            channels.TF_STATIC: lambda message: message.replace(
                struct.pack("<d", 1.0), struct.pack("<d", 1e300)
            )
        },
    ],
)
def test_messages_that_no_replay_writes_are_damage(sound, tmp_path, messages):
    assert is_damaged(rewritten(sound, tmp_path / "r.mcap", messages=messages))


@pytest.mark.parametrize("without", [STATUS, channels.TF_STATIC, channels.CHANGES, channels.CONFIG])
def test_what_is_missing_is_damage(sound, tmp_path, without):
    assert is_damaged(rewritten(sound, tmp_path / "r.mcap", without=(without,)))


def test_a_chunk_that_claims_to_unpack_to_more_than_any_replay_writes_is_damage(sound, monkeypatch):
    monkeypatch.setattr("timemap_cli.results.container._MOST_BYTES", 1000)
    told = timemap("diff", sound, "--level", "long", "mid")
    assert (told.code, told.err.splitlines()[0]) == (
        1,
        f"error: {sound} is damaged: its records do not fit together",
    )
