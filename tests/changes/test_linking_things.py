"""Which runs are parts of one thing."""

import numpy as np

from timemap_cli.changes.runs import Run
from timemap_cli.changes.things import link


def run(row: int, *points: tuple[float, float]) -> Run:
    return Run(row, np.arange(len(points)), np.array(points, dtype=np.float64))


def rows_of(things) -> list[list[int]]:
    return [[part.row for part in thing.runs] for thing in things]


def test_runs_within_reach_are_one_thing():
    things = link([run(0, (0.0, 0.0), (1.0, 0.0)), run(1, (1.0, 0.3))], 0.3)
    assert rows_of(things) == [[0, 1]]
    assert things[0].points.shape == (3, 2)


def test_runs_out_of_reach_are_two_things():
    assert rows_of(link([run(0, (0.0, 0.0)), run(1, (0.0, 0.31))], 0.3)) == [[0], [1]]


def test_reach_is_a_distance_not_a_box():
    assert rows_of(link([run(0, (0.0, 0.0)), run(1, (0.25, 0.25))], 0.3)) == [[0], [1]]


def test_runs_join_through_a_third():
    things = link([run(0, (0.0, 0.0)), run(1, (0.5, 0.0)), run(2, (0.25, 0.0))], 0.3)
    assert rows_of(things) == [[0, 1, 2]]


def test_nothing_links_to_nothing():
    assert link([], 0.3) == []
