"""YAML from somebody who wishes us ill, wherever YAML is read: one error, soon, in little memory."""

import ast

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import all_levels, write
from tests.conftest import ROOT
from tests.limits import ended
from timemap_cli.plain_yaml import YamlError, plain_values

ALIASES = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 10)
)
MERGES = "a0: &a0 {k: v}\n" + "".join(
    f"a{i}: &a{i} {{<<: [{', '.join([f'*a{i - 1}'] * 10)}]}}\n" for i in range(1, 10)
)
HOSTILE = {
    "aliases": ALIASES,
    "merges": MERGES,
    "an alias of itself": "seed: &a [*a]\n",
    "an alias as key": "a: &a [x]\n*a : 1\n",
    "a merge key without alias": "seed: {<<: {a: 1}}\n",
    "deep lists": "seed: " + "[" * 20_000,
    "deep mappings": "seed: " + "{a: " * 20_000,
    "deep dashes": "- " * 20_000,
    "deep keys": "? " * 20_000,
    "deep by indentation": "\n".join(" " * depth + "a:" for depth in range(600)),
    "a whole number": f"seed: {'9' * 100_000}\n",
    "a number in base 16": f"seed: 0x{'f' * 100_000}\n",
    "a number in base 60": f"%YAML 1.1\n---\nseed: {':'.join(['59'] * 30_000)}\n",
    "an object": "seed: !!python/object/apply:os.system [ls]\n",
    "bytes": f"seed: !!binary {'A' * 100_000}\n",
    "a long key": f"{'k' * 150_000}: 1\n",
    "a long text": f"seed: '{'v' * 150_000}'\n",
    "a long text in words": f"seed: {'v ' * 50_000}\n",
    "many values": f"seed: [{'a, ' * 1_000_000}a]\n",
    "many values in little": f"seed: [{'a, ' * 60_000}a]\n",
    "many lines": "- a\n" * 1_000_000,
    "a long comment": "# nothing\n" * 2_000_000,
    "a second document": "--- {}\n" * 20_000,
    "no such day": "seed: 2024-99-99\nmap: 2024-99-99T99:99:99Z\n",
    "a list as key": "? [a, b]\n: 1\n",
    "letters that rule terminals": 'seed: "\\e[2J\\0\\u202e"\n"\\e]0;x\\a": 1\n',
}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return write(tmp_path_factory.mktemp("sound") / "r.timemap.mcap", [(0, all_levels(box=False))])


def nested(text):
    """The text below a key, where its lines allow that."""
    return "".join(f"  {line}\n" for line in text.splitlines())


@pytest.mark.parametrize("place", ["settings", "suite", "baseline"])
def test_hostile_yaml_ends_in_one_error_in_little_time_and_memory(tmp_path, result, place):
    calls = []
    for number, text in enumerate(HOSTILE.values()):
        path = tmp_path / f"{number}.yaml"
        if place == "settings":
            path.write_text(text)
            calls.append(["info", ROOT / "sample_logs/patrol_tuesday.bag", "--config", path])
        elif place == "suite":
            path.write_text(text)
            calls.append(["check", "--suite", path])
        else:
            path.write_text(f"format: timemap.baseline/1\nversion: '0.1.0'\nsettings:\n{nested(text)}")
            calls.append(["check", result, "--baseline", path])
    sparse = tmp_path / "sparse.yaml"
    with sparse.open("wb") as file:
        file.write(b"format: timemap.baseline/1\n")
        file.truncate(3 << 30)
    calls.append([*calls[-1][:-1], sparse])
    told = dict(zip([*HOSTILE, "three gigabytes of nothing"], ended(calls), strict=True))
    assert not {name: one for name, one in told.items() if not one.is_one_error()}
    assert len(told) >= 20


def test_rings_and_levels_of_a_baseline_take_no_memory_that_its_text_does_not_back(tmp_path, result):
    timemap("check", result, "--baseline", tmp_path / "b.yaml", "--update-baseline")
    text = (tmp_path / "b.yaml").read_text()
    nodes = "".join(f"  {i}: {{x: {i}, y: 0}}\n" for i in range(300))
    many = text.replace("  0: {x: 1.0, y: 2.0}\n", nodes).replace("angle_bins: 360", "angle_bins: 3600")
    hostile = {
        "levels": many.replace("levels:\n", "levels:\n" + "".join(f"  a{i}:\n" for i in range(2000))),
        "a ring": text.replace('ranges: "', f'ranges: "{"?9999999 " * 1000}'),
    }
    for name, content in hostile.items():
        (tmp_path / f"{name}.yaml").write_text(content)
    told = ended(["check", result, "--baseline", tmp_path / f"{name}.yaml"] for name in hostile)
    assert all(one.is_one_error() for one in told), told


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", None),
        ("# nothing\n", None),
        ("a: 1\nb: -2\nc: +3\nd: 1_000\ne: 0x1F\nf: 0o17\n", {"a": 1, "b": -2, "c": 3, "d": 1000, "e": 31, "f": 15}),
        ("[0.5, .5, 1., 1e3, -2.5E-1, .inf, -.inf]", [0.5, 0.5, 1.0, 1000.0, -0.25, float("inf"), -float("inf")]),
        ("[true, False, null, ~, Null, yes, on, n]", [True, False, None, None, None, "yes", "on", "n"]),
        ("['1', \"true\", 2024-03-04, 50obs, 1:30, 0.5s, -, +, ., /scan]",
         ["1", "true", "2024-03-04", "50obs", "1:30", "0.5s", "-", "+", ".", "/scan"]),
        ("a:\n- {b: [1, 2], c: {}}\n- d: |\n    x\n    y\n", {"a": [{"b": [1, 2], "c": {}}, {"d": "x\ny\n"}]}),
        ("%YAML 1.1\n--- {a: 010, b: }\n", {"a": 10, "b": None}),
        ("&named a: &other 1\n", {"a": 1}),
        ('"<<": 1\n', {"<<": 1}),
    ],
)  # fmt: skip
def test_scalars_lists_and_mappings_are_those_of_yaml_1_2(text, value):
    assert plain_values(text) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: &a 1\nb: *a\n", r"^holds an alias \(\*\) in line 2: write out what it stands for$"),
        ("b:\n  <<: {a: 1}\n", r"^holds a merge key in line 2: "),
        ("a: !x 1\n", r"line 1: it has a tag"),
        ("a: 1\na: 2\n", r"^is not YAML: line 2: the key a stands there twice$"),
        ("? {a: 1}\n: 2\n", r"line 1: a key is a list or a mapping$"),
        ("a: 1\n---\nb: 2\n", r"line 2: a second document begins$"),
        ("[" * 21, "^is nested too deeply$"),
        (f"[{'1' * 1001}]", "^holds a number of 1001 digits in line 1$"),
        ("x" * 200_001, "^is larger than 200 kB$"),
        (f"[{'1,' * 10_000}]", "^holds more than 10000 values, keys and brackets$"),
    ],
)
def test_what_is_not_read_is_told_with_its_line(text, message):
    with pytest.raises(YamlError, match=message):
        plain_values(text)


def test_twenty_levels_are_read():
    assert plain_values("[" * 20 + "]" * 20)


def test_yaml_is_read_in_one_place():
    importing = [
        path.name
        for path in (ROOT / "timemap_cli").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if (isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("ruamel", "yaml")))
        or (
            isinstance(node, ast.Import)
            and any(one.name.startswith(("ruamel", "yaml")) for one in node.names)
        )
    ]
    assert set(importing) == {"plain_yaml.py"}
