"""`check` and its fellows on results from somebody who wishes us ill: sound containers with anything in them."""

import json
import struct
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from tests.cli.program import timemap
from tests.cli.result_files import all_levels, write
from tests.limits import ended
from tests.results.rewriting import rewritten
from tests.test_hostile_yaml import ALIASES, MERGES
from timemap_cli.results import channels

REPORT = {"schema": "timemap.report/1", "nodes": 1, "scans": {"read": 1, "used": 1, "dropped": {}}}
DEEP = "[" * 100_000
SETTINGS = {
    "a list": "- seed\n",
    "a scalar": "17\n",
    "nothing": "",
    "deep": f"map: {DEEP}",
    "aliases": ALIASES,
    "merges": MERGES,
    "no YAML": "map: {radius: [}\n",
    "levels without names": "levels: [{window: 5}]\n",
    "levels that are a number": "levels: 5\n",
    "levels that are texts": "levels: [short, long]\n",
    "levels that are nothing": "levels:\n",
    "levels somewhere else": "map: {levels: {a: 1}}\n",
    "a level whose name is a list": "levels: [{name: [a]}]\n",
    "a level whose name breaks a baseline": 'levels: [{name: "a: 1\\nevents"}]\n',
    "a name that breaks a baseline": '"seed: 1\\nformat": 2\n',
    "a number as name": "5: 1\n",
    "a number of many digits": f"seed: {'9' * 100_000}\n",
    "many values": f"seed: [{'a, ' * 200_000}a]\n",
}
REPORTS = {
    "beams that are nothing": REPORT | {"beams": None},
    "beams that are a list": REPORT | {"beams": [1]},
    "beams of a topic that are nothing": REPORT | {"beams": {"/scan": None}},
    "beams that are a text": REPORT | {"beams": {"/scan": {"hit": "all"}}},
    "beams of a kind that breaks a baseline": REPORT | {"beams": {"/scan": {"a: 1}\nb": 0.5}}},
    "no return that is a list": REPORT | {"no_return": [[]]},
    "no scans": {"schema": "timemap.report/1", "nodes": 1},
    "another version": {"schema": "timemap.report/99"},
}
METADATA = {
    "scans read that are a text": {"scans_read": "many"},
    "scans read of many digits": {"scans_read": "9" * 100_000},
    "scans used below zero": {"scans_used": "-5"},
    "scans dropped that are cut": {"scans_dropped": "{"},
    "scans dropped that are a list": {"scans_dropped": "[1]"},
    "scans dropped that are texts": {"scans_dropped": '{"lost": "all"}'},
    "scans dropped for a reason that breaks a baseline": {"scans_dropped": '{"a: 1}\\nb": 3}'},
    "scans dropped deep": {"scans_dropped": DEEP},
    "inputs without a name": {"inputs": '[{"sha256": "0"}]'},
    "inputs that are a number": {"inputs": "5"},
    "many levels": {"levels": ",".join(f"a{i}" for i in range(100_000))},
    "a long name": {"levels": "a" * 1_000_000},
    "no format": {"format": "9" * 100_000},
    "another format": {"format": "timemap.result/99", "version": "9" * 100_000},
}


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    result = write(folder / "r.timemap.mcap", [(0, all_levels(False)), (10, all_levels(True))])
    assert timemap("check", result, "--baseline", folder / "b.yaml", "--update-baseline").code == 0
    return result


@pytest.fixture(scope="module")
def hostile(sound, tmp_path_factory):
    """The results by what is wrong in them."""
    folder = tmp_path_factory.mktemp("hostile")
    made: dict[str, Path] = {}

    def make(name, **changes):
        made[name] = rewritten(sound, folder / f"{len(made)}.timemap.mcap", **changes)

    for name, text in SETTINGS.items():
        make(f"settings: {name}", attachments={channels.CONFIG: text.encode()})
    for name, report in REPORTS.items():
        make(f"report: {name}", attachments={channels.REPORT: json.dumps(report).encode()})
    make("report: deep", attachments={channels.REPORT: DEEP.encode()})
    for name, metadata in METADATA.items():
        make(f"metadata: {name}", metadata=metadata)
    made["one chunk, listed often"] = listed_often(sound, folder / "often.timemap.mcap")
    made["a chunk in the summary"] = chunk_in_summary(sound, folder / "summary.timemap.mcap")
    return made


def listed_often(source, target):
    """Lists its chunks ten thousand times."""
    with source.open("rb") as file, target.open("wb") as out:
        reader = make_reader(file)
        writer = Writer(out, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="an attacker")
        summary = reader.get_summary()
        for schema in summary.schemas.values():
            writer.register_schema(schema.name, schema.encoding, schema.data)
        for channel in summary.channels.values():
            writer.register_channel(
                channel.topic, channel.message_encoding, channel.schema_id, channel.metadata
            )
        for _, channel, message in reader.iter_messages():
            writer.add_message(channel.id, message.log_time, message.data, message.publish_time)
        for one in reader.iter_attachments():
            writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, record.metadata)
        writer._Writer__finalize_chunk()
        writer._Writer__chunk_indices *= 10_000
        writer.finish()
    return target


def chunk_in_summary(source, target):
    """Its summary begins where its first chunk stands."""
    raw = bytearray(source.read_bytes())
    with source.open("rb") as file:
        first = min(index.chunk_start_offset for index in make_reader(file).get_summary().chunk_indexes)
    struct.pack_into("<Q", raw, len(raw) - 8 - 20, first)
    target.write_bytes(raw)
    return target


def test_a_check_of_a_hostile_result_ends_in_one_error_in_little_time_and_memory(sound, hostile):
    baseline = sound.with_name("b.yaml")
    told = ended(["check", path, "--baseline", baseline] for path in hostile.values())
    assert not {name: one for name, one in zip(hostile, told, strict=True) if not one.is_one_error()}
    assert len(hostile) >= 27


def test_nothing_else_that_reads_a_hostile_result_fails_otherwise(sound, hostile, tmp_path):
    recording, baseline = sound.parent / "none.mcap", tmp_path / "new.yaml"
    for command in (
        ["changes"],
        ["diff", "--level", "long", "mid"],
        ["info"],
        ["report", "-o", tmp_path / "page.html", "--force"],
        ["check", "--baseline", baseline, "--update-baseline"],
        ["replay", recording, "-o", tmp_path / "out.timemap.mcap", "--resume"],
        ["replay", recording, "-o", tmp_path / "out.timemap.mcap", "--nodes"],
    ):
        told = dict(zip(hostile, ended([*command, path] for path in hostile.values()), strict=True))
        assert not {name: one for name, one in told.items() if one.code != 0 and not one.is_one_error()}
    assert not baseline.exists()


def test_a_suite_of_hostile_results_tells_the_others(sound, hostile, tmp_path, monkeypatch):
    rows = [{"name": f"{i}", "result": str(path), "baseline": str(sound.with_name("b.yaml"))}
            for i, path in enumerate([sound, *hostile.values(), sound])]  # fmt: skip
    (tmp_path / "s.yaml").write_text(json.dumps({"checks": rows}))
    ran = timemap("check", "--suite", tmp_path / "s.yaml", "--format", "json")
    outcomes = [one["outcome"] for one in json.loads(ran.out)["checks"]]
    assert outcomes == ["passed", *["error"] * len(hostile), "passed"]
