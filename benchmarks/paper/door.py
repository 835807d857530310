"""A door that is open a changing share of the time, and where the long and the mid level differ."""

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import chosen
from benchmarks.paper.metrics import Change, apart
from benchmarks.paper.rooms import OFFICE
from benchmarks.paper.scene import look
from benchmarks.paper.section import Figure, Scale, Section, Table
from benchmarks.paper.watched import EVERY, LONG, MID, Watched
from benchmarks.paper.words import percent, share
from sample_logs.rays import Floats
from sample_logs.world import box, outline_segments
from timemap_cli.model.levels import Level

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

# A doorway of 0.9 m in the wall at +y, and a corridor behind it.
_CORRIDOR = np.array([[-2.0, 4.0, 3.0, 4.0]])
OPEN = np.concatenate(
    (np.delete(OFFICE, 2, axis=0), [[2.9, 2.2, 0.9, 2.2], [0.0, 2.2, -2.1, 2.2]], _CORRIDOR)
)
CLOSED = np.concatenate((OPEN, outline_segments(box(0.45, 2.2, 0.9, 0.04))))

SCHEDULE = ((1500, 0.05), (200, 0.9), (250, 0.2), (400, 0.75), (200, 0.1), (250, 0.95))  # scans, share open
_NAMES = ("ours", "profile: paper", "caption, states from data", "vote without pairs", "median per angle bin")
_DWELL = 4  # scans for which the door stays as it is
_CLEAR_CASE = 0.15  # of a share from one half
_STEP = 0.2  # [m] two levels farther apart than this differ


@dataclass(frozen=True, slots=True)
class _Outcome:
    overlap: float  # intersection by union of changed angle bins, over all estimates after the first stretch
    clear_overlap: float  # the same where both levels' worlds are at least 0.15 from undecided
    false: float  # share of the angle bins called changed among those that never change
    shown: Floats  # (estimates, 2) share of the door shown open by long and mid, first node


def run(scale: Scale) -> Section:
    """A door over 2,800 scans whose share of being open changes six times."""
    nodes = scale.pick(12, 1)
    names = scale.pick(_NAMES, _NAMES[:1])
    random = np.random.default_rng(10)
    closed, opened = look(CLOSED, 300, random).virtual(), look(OPEN, 300, random).virtual()
    is_open = schedule(nodes, random)
    scans = np.stack((closed, opened))[is_open.astype(np.int64), random.integers(0, 300, is_open.shape)]
    seen = {}
    for level in (LONG, MID):
        watched = Watched(level, nodes, chosen(*names))
        watched.learn(scans[: SCHEDULE[0][0]])
        seen[level.name] = watched.follow(scans[SCHEDULE[0][0] :])
    truths = {
        level.name: weighted(is_open, level)[SCHEDULE[0][0] + EVERY - 1 :: EVERY] for level in (LONG, MID)
    }
    found = {name: _outcome(seen["long"][name], seen["mid"][name], truths) for name in names}
    rows = [(name, share(o.overlap), share(o.clear_overlap), percent(o.false)) for name, o in found.items()]
    return Section(
        "A door that is open a changing share of the time",
        (
            "A door stands open 5 % of the time for 1,500 scans, then 90, 20, 75, 10 and 95 % for 200 to 400 "
            f"scans each; it stays as it is for {_DWELL} scans. Which angle bins "
            "differ between the long and the mid level, against the truth: what each level should hold is the "
            "state with the larger share of its past, weighted by its half-life. "
            f"Intersection by union over all estimates, mean of {nodes} runs; then only where both shares are at "
            f"least {_CLEAR_CASE} from undecided. *False*: share of the angle "
            f"bins called changed outside the door. Changed is more than {_STEP} m.",
        ),
        (Table(("", "overlap", "overlap, clear cases", "false"), rows),),
        (
            Figure(
                "door",
                "Share of the door shown open (first run), and the share of the past in which it was, by half-life.",
                partial(_draw, found["ours"].shown, truths),
            ),
        ),
        {what: getattr(found["ours"], what) for what in ("overlap", "clear_overlap", "false")},
    )


def schedule(nodes: int, random: np.random.Generator) -> npt.NDArray[np.bool_]:
    """Whether the door is open (scans, nodes): in each stretch exactly its share of the time, in any order."""
    stretches = []
    for scans, part in SCHEDULE:
        turns = scans // _DWELL
        order = random.permuted(np.broadcast_to(np.arange(turns)[:, None], (turns, nodes)), axis=0)
        stretches.append(np.repeat(order < round(part * turns), _DWELL, axis=0))
    return np.concatenate(stretches)


def weighted(is_open: npt.NDArray[np.bool_], level: Level) -> Floats:
    """Share of the past (scans, nodes) in which the door was open, by the weights that the half-life gives it."""
    kept = 2.0 ** (-1.0 / level.half_life)
    found = np.empty(is_open.shape)
    now = is_open[: SCHEDULE[0][0]].mean(axis=0)
    for i, state in enumerate(is_open):
        now = kept * now + (1 - kept) * state
        found[i] = now
    return found


def _outcome(long: Floats, mid: Floats, truths: dict[str, Floats]) -> _Outcome:
    change = Change.between(CLOSED, OPEN)
    differ = apart(long, mid) > _STEP
    true = (truths["long"] > 0.5) != (truths["mid"] > 0.5)
    clear = (np.abs(truths["long"] - 0.5) >= _CLEAR_CASE) & (np.abs(truths["mid"] - 0.5) >= _CLEAR_CASE)
    door = differ[..., change.changed]
    shown = [apart(one[:, 0], change.new) < apart(one[:, 0], change.old) for one in (long, mid)]
    return _Outcome(
        _overlap(door, true, np.ones_like(clear)),
        _overlap(door, true, clear),
        float(differ[..., change.even & ~change.changed].mean()),
        np.stack([one[:, change.changed].mean(axis=1) for one in shown], axis=1),
    )


def _overlap(
    found: npt.NDArray[np.bool_], true: npt.NDArray[np.bool_], where: npt.NDArray[np.bool_]
) -> float:
    """Mean over nodes of intersection by union, of angle bins and estimates together."""
    wanted = np.broadcast_to(true[..., None], found.shape)
    both, either = found & wanted & where[..., None], (found | wanted) & where[..., None]
    return float((both.sum(axis=(0, 2)) / np.maximum(either.sum(axis=(0, 2)), 1)).mean())


def _draw(shown: Floats, truths: dict[str, Floats], canvas: "Canvas") -> None:
    axes = canvas.subplots(2, 1, sharex=True)
    scans = SCHEDULE[0][0] + EVERY * np.arange(1, len(shown) + 1)
    for axis, level, column in zip(axes, ("long", "mid"), (0, 1), strict=True):
        axis.plot(scans, truths[level][:, 0], color="0.5", label="share of the past")
        axis.step(scans, shown[:, column], color="#c1440e", label="shown open")
        axis.axhline(0.5, color="0.8", linestyle=":")
        axis.set_ylabel(level)
    axes[0].legend()
    axes[1].set_xlabel("scans")
