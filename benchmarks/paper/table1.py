"""Table 1: processing time by number of start bins, beside a plain Dijkstra search for each of them."""

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.words import number
from timemap_cli.model.chains import best_states
from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE, best_closed_path

if TYPE_CHECKING:
    import networkx as nx
    from matplotlib.figure import Figure as Canvas

Ints = npt.NDArray[np.int64]

_PAPER_MS = {
    1: "17-31",
    2: "43-52",
    3: "72-81",
    4: "90-98",
    20: "500",
}  # by start bins; a dual core at 2.4 GHz
_START_BINS = tuple(_PAPER_MS)
_HEADER = ("start bins", "paper [ms]", "ours [ms]", "of it the path [ms]", "networkx [ms]", "networkx / ours")
_RANGE_BINS = 20  # the paper's
_OWN_ROUNDS = 15  # of which the quickest counts


class Graph:
    """A circle of angle bins whose states all have weights: as hard as the paper's graph can be."""

    def __init__(self, angle_bins: int, start_bins: int) -> None:
        random = np.random.default_rng(1)
        cost = random.integers(1, 8 * SCALE, (angle_bins, _RANGE_BINS, _RANGE_BINS))
        self.unary: Ints = np.zeros((angle_bins, _RANGE_BINS), np.int64)
        self.unary[0, start_bins:] = IMPOSSIBLE
        self.pairwise: Ints = -cost.astype(np.int64)
        self.start_bins = start_bins
        self.edges: Ints = np.stack((np.arange(angle_bins), (np.arange(angle_bins) + 1) % angle_bins), axis=1)

    def of_states(self, chosen: Ints) -> Ints:
        """Score of each edge (angle_bins,) of these states (angle_bins,)."""
        here, there = self.edges.T
        return np.asarray(self.pairwise[here, chosen[here], chosen[there]])

    def tables(self, edges: Ints) -> Ints:
        """Scores (k, states, states) of these edges."""
        return self.pairwise[edges]

    def score(self, path: Ints) -> int:
        """Score of a closed path."""
        return int(self.unary[np.arange(len(path)), path].sum() + self.of_states(path).sum())


def ours(graph: Graph) -> int:
    """The exact solver as the estimate calls it; the score of the best closed path."""
    rows = np.arange(len(graph.unary))
    return graph.score(best_states(graph.unary, graph, rows, len(rows)))


def alone(graph: Graph) -> int:
    """The solver without the search for chains."""
    return best_closed_path(graph.unary, graph.pairwise)[1]


def as_networkx(graph: Graph) -> "nx.DiGraph":
    """The circle cut open at its first angle bin: states of the first stand at both ends."""
    import networkx as nx

    found = nx.DiGraph()
    angle_bins = len(graph.unary)
    for a in range(angle_bins):
        costs = -graph.pairwise[a]
        for i in range(graph.start_bins if a == 0 else _RANGE_BINS):
            after = graph.start_bins if a == angle_bins - 1 else _RANGE_BINS
            found.add_weighted_edges_from(((a, i), (a + 1, j), int(costs[i, j])) for j in range(after))
    return found


def dijkstra(found: "nx.DiGraph", angle_bins: int, start_bins: int) -> int:
    """A search from each start bin to its own copy at the end; the score of the best closed path."""
    import networkx as nx

    lengths = [nx.dijkstra_path_length(found, (0, start), (angle_bins, start)) for start in range(start_bins)]
    return -int(min(lengths))


def run(scale: Scale) -> Section:
    """A graph of 360 angle bins with 20 states each."""
    angle_bins = scale.pick(360, 60)
    found = [_measured(angle_bins, start_bins) for start_bins in scale.pick(_START_BINS, (1, 20))]
    growth = found[-1][1] / found[0][1]
    faster = found[-1][3] / found[-1][1]
    rows = [
        (str(start_bins), _PAPER_MS[start_bins], *(number(1e3 * t, 1) for t in times), f"{times[2] / times[0]:.0f}")
        for start_bins, *times in found
    ]  # fmt: skip
    return Section(
        "Table 1: processing time by number of start bins",
        (
            f"A graph of {angle_bins} angle bins, each with {_RANGE_BINS} states and all edges between "
            "neighbours, in which the first angle bin has only so many states. The "
            "paper searches once from each start bin, and so does *networkx* (Dijkstra, building the "
            "graph not counted). The solver takes all at once. Both find a path with the "
            "same score. Processor time in one run; the paper's own figures are of a dual core at 2.4 GHz.",
            f"20 start bins take {growth:.2f} times as long as one (bar: 1.5), and networkx {faster:.0f} "
            "times as long as the solver (bar: 50). These figures, unlike all others "
            "here, depend on the machine.",
        ),
        (Table(_HEADER, rows),),
        (Figure("table1", "Processing time by number of start bins.", partial(_draw, found)),),
        {"growth": growth, "faster": faster, "faster with one": found[0][3] / found[0][1]},
    )  # fmt: skip


def _measured(angle_bins: int, start_bins: int) -> tuple[int, float, float, float]:
    """Start bins, and the processor time [s] of our solver, of its path alone, and of networkx."""
    graph = Graph(angle_bins, start_bins)
    whole, score = _timed(partial(ours, graph), _OWN_ROUNDS)
    path, same = _timed(partial(alone, graph), _OWN_ROUNDS)
    plain = as_networkx(graph)
    theirs, length = _timed(partial(dijkstra, plain, angle_bins, start_bins), 1)
    if not score == same == length:
        raise ValueError(f"the solver found {score}, its path {same}, networkx {length}")
    return start_bins, whole, path, theirs


def _timed(work: Callable[[], int], rounds: int) -> tuple[float, int]:
    """Processor time [s] of the quickest round, and what the work returns."""
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        found = work()
        times.append(time.process_time() - begin)
    return min(times), found


def _draw(found: Sequence[tuple[int, float, float, float]], canvas: "Canvas") -> None:
    axes = canvas.subplots()
    for column, label in ((1, "ours"), (3, "networkx, a Dijkstra search per start bin")):
        axes.plot([row[0] for row in found], [1e3 * row[column] for row in found], "o-", label=label)
    axes.set_yscale("log")
    axes.set_xlabel("start bins")
    axes.set_ylabel("processor time [ms]")
    axes.legend()
