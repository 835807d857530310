"""The best states of many circles of angle bins, most of which need no search.

Angle bins with one state do not couple what lies on either side of them, so the rows that have a choice fall into
short chains. Scores of pairs are never above 0: where each row's best state by itself costs nothing beside its
neighbours', that is the optimum. Only the chains in conflict are searched, all of them at once.
"""

from typing import Protocol

import numpy as np
import numpy.typing as npt

from timemap_cli.model.closed_path import IMPOSSIBLE, best_closed_path, best_open_paths

Ints = npt.NDArray[np.int64]


class Coupling(Protocol):
    """What states cost side by side; scores are never above 0."""

    edges: Ints  # (edges, 2) neighbouring rows, in the direction of the bearing

    def of_states(self, chosen: Ints) -> Ints:
        """Score of each edge (edges,) when every row shows its chosen state (rows,)."""

    def tables(self, edges: Ints) -> Ints:
        """Scores (k, states, states) of these edges, for every two states."""


def best_states(unary: Ints, coupling: Coupling, rows: Ints, angle_bins: int) -> Ints:
    """States (rows,) of the paths with the best score, for the circles of all nodes at once.

    `unary` (rows, states) scores each state by itself; `rows` holds node * angle_bins + angle bin, ascending.
    """
    best: Ints = unary.argmax(axis=1)
    here = coupling.edges[:, 0]
    conflict = here[coupling.of_states(best) < 0]
    if not len(conflict):
        return best
    link = np.full(len(rows), -1)  # the edge that leads on from a row
    link[here] = np.arange(len(here))
    for chain in _chains(rows, link, conflict, angle_bins):
        best[chain] = _search(unary, coupling, chain, link[chain])
    return best


def _chains(rows: Ints, link: Ints, conflict: Ints, angle_bins: int) -> list[Ints]:
    """Rows of the chains in conflict, in order: all open chains as one array, and each closed circle as its own."""
    node, angle_bin = np.divmod(rows, angle_bins)
    open_end = link < 0
    breaks = np.bincount(node[open_end], minlength=int(node[-1]) + 1)
    # An open circle is turned so that it begins after a break: what lies before its first break goes to its end.
    before_break: Ints = np.cumsum(open_end) - open_end
    first_row = np.searchsorted(node, node)
    wraps = (before_break == before_break[first_row]) & (breaks[node] > 0)
    wraps &= link[np.searchsorted(node, node, side="right") - 1] >= 0
    order = np.argsort((node * 2 + wraps) * angle_bins + angle_bin, kind="stable")
    chain = np.empty(len(rows), np.int64)
    chain[order] = np.cumsum(np.append(True, open_end[order][:-1] | (np.diff(node[order]) > 0))) - 1
    wanted = np.zeros(int(chain.max()) + 1, np.bool_)
    wanted[chain[conflict]] = True
    ordered = order[wanted[chain[order]]]
    closed = breaks[node[ordered]] == 0
    circles = [ordered[closed & (node[ordered] == n)] for n in sorted(set(node[ordered[closed]].tolist()))]
    return [part for part in (ordered[~closed], *circles) if len(part)]


def _search(unary: Ints, coupling: Coupling, chain: Ints, link: Ints) -> Ints:
    """Best states (n,) of rows in order, each linked by an edge (n,) to the next, or not at all."""
    exists = unary[chain] > IMPOSSIBLE
    size = int(exists.sum(axis=1).max())
    place, length, count = _aligned(link < 0)
    of_rows = np.full((length * count, size), IMPOSSIBLE)
    of_rows[:, 0] = 0
    of_rows[place] = unary[chain, :size]
    linked = np.flatnonzero(link >= 0)
    pairwise = np.zeros((length * count, size, size), np.int64)
    pairwise[place[linked]] = coupling.tables(link[linked])[:, :size, :size]
    if len(linked) == len(chain):
        return best_closed_path(of_rows, pairwise)[0]
    return best_open_paths(of_rows, pairwise, length)[place]


def _aligned(ends: npt.NDArray[np.bool_]) -> tuple[Ints, int, int]:
    """Places (n,) for the rows of open chains, of which `ends` tells the last rows, in paths of one length.

    Each chain begins at a multiple of its own length, rounded up to a power of two. So it is always joined in the
    same halves, and between paths with the same score it takes the same one in any company. Returns the places, the
    length of the paths, which is that of the longest chain, and their number. One closed circle is one path.
    """
    last = np.flatnonzero(ends)
    if not len(last):
        return np.arange(len(ends)), len(ends), 1
    length = np.diff(last, prepend=-1)
    room = np.int64(1) << np.frexp(length - 1)[1].astype(np.int64)
    order = np.argsort(-room, kind="stable")
    start = np.empty_like(room)
    start[order] = np.cumsum(room[order]) - room[order]
    longest = int(room.max())
    place = np.arange(len(ends)) + np.repeat(start - (last + 1 - length), length)
    return place, longest, -(-int(room.sum()) // longest)
