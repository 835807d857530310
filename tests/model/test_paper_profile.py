"""The paper's own estimate."""

from dataclasses import fields, replace

import numpy as np

from timemap_cli.model.levels import Level
from timemap_cli.model.memory import Memory, Remembered
from timemap_cli.model.nodes import Node
from timemap_cli.model.paper_profile import estimate_as_in_paper
from timemap_cli.model.status import Status
from timemap_cli.model.virtual_scan import UNSEEN

ANGLE_BINS = 24


def remembered(scans):
    """Memory of one node after these scans (n, angle_bins) [mm]."""
    memory = Memory(Level("long", 20, 20), ANGLE_BINS, seed=0)
    memory.add_nodes([Node(0.0, 0.0)])
    memory.remember(np.zeros(len(scans), np.int64), np.arange(len(scans)), np.array(scans, np.uint16))
    return memory.recall(np.array([0]))


def ring(value):
    return np.full(ANGLE_BINS, value)


def both(one, other):
    def joined(name):
        arrays = [getattr(memory, name) for memory in (one, other)]
        if arrays[0].ndim < 3:
            return np.concatenate(arrays)
        empty = 0 if name == "ages" else UNSEEN
        return np.concatenate(
            [np.pad(a, [(0, 0), (0, 0), (0, 20 - a.shape[2])], constant_values=empty) for a in arrays]
        )

    names = [field.name for field in fields(Remembered) if field.name != "window"]
    return replace(one, **{name: joined(name) for name in names})


def test_a_coherent_majority_is_estimated():
    found = estimate_as_in_paper(remembered([ring(1000)] * 3 + [ring(1300)] * 9), 0.075)
    assert (found.ranges == 1300).all()
    assert np.allclose(found.support, 0.75)


def test_ranges_of_one_slice_are_one_state():
    found = estimate_as_in_paper(
        remembered([ring(1051), ring(1070), ring(1100)]), 0.075
    )  # slice 1050 .. 1125
    assert (found.ranges == 1070).all()
    assert np.allclose(found.support, 1)


def test_what_was_never_seen_is_unknown():
    scan = ring(1000)
    scan[5:9] = UNSEEN
    found = estimate_as_in_paper(remembered([scan] * 4), 0.075)
    assert np.flatnonzero(found.ranges[0] == UNSEEN).tolist() == [5, 6, 7, 8]


def test_every_angle_bin_has_its_status():
    near, far = ring(1000), ring(1300)
    near[5:9] = UNSEEN
    far[5:9] = UNSEEN
    near[7] = 2000
    scans = [near] * 20 + [far] * 60  # angle bin 7 stays unseen for more than 20 ln 2 scans of a full level
    status = estimate_as_in_paper(remembered(scans), 0.075).status[0]
    unknown, others = [5, 6, 8], np.delete(np.arange(ANGLE_BINS), [5, 6, 7, 8])
    assert (status[unknown] == Status.UNKNOWN).all()
    assert status[7] == Status.CONCLUDED
    assert (status[others] == Status.MEASURED).all()
    close = [near] * 5 + [far] * 6
    assert (estimate_as_in_paper(remembered(close), 0.075).status[0, others] == Status.CONTESTED).all()


def test_a_circle_that_closes_only_after_two_laps_is_estimated_and_harms_no_other_node():
    twisted = remembered([ring(1000), ring(3000)])
    left, right = twisted.left.copy(), twisted.right.copy()
    right[0, -1, :2] = right[0, -1, 1::-1]  # past the last angle bin, near goes on as far and far as near
    twisted = replace(twisted, left=left, right=right)
    rare = ring(1300)
    plain = remembered([ring(1000)] * 9 + [rare])
    alone = [estimate_as_in_paper(memory, 0.075) for memory in (twisted, plain)]
    together = estimate_as_in_paper(both(twisted, plain), 0.075)
    assert set(np.unique(alone[0].ranges)) <= {1000, 3000}
    for node in (0, 1):
        assert np.array_equal(together.ranges[node], alone[node].ranges[0])
        assert np.array_equal(together.support[node], alone[node].support[0])
