"""What maps are worth, on maps by hand."""

import numpy as np
import pytest

from benchmarks.changes.maps import Grid, MapScore, mean_score, newest, score_map, seen_surface, walls_left
from benchmarks.changes.table import left_line, maps_table
from benchmarks.changes.worlds.open_hall import LAYOUTS, hall
from sample_logs.world import Thing, World, box

WALL = np.array([[0.0, 0.025, 1.0, 0.025]])  # along the middle of the lowest row


def grid(rows: int, columns: int, *occupied: tuple[int, int], stamp_ns: int = 0) -> Grid:
    cells = np.zeros((rows, columns), np.int8)
    for row, column in occupied:
        cells[row, column] = 100
    return Grid(stamp_ns, cells, 0.05, (0.0, 0.0))


def test_cells_are_right_near_a_surface_and_ghosts_away_from_all():
    """Row 2 lies 0.10 m from the wall, row 3 0.15 m (neither), row 4 0.20 m."""
    seen = np.array([[0.3, 0.025]])
    score = score_map(grid(10, 20, (2, 5), (3, 5), (4, 5), (9, 5)), World(WALL), seen)
    assert score.precision == pytest.approx(1 / 4)
    assert score.ghosts == pytest.approx(2 * 0.05**2)


def test_a_surface_is_recalled_near_a_cell():
    """The cell's middle is at 0.275: of samples up to 0.9 m the one at 0.38 is the last within 0.11 m."""
    seen = np.array([[0.17, 0.025], [0.38, 0.025], [0.39, 0.025], [0.9, 0.025]])
    assert score_map(grid(1, 20, (0, 5)), World(WALL), seen).recall == 0.5
    assert score_map(grid(1, 20), World(WALL), seen).recall == 0.0


def test_things_count_while_they_stand():
    crate = box(0.5, 1.0, 0.2, 0.2)
    seen = np.array([[0.5, 0.9]])
    there, gone = Thing("crate", crate), Thing("crate", crate, until=0.0)
    assert score_map(grid(30, 20, (18, 10)), World(WALL, [there]), seen).ghosts == 0.0
    assert score_map(grid(30, 20, (18, 10)), World(WALL, [gone]), seen).ghosts == pytest.approx(0.0025)


def test_the_newest_map_before_a_time_counts():
    maps = [grid(1, 1, stamp_ns=stamp) for stamp in (10, 20, 30)]
    assert newest(maps, 30).stamp_ns == 20
    assert newest(maps, float("inf")).stamp_ns == 30


def test_the_laser_sees_sides_that_face_it_and_not_the_far_side_of_walls():
    drive = hall(LAYOUTS[0]).drives()["run_1"]
    seen = seen_surface(drive)
    south = seen[np.abs(seen[:, 0] - 2.0) < 0.5]
    assert south[:, 1].min() == pytest.approx(0.06)  # the inner face of the wall; the outer is at -0.06
    assert len(seen) > 1500


def test_means_and_table():
    low, high = MapScore(0.8, 0.6, 0.2), MapScore(1.0, 0.8, 0.0)
    assert mean_score([low, high]) == MapScore(pytest.approx(0.9), pytest.approx(0.7), pytest.approx(0.1))
    lines = maps_table({5: {"mid": low}, 8: {"mid": high}}, {"mid": 7}).splitlines()
    assert [line.split() for line in lines[1:]] == [
        ["mid", "day", "5", "0.800", "0.600", "0.200"],
        ["mid", "day", "8", "1.000", "0.800", "0.000"],
        ["mid", "mean", "of", "5,", "8", "0.900", "0.700", "0.100", "7"],
    ]
    assert left_line({"short": 0, "mid": 7}).endswith(": short 0, mid 7")


def vanished(**more):
    return {
        "kind": "vanished", "closed_ns": None, "adopted": {"mid": "9"},
        "outline": [[0.1, 0.0], [0.3, 0.0], [0.3, 0.1], [0.1, 0.1]],
    } | more  # fmt: skip


@pytest.mark.parametrize(
    ("event", "left"),
    [
        (vanished(), 2),
        (vanished(kind="appeared"), 0),
        (vanished(closed_ns="12"), 0),
        (vanished(adopted={"mid": None}), 0),
        (vanished(outline=[[0.1, 0.0], [0.3, 0.0]]), 0),  # a line holds no cell
    ],
)
def test_walls_inside_what_vanished_are_counted_while_that_holds(event, left, monkeypatch, tmp_path):
    """Two of three occupied cells have their middle inside."""
    one = grid(10, 20, (0, 3), (1, 4), (0, 12))
    monkeypatch.setattr("benchmarks.changes.maps.grids", lambda result, level: [one])
    assert walls_left(tmp_path, {"events": [event, event]}, "mid") == left
