"""Bad and odd recordings: what a replay of each says, uses and returns."""

from __future__ import annotations

import json
import re
import tracemalloc

import numpy as np
import pytest

from tests.cli.program import timemap
from tests.zoo.bags import BAGS
from tests.zoo.folders import FOLDERS
from tests.zoo.making import Animal, mcap
from tests.zoo.mcaps import MCAPS
from tests.zoo.messages import LEGAL, MESSAGES
from timemap_cli.results.reader import ResultReader

ZOO = (*BAGS, *MCAPS, *FOLDERS, *MESSAGES, *LEGAL)
CLAIMS = [one for one in (*BAGS, *MCAPS, *FOLDERS) if re.search("claims|bomb", one.name)]


def named(animals):
    return pytest.mark.parametrize("animal", animals, ids=lambda animal: animal.name)


def replayed(folder, log):
    return timemap("replay", log, "-o", folder / "result.mcap", "--json")


@named(ZOO)
def test_a_good_tool(animal: Animal, tmp_path):
    (tmp_path / "log").mkdir()
    log = animal.make(tmp_path / "log")
    told = timemap("info", log)
    assert told.code in ((0,) if animal.code in (0, 3) else (0, 1, 2)), told.err
    assert "Traceback" not in told.err
    ran = replayed(tmp_path, log)
    assert ran.code == animal.code, ran.err
    assert re.search(animal.said, ran.err), ran.err
    assert "Traceback" not in ran.err
    if animal.used is None:
        assert ran.out == ""
        assert ran.err.count("error: ") == 1
        assert not (tmp_path / "result.mcap").exists()
    else:
        scans = json.loads(ran.out)["scans"]
        used = animal.used if isinstance(animal.used, range) else (animal.used,)
        assert scans["used"] in used
        assert scans["dropped"] == animal.dropped


@named(CLAIMS)
def test_what_is_claimed_takes_no_memory(animal: Animal, tmp_path):
    log = animal.make(tmp_path)
    tracemalloc.start()
    timemap("info", log)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 80 << 20


def estimates(path):
    with ResultReader(path) as reader:
        return {
            (level, number): one.ranges
            for level in reader.levels
            for number, one in reader.estimates(level).items()
        }


@named(LEGAL)
def test_what_is_unusual_and_legal_gives_the_same_map(animal: Animal, tmp_path):
    for name in ("plain", "odd"):
        (tmp_path / name).mkdir()
    replayed(tmp_path / "plain", mcap(tmp_path / "plain"))
    replayed(tmp_path / "odd", animal.make(tmp_path / "odd"))
    plain, odd = (estimates(tmp_path / name / "result.mcap") for name in ("plain", "odd"))
    assert plain.keys() == odd.keys()
    for key in plain:
        # Beams on the border of two angle bins fall to either side.
        np.testing.assert_array_equal(np.isnan(plain[key]), np.isnan(odd[key]))
        np.testing.assert_allclose(plain[key], odd[key], atol=0.05)


def test_the_zoo_is_large_and_every_animal_has_its_own_name():
    assert len(ZOO) >= 60
    assert len({one.name for one in ZOO}) == len(ZOO)


@pytest.fixture(autouse=True)
def one_process(monkeypatch):
    monkeypatch.setattr("timemap_cli.second_process._usable_processors", lambda: {0})
