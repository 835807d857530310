"""A recording's transforms, looked up as tf2 looks them up, for many stamps at once.

Rules of tf2 (``tf2::BufferCore``, ``tf2::TimeCache``) kept here: every frame has one parent at a time, which
may change; each edge is interpolated on its own (straight line and slerp) and never extrapolated; between
samples with different parents the older one holds; static edges hold at all times; a chain may go down as
well as up. tf2 forgets after 10 s and so never interpolates across a longer gap; neither does this.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.batches import Float64s, Int64s, TransformBatch
from timemap_cli.logs.history import NO_PARENT, Bools, History, Int32s, usable
from timemap_cli.logs.rigid import IDENTITY, compose, from_translation_rotation, invert
from timemap_cli.model.state import State, prefixed, without_prefix

Rows = NDArray[np.intp]
Path = tuple[str, ...]

MOST_FRAMES = 10_000  # bounds memory: a hundred robots have as many


class TransformBuffer:
    """Transforms between frames over time, forgetting what lies behind.

    Frame names have no leading slash. ``rejected`` counts transforms that cannot be used: a
    rotation of length zero, NaN, a place that cannot be on earth, a frame that is its own parent or has no name,
    new frames when there are MOST_FRAMES.
    """

    def __init__(self) -> None:
        self.rejected = 0
        self._names: list[str] = []
        self._codes: dict[str, int] = {}
        self._static: dict[str, tuple[int, Float64s]] = {}  # child -> parent, (1, 3, 4)
        self._moving: defaultdict[str, History] = defaultdict(History)  # child -> samples

    def __len__(self) -> int:
        """How many samples are held."""
        return len(self._static) + sum(len(history) for history in self._moving.values())

    def add(self, batch: TransformBatch) -> None:
        """Take in transforms. Of equal stamps the last received counts; a static edge replaces an older one.

        A frame that has both hangs on its static edge until its first moving sample, then on the moving one.
        """
        names_nothing = not batch.child or not batch.parent or batch.child == batch.parent
        if names_nothing or self._is_one_too_many(batch.child):
            self.rejected += len(batch.stamps_ns)
            return
        good, rotation = usable(batch.translation, batch.rotation)
        self.rejected += len(good) - int(np.count_nonzero(good))
        if not good.any():
            return
        parent = self._code(batch.parent)
        translation, rotation = batch.translation[good], rotation[good]
        if batch.static:
            self._static[batch.child] = parent, from_translation_rotation(translation[-1:], rotation[-1:])
        else:
            self._moving[batch.child].add(batch.stamps_ns[good], translation, rotation, parent)

    def _is_one_too_many(self, child: str) -> bool:
        is_new = child not in self._static and child not in self._moving
        return is_new and len(self._static) + len(self._moving) >= MOST_FRAMES

    def lookup(
        self, target: str, source: str, stamps_ns: Int64s, held: Mapping[str, Int64s] | None = None
    ) -> tuple[Float64s, Bools]:
        """Return ``target_from_source`` (n, 3, 4) at the stamps (n,), and where (n,) it is known.

        NaN elsewhere. A frame nobody ever mentioned is connected to itself alone. ``held`` gives other stamps (n,)
        for the edges of some children.
        """
        count = len(stamps_ns)
        result = np.full((count, 3, 4), np.nan)
        valid = np.zeros(count, dtype=bool)
        climb = _Climb(self, stamps_ns, held)
        for rows, up in climb.paths(source, {target}, np.arange(count)):
            for some, down in climb.paths(target, up, rows):
                if down[-1] in up:
                    target_from_common = invert(climb.along(down[:-1], some))
                    common_from_source = climb.along(up[: up.index(down[-1])], some)
                    result[some] = compose(target_from_common, common_from_source)
                    valid[some] = True
        return result, valid

    def moving_edges(self, target: str, source: str, stamps_ns: Int64s) -> tuple[str, ...]:
        """Return the children of the moving edges that a look-up at the stamps (n,) reads."""
        climb = _Climb(self, stamps_ns)
        for rows, up in climb.paths(source, {target}, np.arange(len(stamps_ns))):
            for _ in climb.paths(target, up, rows):
                pass
        return tuple(child for child in climb.children if child in self._moving)

    def around(self, child: str, first_ns: Int64s, last_ns: Int64s) -> tuple[Int64s, Int64s]:
        """Return the stamps (n,) of the samples of a moving edge that enclose the times; see ``History.around``."""
        return self._moving[child].around(first_ns, last_ns)

    def kept(self) -> State:
        """The moving transforms, for `restore`."""
        state: State = {"moving": list(self._moving)}
        for number, history in enumerate(self._moving.values()):
            kept = history.kept()
            # Codes are this buffer's alone: they go by what else it has met.
            used = sorted(np.unique(kept["parent"]).tolist(), key=self.name)
            places = np.zeros(len(self._names), np.int32)
            places[used] = np.arange(len(used))
            parents = {"parents": list(map(self.name, used)), "parent": places[kept["parent"]]}
            state |= prefixed(str(number), kept | parents)
        return state

    def restore(self, state: State) -> None:
        """Take over the moving transforms that another buffer kept; this one must have none."""
        for number, child in enumerate(state["moving"]):
            kept = without_prefix(str(number), state)
            codes = np.array([self._code(name) for name in kept["parents"]], np.int32)
            self._moving[child] = History.restored(kept | {"parent": codes[kept["parent"]]})

    def forget(self, before_ns: int) -> None:
        """Drop what look-ups from ``before_ns`` on do not need; each edge keeps its last sample before."""
        for history in self._moving.values():
            history.forget(before_ns)

    def forget_all_but(self, span_ns: int) -> None:
        """Drop what lies more than ``span_ns`` behind the newest sample of its edge."""
        for history in self._moving.values():
            history.forget(history.newest_ns - span_ns)

    def ancestors(self, frame: str, *, static_only: bool = False) -> tuple[str, ...]:
        """Return the frame and those above it, lowest first; of a moving edge the newest sample counts."""
        path = [frame]
        while True:
            if path[-1] in self._moving and not static_only:
                parent = self._names[self._moving[path[-1]].newest_parent]
            elif path[-1] in self._static and path[-1] not in self._moving:
                parent = self._names[self._static[path[-1]][0]]
            else:
                return tuple(path)
            if parent in path:
                return tuple(path)
            path.append(parent)

    def name(self, code: int) -> str:
        """Return the frame that a code of ``edge`` stands for."""
        return self._names[code]

    def edge(self, child: str, stamps_ns: Int64s) -> tuple[Int32s, Float64s]:
        """Return the codes of the parents (n,) and ``parent_from_child`` (n, 3, 4), or one for all."""
        parent, fixed = self._static.get(child, (NO_PARENT, IDENTITY[None]))
        if child not in self._moving:
            return np.array([parent], np.int32), fixed
        history = self._moving[child]
        parents, parent_from_child = history.sample(stamps_ns)
        if child in self._static:
            before = stamps_ns < history.first_ns
            parents[before], parent_from_child[before] = parent, fixed
        return parents, parent_from_child

    def _code(self, name: str) -> int:
        if name not in self._codes:
            self._codes[name] = len(self._names)
            self._names.append(name)
        return self._codes[name]


class _Climb:
    """Ways from a frame towards the root at many stamps; every edge is read once."""

    def __init__(
        self, buffer: TransformBuffer, stamps_ns: Int64s, held: Mapping[str, Int64s] | None = None
    ) -> None:
        self._buffer = buffer
        self._stamps_ns = stamps_ns
        self._held = held or {}
        self._edges: dict[str, tuple[Int32s, Float64s]] = {}

    @property
    def children(self) -> tuple[str, ...]:
        """Frames whose edges were read so far."""
        return tuple(self._edges)

    def paths(self, start: str, stop: Collection[str], rows: Rows) -> Iterator[tuple[Rows, Path]]:
        """Yield the ways up from ``start`` to one of ``stop`` or to where nothing leads on."""
        waiting: list[tuple[Rows, Path]] = [(rows, (start,))]
        while waiting:
            rows, path = waiting.pop()
            if path[-1] in stop:
                yield rows, path
                continue
            parents, _ = self._edge(path[-1])
            for code in np.unique(parents if len(parents) == 1 else parents[rows]).tolist():
                some = rows if len(parents) == 1 else rows[parents[rows] == code]
                if code == NO_PARENT or (parent := self._buffer.name(code)) in path:
                    yield some, path
                else:
                    waiting.append((some, (*path, parent)))

    def along(self, path: Path, rows: Rows) -> Float64s:
        """Return the transform (len(rows) or 1, 3, 4) from a path's first to its last one's parent."""
        top_from_first: Float64s = IDENTITY[None]
        for frame in path:
            _, parent_from_frame = self._edge(frame)
            picked = parent_from_frame if len(parent_from_frame) == 1 else parent_from_frame[rows]
            top_from_first = compose(picked, top_from_first)
        return top_from_first

    def _edge(self, child: str) -> tuple[Int32s, Float64s]:
        if child not in self._edges:
            self._edges[child] = self._buffer.edge(child, self._held.get(child, self._stamps_ns))
        return self._edges[child]
