"""The sample recordings give what their baselines say, and the baselines are what the recordings give."""

from pathlib import Path

import pytest

from tests.cli.program import timemap
from timemap_cli.checking import update
from timemap_cli.config import read_yaml
from timemap_cli.results.container import is_result
from timemap_cli.suite import read_suite

HERE = Path(__file__).parent
SUITE = HERE / "suite.yaml"


def test_the_samples_give_the_same_to_the_digest():
    ran = timemap("check", "--suite", SUITE, "--exact", "--jobs", 2)
    assert ran.code == 0, ran.out
    assert ran.out.endswith("\n\n2 checks: 2 passed.\n")


@pytest.mark.parametrize("name", [row["name"] for row in read_yaml(SUITE)["checks"]])
def test_a_baseline_made_anew_has_the_same_bytes(name, tmp_path):
    (one,) = (check for check in read_suite(SUITE, {}, exact=False) if check.name == name)
    anew = type(one)(one.sources, tmp_path / one.baseline.name, name, output=tmp_path / "kept.timemap.mcap")
    assert update(anew).was is None
    assert is_result(anew.output)
    assert anew.baseline.read_bytes() == one.baseline.read_bytes()
