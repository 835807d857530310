"""What the sample recordings' truth says has changed, and nothing else."""

import json
from pathlib import Path

import pytest

from tests.cli.program import timemap

SAMPLES = Path(__file__).parents[2] / "sample_logs"
TRUTH = json.loads((SAMPLES / "truth.json").read_text())
BEYOND = 0.15  # [m] by which a centre seen from a few sides may lie outside what stands there
LOGS = [SAMPLES / recording["file"] for recording in TRUTH["recordings"]]
ENDS = [recording["end_ns"] for recording in TRUTH["recordings"]]


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """All recordings in one result."""
    path = tmp_path_factory.mktemp("patrols") / "patrols.timemap.mcap"
    assert timemap("replay", *LOGS, "-o", path, "--quiet").code == 0
    return path


def expected(earlier_ns: int, later_ns: int) -> list[tuple[str, dict[str, float]]]:
    """Kind and place of every change between two times that the truth knows."""
    happened = [c for c in TRUTH["changes"] if earlier_ns < int(c["at_ns"]) <= later_ns]
    places = [("vanished", c["from"]) for c in happened] + [("appeared", c["to"]) for c in happened]
    return [(kind, box) for kind, box in places if box]


def found(result: Path, level: str, earlier: str, later: str) -> list[tuple[str, float, float]]:
    """Kind and place of every change that is told; a moved thing vanished there and appeared here."""
    ran = timemap("diff", result, "--level", level, "--between", earlier, later, "--json")
    told = []
    for change in json.loads(ran.out)["changes"]:
        kind = "appeared" if change["kind"] == "moved" else change["kind"]
        told.append((kind, change["x"], change["y"]))
        if change["moved_from"]:
            told.append(("vanished", *change["moved_from"]))
    return told


def fits(told: tuple[str, float, float], true: tuple[str, dict[str, float]]) -> bool:
    kind, x, y = told
    box = true[1]
    inside_x = box["x_min"] - BEYOND <= x <= box["x_max"] + BEYOND
    return kind == true[0] and inside_x and box["y_min"] - BEYOND <= y <= box["y_max"] + BEYOND


@pytest.mark.parametrize("level", ["short", "mid"])
@pytest.mark.parametrize("pair", [(0, 1), (1, 2)])
def test_every_true_change_is_told_and_no_other(result, level, pair):
    earlier, later = ENDS[pair[0]], ENDS[pair[1]]
    true, told = expected(int(earlier), int(later)), found(result, level, earlier, later)
    assert true
    assert [t for t in true if not any(fits(f, t) for f in told)] == []
    assert [f for f in told if not any(fits(f, t) for t in true)] == []


def test_barrel_pushed_aside_has_moved(result):
    ran = timemap("diff", result, "--level", "mid", "--between", ENDS[1], "end", "--json")
    (moved,) = [change for change in json.loads(ran.out)["changes"] if change["kind"] == "moved"]
    assert (moved["x"], moved["y"]) == pytest.approx((1.4, 1.6), abs=0.2)
    assert moved["moved_from"] == pytest.approx([1.4, 2.3], abs=0.2)
