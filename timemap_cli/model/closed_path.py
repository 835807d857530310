"""The best closed path round the circle of angle bins: exact, for all start states at once.

A path's score is the sum of its states' unary and its neighbours' pairwise scores. The matrices of best scores from
one angle bin to another multiply associatively (with max for +, + for *), so neighbours are joined two by two: in
log2 as many steps as a walk round the circle. Scores are integers, so the order of sums decides nothing.
"""

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]

SCALE = 1 << 20  # integer scores per unit of score
IMPOSSIBLE = -(1 << 42)  # below every possible score of a circle, and many of them still add up


def best_closed_path(unary: Ints, pairwise: Ints) -> tuple[Ints, int]:
    """States x (n,) that maximise sum over i of unary[i, x_i] + pairwise[i, x_i, x_i+1], the last before the first.

    `unary` is (n, states), `pairwise` (n, states, states); states that do not exist score IMPOSSIBLE. Ties go to
    the lower state. Returns the states and the score.
    """
    matrices, middles = _joined(unary[:, :, None] + pairwise, 1)
    around = np.diagonal(matrices[0])
    best = int(around.argmax())
    return _unfold(np.array([best]), middles), int(around[best])


def best_open_paths(unary: Ints, pairwise: Ints, length: int) -> Ints:
    """The same for many open paths of one length, a power of two: states (n,), path after path.

    The last pairwise scores of every path must be 0: what comes after it does not matter.
    """
    matrices, middles = _joined(unary[:, :, None] + pairwise, len(unary) // length)
    return _unfold(matrices[:, :, 0].argmax(axis=1), middles)


def _joined(matrices: Ints, stretches: int) -> tuple[Ints, list[npt.NDArray[np.uint16]]]:
    """Join neighbouring stretches two by two until so many are left; and the states in the middle of each join."""
    middles = []
    while len(matrices) > stretches:
        pairs = len(matrices) // 2
        joined, middle = _join(matrices[0 : 2 * pairs : 2], matrices[1 : 2 * pairs : 2])
        matrices = np.concatenate((joined, matrices[2 * pairs :]))
        middles.append(middle)
    return matrices, middles


def _join(first: Ints, second: Ints) -> tuple[Ints, npt.NDArray[np.uint16]]:
    """Best scores (k, states, states) over two stretches in a row, and the state in the middle that gives them."""
    best = first[:, :, 0, None] + second[:, 0, None, :]
    middle = np.zeros(best.shape, np.uint16)
    for state in range(1, first.shape[2]):  # all at once would need states^3 numbers each
        total = first[:, :, state, None] + second[:, state, None, :]
        middle[total > best] = state
        np.maximum(best, total, out=best)
    return best, middle


def _unfold(path: Ints, middles: list[npt.NDArray[np.uint16]]) -> Ints:
    """First states of all stretches, from those of the longest down to the single angle bins'."""
    for middle in reversed(middles):
        pairs = len(middle)
        stop = np.append(path[1:], path[:1])
        finer = np.empty(len(path) + pairs, np.int64)
        finer[0 : 2 * pairs : 2] = path[:pairs]
        finer[1 : 2 * pairs : 2] = middle[np.arange(pairs), path[:pairs], stop[:pairs]]
        finer[2 * pairs :] = path[pairs:]
        path = finer
    return path
