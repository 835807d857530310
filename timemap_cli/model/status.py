"""How an angle bin comes to show what it shows; docs/method.md, 4.4, has the reasons."""

import math
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from timemap_cli.model.closed_path import SCALE
from timemap_cli.model.memory import Remembered
from timemap_cli.model.states import States
from timemap_cli.model.virtual_scan import UNSEEN, Bools
from timemap_cli.model.vote import Shares

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]
Codes = npt.NDArray[np.uint8]


class Status(IntEnum):
    """What the estimate of an angle bin rests on. The numbers are those of a result's messages."""

    UNKNOWN = 0  # never observed
    MEASURED = 1  # observed like that lately, and most of what is known says so
    CONCLUDED = 2  # not observed like that lately, or against its own majority: the neighbours decide
    CONTESTED = 3  # observed lately, but chance alone could put another state ahead


def statuses(memory: Remembered, states: States, share: Shares, best: Ints) -> Codes:
    """Status of each angle bin (m * angle_bins,) whose rows show the chosen states `best` (rows,)."""
    known = memory.n_samples.reshape(-1) > 0
    lately, chosen_lately = _seen_lately(memory, states, best)
    leads = np.ones_like(known)
    near = np.zeros_like(known)
    leads[states.rows], near[states.rows] = _lead(memory, states, share, best)
    status = np.where(chosen_lately & leads, Status.MEASURED, Status.CONCLUDED)
    status[lately & near] = Status.CONTESTED
    status[~known] = Status.UNKNOWN
    return status.astype(np.uint8)


def _seen_lately(memory: Remembered, states: States, best: Ints) -> tuple[Bools, Bools]:
    """Whether each angle bin was seen at all, and whether in its chosen state (m * angle_bins,), lately.

    Lately: the level has since taken fewer scans without it than replace half of a window.
    """
    depth = memory.samples.shape[2]
    samples = memory.samples.reshape(-1, depth)
    recent = memory.ages.reshape(-1, depth) <= int(memory.window * math.log(2))
    recent &= samples < UNSEEN
    lately: Bools = np.asarray(recent.any(axis=1))
    low, high = states.span(np.arange(len(best)), best)
    chosen = samples[states.rows]
    chosen_lately = lately.copy()
    chosen_lately[states.rows] = (recent[states.rows] & (chosen >= low) & (chosen < high)).any(axis=1)
    return lately, chosen_lately


def _lead(memory: Remembered, states: States, share: Shares, best: Ints) -> tuple[Bools, Bools]:
    """Of each row (rows,): whether the chosen state leads all others, and whether its best rival is near.

    Near: were both states as likely, so many samples of the two would differ by more than that in one of three
    cases (one standard deviation of the binomial distribution, the root of their number).
    """
    full = np.maximum(1, np.minimum(memory.taken, memory.window))
    samples = share.states * np.repeat(full, memory.samples.shape[1])[states.rows, None]
    samples = np.rint(samples * SCALE) / SCALE  # as weighed, without the error of the division
    at = np.arange(len(best))
    chosen = samples[at, best]
    samples[at, best] = 0
    rival = samples.max(axis=1)
    return chosen > rival, (rival > 0) & ((chosen - rival) ** 2 < chosen + rival)
