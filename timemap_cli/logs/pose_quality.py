"""How far a pose can be trusted: the standard deviations its source states, and jumps of the transforms around it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from timemap_cli.logs.batches import Float64s, Int64s, PoseBatch
from timemap_cli.logs.history import MAX_GAP_NS, MAX_SAMPLES, Bools
from timemap_cli.model.state import State

UNCERTAIN, JUMP = "uncertain_pose", "pose_jump"  # reasons for setting a scan aside


@dataclass(frozen=True, slots=True)
class PoseQuality:
    """Of n poses."""

    position_std: Float64s  # (n,) [m] in the worst direction; NaN where unknown
    yaw_std: Float64s  # (n,) [rad]; NaN where unknown
    jump: Float64s  # (n,) [m] between the transforms around the pose, see ``jumps``

    def rows(self, rows: Bools) -> PoseQuality:
        """That of these poses alone."""
        return PoseQuality(self.position_std[rows], self.yaw_std[rows], self.jump[rows])

    @classmethod
    def joined(cls, parts: Sequence[PoseQuality]) -> PoseQuality:
        """That of all poses of the parts."""
        columns = ([getattr(part, name) for part in parts] for name in ("position_std", "yaw_std", "jump"))
        return cls(*(np.concatenate([*column, np.empty(0)]) for column in columns))


@dataclass(frozen=True, slots=True)
class PoseLimits:
    """How good a pose must be for its scan to be used. A zero leaves its criterion out."""

    position_std: float = 0.0  # [m]
    yaw_std: float = 0.0  # [rad]
    jump: float = 0.0  # [m]

    def set_aside(self, quality: PoseQuality) -> dict[str, Bools]:
        """Which scans (n,) to set aside, by reason; each under one. What is not known is believed."""
        uncertain = _beyond(quality.position_std, self.position_std) | _beyond(quality.yaw_std, self.yaw_std)
        return {UNCERTAIN: uncertain, JUMP: _beyond(quality.jump, self.jump) & ~uncertain}


NO_LIMITS = PoseLimits()


def _beyond(values: Float64s, limit: float) -> Bools:
    return np.asarray(values > limit) if limit else np.zeros(len(values), np.bool_)


@dataclass(frozen=True, slots=True)
class PoseReport:
    """How good the poses of a topic's scans are."""

    covariances: str | None  # topic that tells how uncertain they are
    position_std: float | None  # [m] the largest; None: unknown
    yaw_std: float | None  # [rad]
    jumps: int  # larger than the limit: runs of scans that were set aside for it
    largest_jump: float  # [m] of those; 0 if there are none
    largest_jump_ns: int  # stamp of the first scan within it
    set_aside: Mapping[str, int]  # scans by reason


def report(
    stamps_ns: Int64s, quality: PoseQuality, limits: PoseLimits, covariances: str | None
) -> PoseReport:
    """Sum up the quality of the poses at the stamps (n,), in any order."""
    order = np.argsort(stamps_ns, kind="stable")
    stamps, jump = stamps_ns[order], quality.jump[order]
    within = _beyond(jump, limits.jump)
    worst = int(np.argmax(jump)) if within.any() else None
    return PoseReport(
        covariances,
        _largest(quality.position_std),
        _largest(quality.yaw_std),
        int(np.count_nonzero(np.diff(within, prepend=False) & within)),
        0.0 if worst is None else float(jump[worst]),
        0 if worst is None else int(stamps[worst]),
        {reason: int(np.count_nonzero(worse)) for reason, worse in limits.set_aside(quality).items()},
    )


def _largest(values: Float64s) -> float | None:
    known = values[~np.isnan(values)]
    return float(known.max()) if len(known) else None


class Deviations:
    """Standard deviations of position and yaw over time, from the covariances of a topic's poses."""

    def __init__(self) -> None:
        self._stamps: Int64s = np.empty(0, np.int64)
        self._values: Float64s = np.empty((0, 2))

    def add(self, batch: PoseBatch) -> None:
        """Take in the covariances of poses, in any order. Of equal stamps the last received counts."""
        if batch.covariance is None or not len(batch.stamps_ns):
            return
        stamps = np.concatenate([self._stamps, batch.stamps_ns])
        order = np.argsort(stamps, kind="stable")
        ordered = stamps[order]
        order = order[np.append(ordered[1:] != ordered[:-1], True)]
        if len(order) > MAX_SAMPLES:
            order = order[-MAX_SAMPLES // 2 :]
        self._stamps = stamps[order]
        self._values = np.concatenate([self._values, standard_deviations(batch.covariance)])[order]

    def at(self, stamps_ns: Int64s) -> tuple[Float64s, Float64s]:
        """Standard deviations of position [m] and yaw [rad] (n,) at the stamps (n,); NaN where unknown.

        The larger of the two neighbours', as the pose lies between theirs. Who stands sends no poses: after a gap
        of 10 s or more the older neighbour's hold alone.
        """
        if not len(self._stamps):
            return np.full(len(stamps_ns), np.nan), np.full(len(stamps_ns), np.nan)
        older = np.searchsorted(self._stamps, stamps_ns, side="right") - 1
        newer = np.minimum(older + 1, len(self._stamps) - 1)
        is_near = self._stamps[newer] - self._stamps[np.maximum(older, 0)] <= MAX_GAP_NS
        newer = np.where(is_near & (self._stamps[np.maximum(older, 0)] != stamps_ns), newer, older)
        found = np.fmax(self._values[older], self._values[newer])
        found[older < 0] = np.nan
        return found[:, 0], found[:, 1]

    def kept(self) -> State:
        """All of them, for `restore`."""
        return {"stamps_ns": self._stamps, "values": self._values}

    def restore(self, state: State) -> None:
        """Take over what others kept; there must be none yet."""
        self._stamps, self._values = state["stamps_ns"], state["values"]

    def forget(self, before_ns: int) -> None:
        """Drop what stamps from ``before_ns`` on do not need."""
        keep = max(0, int(np.searchsorted(self._stamps, before_ns)) - 1)
        self._stamps, self._values = self._stamps[keep:].copy(), self._values[keep:].copy()

    def forget_all_but(self, span_ns: int) -> None:
        """Drop what lies more than ``span_ns`` behind the newest."""
        if len(self._stamps):
            self.forget(int(self._stamps[-1]) - span_ns)


def standard_deviations(covariance: Float64s) -> Float64s:
    """Standard deviations (n, 2) of position [m], in its worst direction, and yaw [rad] from (n, 6, 6).

    NaN where the covariance says nothing: all zeros, a first element of -1, negative or not finite variances.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        xx, yy, xy = covariance[:, 0, 0], covariance[:, 1, 1], covariance[:, 0, 1]
        half = (xx - yy) / 2
        largest = (xx + yy) / 2 + np.sqrt(half * half + xy * xy)
        found = np.sqrt(np.stack([largest, covariance[:, 5, 5]], axis=1))
    says_nothing = (covariance == 0).all(axis=(1, 2)) | (xx < 0) | (yy < 0)
    found[says_nothing | np.isnan(found).any(axis=1)] = np.nan
    return found
