from dataclasses import replace

import numpy as np
import pytest

from tests.checks.making import EVENT, SECOND, rings, snapshot
from timemap_cli import __version__
from timemap_cli.checks.baseline_file import Baseline, dump, read
from timemap_cli.errors import TimemapError, UsageError

UNDONE = replace(EVENT, until_ns=200 * SECOND, adopted=())


def held(baseline):
    """All of it in values that compare."""
    one = baseline.expected
    levels = {name: (r.ranges.tolist(), r.support.tolist(), r.digests) for name, r in one.levels.items()}
    return replace(one, levels={}), levels, dict(baseline.tolerances)


@pytest.fixture
def baseline():
    return Baseline(snapshot(events=(EVENT, UNDONE)), {"ranges.moved": 0.05})


def test_what_is_written_is_read_back(tmp_path, baseline):
    path = tmp_path / "b.yaml"
    path.write_text(dump(baseline))
    assert held(read(path)) == held(baseline)
    assert dump(read(path)) == dump(baseline)


def test_names_with_odd_letters_are_read_back(tmp_path, baseline):
    odd = replace(
        baseline.expected,
        map_frame='m: "a"\u2028\n#',
        inputs=(replace(baseline.expected.inputs[0], name="- é{"),),
    )
    path = tmp_path / "b.yaml"
    path.write_text(dump(Baseline(odd, {})), encoding="utf-8")
    assert read(path).expected.map_frame == odd.map_frame
    assert read(path).expected.inputs == odd.inputs


def test_letters_beyond_16_bits_and_control_letters_are_read_back(tmp_path, baseline):
    name = "\U0001f916 \\ud83d\\ude00 \x7f\x85\x1b.mcap"
    odd = replace(baseline.expected, inputs=(replace(baseline.expected.inputs[0], name=name),))
    path = tmp_path / "b.yaml"
    path.write_text(dump(Baseline(odd, {})), encoding="ascii")
    assert read(path).expected.inputs[0].name == name


@pytest.mark.parametrize("name", ["null", "true", "false"])
def test_a_level_may_have_a_name_that_is_a_word_of_yaml(tmp_path, baseline, name):
    level = replace(baseline.expected, levels={name: baseline.expected.levels["short"]})
    path = tmp_path / "b.yaml"
    path.write_text(dump(Baseline(level, {})))
    assert list(read(path).expected.levels) == [name]


def test_lines_may_end_as_on_windows(tmp_path, baseline):
    path = tmp_path / "b.yaml"
    path.write_bytes(dump(baseline).replace("\n", "\r\n").encode())
    assert held(read(path)) == held(baseline)


def test_a_ring_has_a_line_of_its_own_so_that_a_difference_is_local(baseline):
    ranges = baseline.expected.levels["short"].ranges.copy()
    ranges[1, 7] += 0.05
    other = Baseline(replace(baseline.expected, levels={"short": rings(ranges)}), baseline.tolerances)
    lines = zip(dump(baseline).splitlines(), dump(other).splitlines(), strict=True)
    different = [one for one, two in lines if one != two]
    assert len(different) == 1
    assert different[0].startswith(
        '    1: {digest: "000000000001", known: 360, clear: 0, support: 0.90, ranges: "'
    )


def test_a_node_that_a_level_does_not_know_has_no_line_and_is_unknown(tmp_path, baseline):
    full = baseline.expected.levels["short"]
    ranges = full.ranges.copy()
    ranges[2] = np.nan
    unknown = replace(full, ranges=ranges, digests=(*full.digests[:2], ""), support=np.array([0.9, 0.9, 0.0]))
    path = tmp_path / "b.yaml"
    path.write_text(dump(Baseline(replace(baseline.expected, levels={"short": unknown}), {})))
    assert "    2: {digest" not in path.read_text()
    assert np.isnan(read(path).expected.levels["short"].ranges[2]).all()


def test_a_missing_file_is_told_with_how_to_make_it(tmp_path):
    with pytest.raises(UsageError) as refused:
        read(tmp_path / "b.yaml")
    assert refused.value.hint == "--update-baseline makes it"


def test_another_file_is_no_baseline(tmp_path):
    path = tmp_path / "b.yaml"
    for content in (b"checks: []\n", b"\x89MCAP0\r\n", b"format: timemap.baseline/x\n"):
        path.write_bytes(content)
        with pytest.raises(UsageError, match=r"is not a baseline of the format timemap.baseline/1"):
            read(path)


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_baseline_of_another_version_is_told_with_both(tmp_path, baseline, ending):
    path = tmp_path / "b.yaml"
    text = dump(baseline).replace("baseline/1", "baseline/2").replace('version: "1.0"', 'version: "7.5"')
    path.write_bytes(text.replace("\n", ending).encode())
    with pytest.raises(UsageError) as told:
        read(path)
    assert told.value.message == (
        f"{path} holds timemap.baseline/2 of timemap 7.5; this is timemap {__version__}, which reads timemap.baseline/1"
    )
    assert told.value.hint.startswith("timemap 7.5 reads it; or remove it")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("scans: {read: 1000", "scans: {reed: 1000", "is damaged: scans.read is missing"),
        ("    1: {digest", "    7: {digest", "is damaged: there is no node 7"),
        ('ranges: "', 'ranges: "?1 ', "is damaged: 361 angle bins instead of 360"),
        ("events:\n-", "events:\n- {", "is damaged: "),
        ("angle_bins: 360", "angle_bins: .inf", "is damaged: angle_bins is out of all range"),
        (
            "angle_bins: 360",
            "angle_bins: 1000000000",
            "is damaged: angle_bins is not a whole number from 1 to",
        ),
        ("0: {x: 1.0", "0: {x: .nan", "is damaged: nodes.0.x is out of all range"),
        ("    1: {digest", "    0.5: {digest", "is damaged: levels.short.0.5 is not a whole number"),
        ('ranges: "', 'ranges: "?9999999 ?9999999 ', "angle bins instead of 360"),
        (
            'ranges: "',
            'ranges: "99999999999999999999 ',
            "is damaged: '99999999999999999999' is no part of a ring",
        ),
        ('ranges: "', 'ranges: "1 C ', "is damaged: 'C' counts below zero"),
        ('name: "monday.mcap"', "name: 5", r"is damaged: inputs\[0\].name is not a text: 5"),
        ("hit: 0.99", "hit: many", "is damaged: beams./scan.hit is not a number: many"),
        ('kind: "appeared"', "kind: 1", r"is damaged: events\[0\].kind is not a text: 1"),
        ('since: "1970-01-01T00:01:40Z"', 'since: "soon"', "is damaged: 'soon' is not a time"),
        ("  map.radius: 10.0", "  7: 10.0", "is damaged: settings.7 is not a name"),
        ("map_frame:", 'odd: !!int ""\nmap_frame:', "is damaged: "),
        ("map_frame:", f"odd: {'[' * 2000}\nmap_frame:", "is damaged: it is nested too deeply"),
        ("tolerances:\n", "tolerance:\n", "is damaged: tolerances is missing"),
    ],
)
def test_a_damaged_baseline_is_told(tmp_path, baseline, old, new, message):
    text = dump(baseline)
    assert old in text
    path = tmp_path / "b.yaml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(TimemapError, match=message):
        read(path)


def test_a_damaged_baseline_is_told_with_what_mends_it(tmp_path, baseline):
    path = tmp_path / "b.yaml"
    path.write_text(dump(baseline)[:-9])
    with pytest.raises(TimemapError) as told:
        read(path)
    assert told.value.hint == "remove it, or name another file: --update-baseline makes it anew then"


def test_a_tolerance_that_no_number_can_hold_is_refused(tmp_path, baseline):
    path = tmp_path / "b.yaml"
    path.write_text(dump(baseline).replace("ranges.moved: 0.05", f"ranges.moved: {10**400}"))
    with pytest.raises(UsageError, match=r"tolerance ranges.moved in .* is not a number from 0 on"):
        read(path)


def test_an_unknown_tolerance_in_the_file_is_refused(tmp_path, baseline):
    path = tmp_path / "b.yaml"
    path.write_text(dump(baseline).replace("ranges.moved: 0.05", "ranges.mooved: 0.05"))
    with pytest.raises(UsageError, match=r"unknown tolerance ranges.mooved"):
        read(path)
