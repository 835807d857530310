"""The samples of one frame's pose in its parent over time: kept in stamp order, read between samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.batches import Float64s, Int64s
from timemap_cli.logs.rigid import from_translation_rotation, interpolate
from timemap_cli.model.state import State

Bools = NDArray[np.bool_]
Int32s = NDArray[np.int32]

MAX_GAP_NS = 10_000_000_000  # tf2 keeps 10 s by default, so it never sees both ends of a longer gap
MAX_SAMPLES = 200_000  # bounds memory where stamps lie in the future and so are never behind
LEAST_NORM = 1e-6
# Map coordinates reach 1e7 m north (UTM) and 6e7 m east (Gauss-Krueger with its zone): beyond is no place on earth.
FARTHEST_M = 1e8
NO_PARENT = -1


def usable(translation: Float64s, rotation: Float64s) -> tuple[Bools, Float64s]:
    """Tell which samples (n,) are poses at all; return the quaternions (n, 4), normalised where they are."""
    squares = rotation * rotation
    norm = np.sqrt(squares[:, 0] + squares[:, 1] + squares[:, 2] + squares[:, 3])
    good = np.isfinite(norm) & (norm > LEAST_NORM) & (np.abs(translation) <= FARTHEST_M).all(axis=1)
    return good, rotation / np.where(good, norm, 1.0)[:, None]


class History:
    """Poses ``parent_from_child`` of one child; the parent may change from sample to sample.

    Parents are given as codes >= 0. Of samples with equal stamps the last one added counts. ``first_ns`` is the
    smallest stamp there ever was, even if it was forgotten.
    """

    def __init__(self) -> None:
        self.first_ns = np.iinfo(np.int64).max
        self._stamps: Int64s = np.empty(0, np.int64)
        self._translation: Float64s = np.empty((0, 3))
        self._rotation: Float64s = np.empty((0, 4))
        self._parent: Int32s = np.empty(0, np.int32)
        self._fresh: list[tuple[Int64s, Float64s, Float64s, Int32s]] = []
        self._fresh_count = 0

    def __len__(self) -> int:
        return len(self._stamps) + self._fresh_count

    @property
    def newest_ns(self) -> int:
        """Largest stamp; there must be one."""
        self._settle()
        return int(self._stamps[-1])

    @property
    def newest_parent(self) -> int:
        """Code of the newest sample's parent; there must be one."""
        self._settle()
        return int(self._parent[-1])

    def add(self, stamps_ns: Int64s, translation: Float64s, rotation: Float64s, parent: int) -> None:
        """Take in samples (n,), (n, 3), unit quaternions (n, 4), in any order; at least one."""
        self.first_ns = min(self.first_ns, int(stamps_ns.min()))
        self._fresh.append((stamps_ns, translation, rotation, np.full(len(stamps_ns), parent, np.int32)))
        self._fresh_count += len(stamps_ns)
        if self._fresh_count > MAX_SAMPLES:
            self._settle()

    def kept(self) -> State:
        """All samples, for `restored`."""
        self._settle()
        return {
            "first_ns": int(self.first_ns),
            "stamps_ns": self._stamps,
            "translation": self._translation,
            "rotation": self._rotation,
            "parent": self._parent,
        }

    @classmethod
    def restored(cls, state: State) -> History:
        """The history that was kept."""
        history = cls()
        history.first_ns, history._stamps = state["first_ns"], state["stamps_ns"]
        history._translation, history._rotation = state["translation"], state["rotation"]
        history._parent = state["parent"]
        return history

    def forget(self, before_ns: int) -> None:
        """Drop the samples before a stamp, except the last of them."""
        self._settle()
        keep = max(0, int(np.searchsorted(self._stamps, before_ns)) - 1)
        if keep:
            self._keep(slice(keep, None))

    def sample(self, stamps_ns: Int64s) -> tuple[Int32s, Float64s]:
        """Return parent codes (n,) and ``parent_from_child`` (n, 3, 4) at the stamps (n,).

        ``NO_PARENT`` and any transform before and after the samples and inside a gap > ``MAX_GAP_NS``.
        Between samples of different parents the older sample holds (tf2).
        """
        self._settle()
        if not len(self._stamps):
            return np.full(len(stamps_ns), NO_PARENT, np.int32), np.zeros((len(stamps_ns), 3, 4))
        older = np.searchsorted(self._stamps, stamps_ns, side="right") - 1
        inside = older >= 0
        older = np.maximum(older, 0)
        since = stamps_ns - self._stamps[older]
        newer = np.where(since > 0, np.minimum(older + 1, len(self._stamps) - 1), older)
        gap = self._stamps[newer] - self._stamps[older]
        inside &= (since == 0) | ((gap > 0) & (gap <= MAX_GAP_NS))
        newer = np.where(self._parent[newer] == self._parent[older], newer, older)
        ratio = np.where(newer != older, since / np.maximum(gap, 1), 0.0)
        translation, rotation = interpolate(
            (self._translation[older], self._translation[newer]),
            (self._rotation[older], self._rotation[newer]),
            ratio,
        )
        parents = np.where(inside, self._parent[older], np.int32(NO_PARENT))
        return parents, from_translation_rotation(translation, rotation)

    def around(self, first_ns: Int64s, last_ns: Int64s) -> tuple[Int64s, Int64s]:
        """Return the stamps (n,) of the last sample not after ``first_ns`` and the first not before ``last_ns``.

        The outermost sample where there is none; the older for both where the parent changes in between, as no
        interpolation crosses that. There must be a sample.
        """
        self._settle()
        older = np.maximum(np.searchsorted(self._stamps, first_ns, side="right") - 1, 0)
        newer = np.minimum(np.searchsorted(self._stamps, last_ns), len(self._stamps) - 1)
        newer = np.where(self._parent[older] == self._parent[newer], np.maximum(older, newer), older)
        return self._stamps[older], self._stamps[newer]

    def _settle(self) -> None:
        """Merge what was added since into stamp order."""
        if not self._fresh:
            return
        parts = [(self._stamps, self._translation, self._rotation, self._parent), *self._fresh]
        self._fresh, self._fresh_count = [], 0
        self._stamps = np.concatenate([part[0] for part in parts])
        self._translation = np.concatenate([part[1] for part in parts])
        self._rotation = np.concatenate([part[2] for part in parts])
        self._parent = np.concatenate([part[3] for part in parts])
        if (np.diff(self._stamps) <= 0).any():
            order = np.argsort(self._stamps, kind="stable")
            ordered = self._stamps[order]
            self._keep(order[np.append(ordered[1:] != ordered[:-1], True)])
        if len(self._stamps) > MAX_SAMPLES:
            self._keep(slice(len(self._stamps) - MAX_SAMPLES // 2, None))

    def _keep(self, rows: slice | NDArray[np.intp]) -> None:
        # Copies: a slice would keep the forgotten samples in memory.
        self._stamps = self._stamps[rows].copy()
        self._translation = self._translation[rows].copy()
        self._rotation = self._rotation[rows].copy()
        self._parent = self._parent[rows].copy()
