"""What is odd about the times and poses of a recording, in sentences a robot engineer knows."""

import numpy as np

from timemap_cli.logs.batches import Float64s, Int64s
from timemap_cli.model.elementary import bearings, lengths

FAR_S = 10.0  # between stamps and log times: more than any buffer
CLOCK_JUMP_S = 1.0  # of the distance between stamps and log times
GAP_S = 2.0  # without a scan, and at least
GAP_PERIODS = 10.0  # times as long as usual
POSE_STEP_M, POSE_SPEED = 0.2, 3.0  # [m], [m/s] what no robot indoors does
POSE_TURN_RAD, POSE_RATE = 0.26, 6.3  # [rad], [rad/s]


def time_problems(topic: str, stamps_ns: Int64s, log_ns: Int64s) -> list[str]:
    """Sentences about the stamps (n,) and log times (n,) of a topic's scans, in the order of recording."""
    if len(stamps_ns) == 0:
        return []
    lag = (log_ns - stamps_ns) / 1e9
    return [
        *_unstamped(topic, stamps_ns),
        *_backward_steps(topic, stamps_ns),
        *_gaps(topic, stamps_ns),
        *_clocks(topic, lag),
    ]


def pose_problems(topic: str, stamps_ns: Int64s, map_from_laser: Float64s) -> list[str]:
    """A sentence about jumps of the poses (n, 3, 4) of a topic's scans at their stamps (n,)."""
    order = np.argsort(stamps_ns, kind="stable")
    poses, seconds = map_from_laser[order], (stamps_ns[order] - stamps_ns.min(initial=2**62)) / 1e9
    passed = np.maximum(np.diff(seconds), 1e-9)
    steps = lengths(np.diff(poses[:, :2, 3], axis=0))
    along = np.unwrap(bearings(poses[:, 0, 0], poses[:, 1, 0]))
    turns = np.abs(np.diff(along))
    jumps = (steps > POSE_STEP_M) & (steps > POSE_SPEED * passed)
    jumps |= (turns > POSE_TURN_RAD) & (turns > POSE_RATE * passed)
    if not jumps.any():
        return []
    where = np.flatnonzero(jumps)
    worst = where[np.argmax(steps[where] + turns[where])]
    worst_word = "worst" if len(where) > 1 else "namely"
    return [
        f"{topic}: the pose jumps {_times(len(where))}, {worst_word} at +{seconds[worst + 1]:.1f} s "
        f"by {steps[worst]:.2f} m and {np.degrees(turns[worst]):.0f} deg within {passed[worst]:.2f} s"
    ]


def duration(seconds: float) -> str:
    """A stretch of time as one says it."""
    if seconds < 100:
        return f"{seconds:.1f} s" if seconds >= 1 else f"{seconds:.2g} s"
    for unit, size, part, part_size in (
        ("min", 60, "s", 1),
        ("h", 3600, "min", 60),
        ("days", 86400, "h", 3600),
    ):
        parts = round(seconds / part_size)
        if seconds < 100 * size:
            per_unit = size // part_size
            return f"{parts // per_unit} {unit} {parts % per_unit} {part}"
    return f"{seconds / (365.25 * 86400):.1f} years"


def _unstamped(topic: str, stamps_ns: Int64s) -> list[str]:
    unset = int(np.count_nonzero(stamps_ns == 0))
    return [f"{topic}: {_many(unset, 'scan')} without a stamp"] if unset else []


def _backward_steps(topic: str, stamps_ns: Int64s) -> list[str]:
    steps = np.diff(stamps_ns) / 1e9
    back, same = int(np.count_nonzero(steps < 0)), int(np.count_nonzero(steps == 0))
    found = []
    if back:
        found.append(f"{topic}: stamps step back {_times(back)}, by up to {duration(-steps.min())}")
    if same:
        found.append(f"{topic}: {_many(same, 'scan')} with the stamp of the one before")
    return found


def _gaps(topic: str, stamps_ns: Int64s) -> list[str]:
    steps = np.diff(np.sort(stamps_ns)).astype(np.float64) / 1e9
    longest = float(steps.max(initial=0.0))
    limit = max(GAP_S, GAP_PERIODS * (float(np.median(steps)) if steps.size else 0.0))
    count = int(np.count_nonzero(steps > limit))
    return [f"{topic}: {_many(count, 'gap')} without scans, up to {duration(longest)}"] if count else []


def _clocks(topic: str, lag: Float64s) -> list[str]:
    found = []
    median = float(np.median(lag))
    if abs(median) > FAR_S:
        side = "after" if median > 0 else "before"
        found.append(
            f"{topic}: recorded {duration(abs(median))} {side} the stamps (other clock, or played back)"
        )
    jumps = np.abs(np.diff(lag))
    count = int(np.count_nonzero(jumps > CLOCK_JUMP_S))
    if count:
        worst = duration(float(jumps.max()))
        found.append(f"{topic}: stamps and log times drift apart {_times(count)}, by up to {worst} at once")
    return found


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _many(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
