"""Memories for the tests: learnt from scans of numbers, and told to the model's own estimate."""

import numpy as np

from tests.model import reference
from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory, Remembered
from timemap_cli.model.nodes import Node
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN

NODE = Node(1.25, -3.5)
EVERY_SCAN = 1e-6  # half-life [scans] of a level that takes each one


def codes(scans):
    """Virtual scans (n, angle_bins) [mm] of rows of metres; inf is clear, NaN unseen."""
    scans = np.asarray(scans, float)
    mm = np.rint(np.where(np.isfinite(scans), scans, 0) * 1000)
    return np.where(np.isnan(scans), UNSEEN, np.where(np.isposinf(scans), CLEAR, mm)).astype(np.uint16)


def learnt(scans, window, half_life=EVERY_SCAN, *, seed=0, node=NODE, name="level"):
    """The memory of one node after scans (n, angle_bins) [m]."""
    scans = codes(scans)
    memory = Memory(Level(name, window, half_life), scans.shape[1], seed)
    memory.add_nodes([node])
    memory.remember(np.zeros(len(scans), np.int64), np.arange(len(scans)) * 10**8, scans)
    return memory


def recalled(memory):
    return memory.recall(np.array([0]))


def told(slow):
    """What the model's estimate reads, of one or several slow memories of the same size."""
    several = slow if isinstance(slow, list) else [slow]
    m, angle_bins, window = len(several), several[0].angle_bins, several[0].window
    shape = (m, angle_bins, window)
    samples, left, right = (np.full(shape, UNSEEN, np.uint16) for _ in range(3))
    ages = np.zeros(shape, np.uint32)
    code = {reference.CLEAR: CLEAR}
    for n, one in enumerate(several):
        for a in range(angle_bins):
            for i, (value, then) in enumerate(one.samples[a]):
                samples[n, a, i] = code.get(value, value)
                ages[n, a, i] = one.spared[a] - then
            for i, (here, there) in enumerate(one.pairs[a]):
                left[n, a, i], right[n, a, i] = code.get(here, here), code.get(there, there)
    return Remembered(
        samples,
        ages,
        left,
        right,
        (samples < UNSEEN).sum(axis=2),
        (left < UNSEEN).sum(axis=2),
        np.zeros((m, angle_bins), np.int64),
        np.array([one.taken for one in several]),
        np.zeros(m, np.int64),
        window,
    )
