"""Two objects that were really taken away from a corridor between two drives."""

import csv
import json
from math import hypot

import pytest

from tests.cli.program import timemap
from tests.conftest import shared_data

END_OF_FIRST_DRIVE = "2002-12-31T02:02:15Z"
MOST_OTHER_CHANGES = 8  # doors and chairs, told apart on a raster of both drives


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """The three drives in one result."""
    logs = [shared_data(f"wean/wean_run{run}.mcap") for run in (1, 3, 4)]
    path = tmp_path_factory.mktemp("corridor") / "corridor.timemap.mcap"
    assert timemap("replay", *logs, "-o", path, "--quiet").code == 0
    return path


@pytest.fixture(scope="module")
def objects():
    """Centres of the boxes in which the objects stood."""
    rows = [
        row for row in shared_data("wean/EXPECTED_CHANGES.csv").read_text().splitlines() if row[:1] != "#"
    ]
    boxes = [{key: float(row[key]) for key in row if key != "kind"} for row in csv.DictReader(rows)]
    return [((box["x_min"] + box["x_max"]) / 2, (box["y_min"] + box["y_max"]) / 2) for box in boxes]


@pytest.mark.parametrize("level", ["mid", "long"])
def test_both_objects_vanished_between_the_drives_and_little_else_changed(result, objects, level):
    ran = timemap("diff", result, "--level", level, "--between", END_OF_FIRST_DRIVE, "end", "--json")
    changes = json.loads(ran.out)["changes"]
    gone = [change for change in changes if change["kind"] == "vanished"]
    for x, y in objects:
        assert [change for change in gone if hypot(change["x"] - x, change["y"] - y) <= 0.3], (x, y)
    assert len(changes) <= len(objects) + MOST_OTHER_CHANGES
