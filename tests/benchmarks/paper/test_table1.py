"""The graph that the solvers are timed on: both find the best closed path."""

import itertools

import numpy as np
import pytest

from benchmarks.paper.section import Scale
from benchmarks.paper.table1 import Graph, alone, as_networkx, dijkstra, ours, run

pytest.importorskip("networkx")


@pytest.mark.parametrize("start_bins", [1, 3, 20])
def test_all_solvers_find_the_same_score(start_bins):
    graph = Graph(9, start_bins)
    assert ours(graph) == alone(graph) == dijkstra(as_networkx(graph), 9, start_bins)


def test_the_score_is_that_of_trying_every_path():
    graph = Graph(3, 2)
    paths = itertools.product(range(2), range(20), range(20))
    assert ours(graph) == max(graph.score(np.array(path)) for path in paths)


def test_start_bins_cost_nothing_and_a_search_from_each_costs_more():
    numbers = run(Scale.quick).numbers
    assert numbers["growth"] < 3
    assert numbers["faster"] > 20
