"""One level's memory and estimate in plain Python: slow, one node, one angle bin at a time.

Written from the definition, not from the model: ranges are numbers of millimetres, CLEAR stands for nothing out to
the node's radius, None for not seen.
"""

import itertools
import math

CLEAR = 10**9  # farther than everything
FORBIDDEN, PRIOR, OLDEST = 100.0, 0.1, 1e-4
BEND = 1600.0  # [mm] beyond, the scale on which surfaces are told apart shrinks with 1 / range


class SlowMemory:
    """Samples and pairs of every angle bin. `choose(count)` gives the place that a new entry takes in a full set."""

    def __init__(self, angle_bins, window, choose):
        self.angle_bins, self.window, self.choose = angle_bins, window, choose
        self.samples = [[] for _ in range(angle_bins)]  # [range, spared then]
        self.pairs = [[] for _ in range(angle_bins)]  # (range here, range in the next angle bin)
        self.spared = [0] * angle_bins  # scans taken after the window, that evicted nothing of the angle bin
        self.taken = 0

    def learn(self, scan):
        """Take one virtual scan (angle_bins,)."""
        self.taken += 1
        for a, value in enumerate(scan):
            following = scan[(a + 1) % self.angle_bins]
            evicts = value is not None and len(self.samples[a]) == self.window
            if self.taken > self.window and not evicts:
                self.spared[a] += 1
            if value is None:
                continue
            self._put(self.samples[a], [value, self.spared[a]])
            if following is not None:
                self._put(self.pairs[a], (value, following))

    def _put(self, entries, entry):
        if len(entries) < self.window:
            entries.append(entry)
        else:
            entries[self.choose(self.window)] = entry


def stretched(mm):
    """Place on the scale on which surfaces of any range are equally wide [mm, whole tenths]."""
    if mm == CLEAR:
        return float(CLEAR)
    return round((mm if mm <= BEND else BEND * (1 + math.log(mm / BEND))) * 10) / 10


def groups(values, width):
    """Surfaces among the values [mm], each a sorted list: `width` [mm] on the stretched scale."""
    found, ordered = [], sorted(values)
    for value in ordered:
        if found and stretched(value) - stretched(found[-1][-1]) <= width / 2:
            found[-1].append(value)
        else:
            found.append([value])
    narrow = []
    for group in found:
        narrow += [group] if _span(group) <= 2 * width else _windows(group, width)
    return sorted(narrow)


def _span(group):
    return stretched(group[-1]) - stretched(group[0])


def _windows(group, width):
    """Cut out the window of one width with the most values, the nearest of equals; again from both rests."""
    if not group:
        return []
    if _span(group) <= width:
        return [group]
    inside = [
        sum(1 for other in group[i:] if stretched(other) <= stretched(value) + width)
        for i, value in enumerate(group)
    ]
    start = inside.index(max(inside))
    stop = start + inside[start]
    # equal values stand side by side and the first of them has the most company: no cut falls between them
    return [*_windows(group[:start], width), group[start:stop], *_windows(group[stop:], width)]


class SlowEstimate:
    """States and scores of a memory, and what follows from them."""

    def __init__(self, memory, width):
        self.memory, self.bins = memory, range(memory.angle_bins)
        self.states = [groups(self.known(a), width) or [[]] for a in self.bins]
        self.share = [self._shares(a) for a in self.bins]
        self.unary = [[self._unary(a, i) for i in range(len(self.states[a]))] for a in self.bins]
        self.pairwise = [self._pairwise(a) for a in self.bins]

    def known(self, a):
        """All that is known of an angle bin: samples, left ends of its pairs, right ends of its predecessor's."""
        memory = self.memory
        return (
            [value for value, _ in memory.samples[a]]
            + [here for here, _ in memory.pairs[a]]
            + [there for _, there in memory.pairs[a - 1]]
        )

    def state_of(self, a, value):
        """Number of the state that a known value belongs to."""
        return next(i for i, state in enumerate(self.states[a]) if value in state)

    def _shares(self, a):
        memory, kept = self.memory, 1 - 1 / self.memory.window
        share = [0.0] * len(self.states[a])
        for value, then in memory.samples[a]:
            fresh = max(OLDEST, kept ** (memory.spared[a] - then))
            share[self.state_of(a, value)] += fresh / max(1, min(memory.taken, memory.window))
        return share

    def _unary(self, a, i):
        against = sum(share for j, share in enumerate(self.share[a]) if j != i)
        return math.log(max(0.5 / self.memory.window, 1 - against))

    def _pairwise(self, a):
        following = (a + 1) % len(self.bins)
        here, there = range(len(self.states[a])), range(len(self.states[following]))
        count = [[0] * len(there) for _ in here]
        for left, right in self.memory.pairs[a]:
            count[self.state_of(a, left)][self.state_of(following, right)] += 1
        of_left = [sum(row) for row in count]
        of_right = [sum(count[i][j] for i in here) for j in there]
        total = max(1, sum(of_left))
        return [
            [
                -FORBIDDEN
                * max(0.0, 1 - 2 * (count[i][j] + PRIOR) / (of_left[i] * of_right[j] / total + PRIOR))
                for j in there
            ]
            for i in here
        ]

    def score(self, path):
        """Score of a closed path, a state for each angle bin."""
        return sum(
            self.unary[a][path[a]] + self.pairwise[a][path[a]][path[(a + 1) % len(self.bins)]]
            for a in self.bins
        )

    def best_score(self):
        """The best score of all closed paths, from every start state in turn."""
        best = -math.inf
        for start in range(len(self.states[0])):
            scores = {start: self.unary[0][start]}
            for a in self.bins[1:]:
                scores = {
                    j: max(scores[i] + self.pairwise[a - 1][i][j] for i in scores) + self.unary[a][j]
                    for j in range(len(self.states[a]))
                }
            best = max(best, *(scores[i] + self.pairwise[-1][i][start] for i in scores))
        return best

    def brute_force(self):
        """The best score of all closed paths, by trying each."""
        return max(map(self.score, itertools.product(*(range(len(states)) for states in self.states))))

    def status(self, a, i):
        """What showing state i of angle bin a rests on: unknown 0, measured 1, concluded 2, contested 3.

        None where rounding decides.
        """
        memory, count = self.memory, [0.0] * len(self.states[a])
        lately = set()  # states
        for value, then in memory.samples[a]:
            state, age = self.state_of(a, value), memory.spared[a] - then
            count[state] += max(OLDEST, (1 - 1 / memory.window) ** age)
            if age <= memory.window * math.log(2):
                lately.add(state)
        if not memory.samples[a]:
            return 0
        own, rival = count[i], max([0.0, *count[:i], *count[i + 1 :]])
        close = (own + rival) - (own - rival) ** 2
        if 0 < abs(close) < 1e-4 and rival > 0:
            return None
        if lately and rival > 0 and close > 0:
            return 3
        return 1 if i in lately and own > rival else 2

    def support(self, a, shown):
        """Share of what is known of angle bin a that a change from the range shown would not be told by."""
        memory, weights = self.memory, [0.0, 0.0]
        for value, then in memory.samples[a]:
            agrees = value == shown or (
                CLEAR not in (value, shown) and abs(value - shown) <= max(200, 0.03 * shown)
            )
            weights[agrees] += max(OLDEST, (1 - 1 / memory.window) ** (memory.spared[a] - then))
        return weights[True] / sum(weights) if memory.samples[a] else 0.0

    def reported(self, a, i):
        """Lower median of the samples in a state, or of its pairs' ranges where its samples are gone; None: nothing."""
        values = [value for value, _ in self.memory.samples[a] if value in self.states[a][i]]
        values = sorted(values or self.states[a][i])
        return values[(len(values) - 1) // 2] if values else None
