"""The best path round a circle, against trying them all."""

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from timemap_cli.model.chains import best_states
from timemap_cli.model.closed_path import IMPOSSIBLE, SCALE, best_closed_path


def score(path, unary, pairwise):
    n = len(path)
    return sum(int(unary[i, path[i]] + pairwise[i, path[i], path[(i + 1) % n]]) for i in range(n))


@given(st.integers(1, 9), st.integers(1, 4), st.integers(0, 2**32), st.sampled_from([3, 1000]))
@settings(max_examples=150)
def test_no_closed_path_is_better(n, states, seed, spread):
    random = np.random.default_rng(seed)
    unary = random.integers(-spread, spread, (n, states))
    pairwise = random.integers(-spread, spread, (n, states, states))
    unary[:, 1:][random.random((n, states - 1)) < 0.2] = IMPOSSIBLE
    path, best = best_closed_path(unary, pairwise)
    assert score(path, unary, pairwise) == best
    everything = itertools.product(range(states), repeat=n) if states**n < 3000 else []
    assert all(score(other, unary, pairwise) <= best for other in everything)
    assert (unary[np.arange(n), path] > IMPOSSIBLE).all()


def test_the_path_closes():
    """State 1 is a little better everywhere but cannot stand beside itself across the seam."""
    unary = np.tile([0, 1], (6, 1))
    pairwise = np.zeros((6, 2, 2), np.int64)
    pairwise[:, 0, 1] = pairwise[:, 1, 0] = -100
    assert best_closed_path(unary, pairwise)[0].tolist() == [1] * 6
    pairwise[5, 1, 1] = -100
    assert best_closed_path(unary, pairwise)[0].tolist() == [0] * 6


def test_a_circle_of_thousands_of_angle_bins_stays_exact():
    n = 3600
    unary = np.zeros((n, 3), np.int64)
    unary[:, 0] = -7 * SCALE
    unary[0, 1:] = IMPOSSIBLE
    pairwise = np.full((n, 3, 3), -100 * SCALE)
    pairwise[:, [0, 1, 2], [0, 1, 2]] = 0
    path, best = best_closed_path(unary, pairwise)
    assert path.tolist() == [0] + [1] * (n - 1)
    assert best == -207 * SCALE


# ------------------------------------------------------------------ many circles, most of them open


class Costs:
    """Scores of neighbours, written down."""

    def __init__(self, edges, pairwise):
        self.edges, self.pairwise = np.array(edges, np.int64).reshape(-1, 2), np.asarray(pairwise, np.int64)

    def of_states(self, chosen):
        here, there = self.edges.T
        return self.pairwise[np.arange(len(here)), chosen[here], chosen[there]]

    def tables(self, edges):
        return self.pairwise[edges]


def field(angle_bins, nodes, density, spread, seed):
    """Scores of the rows of a few nodes with gaps between them, what neighbours cost, and which rows they are."""
    random = np.random.default_rng(seed)
    rows = np.flatnonzero(random.random(angle_bins * nodes) < density)
    following = np.where((rows + 1) % angle_bins == 0, rows + 1 - angle_bins, rows + 1)
    edges = [(i, int(np.searchsorted(rows, f))) for i, f in enumerate(following) if f in rows]
    unary = -random.integers(0, spread, (len(rows), 3))
    unary[:, 2][random.random(len(rows)) < 0.6] = IMPOSSIBLE
    pairwise = -random.integers(0, 30, (len(edges), 3, 3)) * (random.random((len(edges), 3, 3)) < 0.5)
    return unary, Costs(edges, pairwise), rows


def fields(angle_bins):
    return st.builds(
        field,
        st.just(angle_bins),
        nodes=st.integers(1, 4),
        density=st.sampled_from([0.3, 0.7, 0.9, 1.0]),
        spread=st.sampled_from([1, 2, 50]),  # few different scores: many ties
        seed=st.integers(0, 2**32),
    )


def node_score(unary, costs, mine, path):
    total = sum(int(unary[i, path[i]]) for i in mine)
    return total + sum(
        int(costs.pairwise[e, path[i], path[j]]) for e, (i, j) in enumerate(costs.edges.tolist()) if i in mine
    )


@given(st.data(), st.integers(3, 7))
@settings(max_examples=120)
def test_every_node_gets_its_best_path_whatever_is_open_or_closed(data, angle_bins):
    unary, costs, rows = data.draw(fields(angle_bins))
    path = best_states(unary, costs, rows, angle_bins)
    for node in np.unique(rows // angle_bins):
        mine = np.flatnonzero(rows // angle_bins == node).tolist()
        found = node_score(unary, costs, mine, path)
        choices = [np.flatnonzero(unary[i] > IMPOSSIBLE) for i in mine]
        if np.prod([len(choice) for choice in choices]) > 300:
            continue
        for other in itertools.product(*choices):
            trial = path.copy()
            trial[mine] = other
            assert node_score(unary, costs, mine, trial) <= found


@given(st.data(), st.integers(3, 20))
@settings(max_examples=120)
def test_ties_are_decided_the_same_in_any_company(data, angle_bins):
    unary, costs, rows = data.draw(fields(angle_bins))
    others, company, before = data.draw(fields(angle_bins))
    alone = best_states(unary, costs, rows, angle_bins)
    nodes_before = int(before[-1]) // angle_bins + 1 if len(before) else 0
    edges = np.concatenate((company.edges, costs.edges + len(before)))
    together = best_states(
        np.concatenate((others, unary)),
        Costs(edges, np.concatenate((company.pairwise, costs.pairwise))),
        np.concatenate((before, rows + nodes_before * angle_bins)),
        angle_bins,
    )
    assert together[len(before) :].tolist() == alone.tolist()


def test_no_choices_at_all_are_no_work():
    nothing = Costs(np.zeros((0, 2), np.int64), np.zeros((0, 1, 1), np.int64))
    unary, rows = np.zeros((0, 1), np.int64), np.zeros(0, np.int64)
    assert best_states(unary, nothing, rows, 12).tolist() == []
