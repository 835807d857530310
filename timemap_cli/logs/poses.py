"""Where the laser was: from the transforms, or from a topic of poses and the transforms below it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from timemap_cli.logs.batches import Float64s, Int64s, PoseBatch, TransformBatch
from timemap_cli.logs.history import Bools
from timemap_cli.logs.interleave import RecordedTopic
from timemap_cli.logs.jumps import jumps
from timemap_cli.logs.pose_quality import Deviations, PoseQuality
from timemap_cli.logs.rigid import compose
from timemap_cli.logs.transforms import TransformBuffer
from timemap_cli.model.state import State, prefixed, without_prefix

TF = "tf"  # what a selection says where poses come from the transforms
TRANSFORM_TYPES = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
# What the base of a robot is usually called (REP 105, REP 120), for poses that do not say what they are of.
BASE_FRAMES = ("base_footprint", "base_link")
# No frame can have this name, so the poses of a topic can live among the transforms.
_POSED = "/posed"


def transform_topics(topics: Iterable[RecordedTopic]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of a recording's topics of moving and of static transforms.

    Where there is a plain ``/tf`` or ``/tf_static``, those under a namespace are another robot's.
    """
    names = [topic.name for topic in topics if topic.msgtype in TRANSFORM_TYPES]
    plain = [name for name in names if name in ("/tf", "/tf_static")]
    chosen = sorted(set(plain or names))
    static = tuple(name for name in chosen if name.rsplit("/", 1)[-1] == "tf_static")
    return tuple(name for name in chosen if name not in static), static


class PoseSource:
    """Poses of the laser in the map frame, from transforms (``topic`` is ``"tf"``) or a topic of poses.

    A topic's poses are looked up by the rules of the transforms: interpolated, never extrapolated.
    They are poses of the frame the messages name (Odometry's ``child_frame_id``), else of
    ``base_footprint`` or ``base_link`` if the laser hangs below it, else of the frame at the top of the
    static transforms above the laser; that is the laser itself where there are none. Poses in another
    frame than the map frame are taken there by the transforms. ``covariances`` names the topic that tells how
    uncertain the poses are.
    """

    def __init__(self, map_frame: str, topic: str = TF, covariances: str | None = None) -> None:
        self._map_frame = map_frame.lstrip("/")
        self._topic = None if topic == TF else topic
        self.covariances = covariances
        self._deviations = Deviations()
        self._child: str | None = None
        self._buffer = TransformBuffer()

    @property
    def rejected(self) -> int:
        """How many transforms and poses could not be used."""
        return self._buffer.rejected

    def add(self, batch: TransformBatch | PoseBatch) -> None:
        """Take in transforms, or poses; poses of another topic than the chosen one are passed over."""
        if isinstance(batch, TransformBatch):
            self._buffer.add(batch)
            return
        if batch.topic == self.covariances:
            self._deviations.add(batch)
        if batch.topic == self._topic:
            self._child = batch.child_frame_id or self._child
            parent = batch.frame_id or self._map_frame
            stamps, logged = batch.stamps_ns, batch.log_ns
            self._buffer.add(
                TransformBatch(parent, _POSED, False, stamps, logged, batch.translation, batch.rotation)
            )

    def lookup(self, laser: str, stamps_ns: Int64s) -> tuple[Float64s, Bools]:
        """Return ``map_from_laser`` (n, 3, 4) at the stamps (n,), and where (n,) it is known."""
        if self._topic is None:
            return self._buffer.lookup(self._map_frame, laser, stamps_ns)
        map_from_base, base_known = self._buffer.lookup(self._map_frame, _POSED, stamps_ns)
        base_from_laser, laser_known = self._buffer.lookup(self._base(laser), laser, stamps_ns)
        return compose(map_from_base, base_from_laser), base_known & laser_known

    def sweep(self, laser: str, stamps_ns: Int64s, duration_ns: Int64s) -> tuple[Float64s, Float64s, Bools]:
        """Return ``map_from_laser`` (n, 3, 4) at the first and last beams, and where (n,) both are known.

        ``duration_ns`` (n,) is the time from the first to the last beam; negative where the beams are
        stored last to first. Where the poses end (or pause) during a sweep, the pose at its earlier end
        stands for both ends: transforms stamped like the scans have none for the end of the last sweep.
        """
        if not duration_ns.any():
            first, known = self.lookup(laser, stamps_ns)
            return first, first, known
        both, known = self.lookup(laser, np.concatenate([stamps_ns, stamps_ns + duration_ns]))
        count = len(stamps_ns)
        first, last, first_known, last_known = both[:count], both[count:], known[:count], known[count:]
        cut_last = first_known & ~last_known & (duration_ns > 0)
        cut_first = last_known & ~first_known & (duration_ns < 0)
        last[cut_last] = first[cut_last]
        first[cut_first] = last[cut_first]
        return first, last, (first_known & last_known) | cut_last | cut_first

    def quality(self, laser: str, stamps_ns: Int64s, duration_ns: Int64s) -> PoseQuality:
        """Return how good the poses of ``sweep`` are, for those that are known."""
        first_ns, last_ns = stamps_ns + np.minimum(duration_ns, 0), stamps_ns + np.maximum(duration_ns, 0)
        moving = laser if self._topic is None else _POSED
        return PoseQuality(
            *self._deviations.at(stamps_ns), jumps(self._buffer, self._map_frame, moving, first_ns, last_ns)
        )

    def kept(self) -> State:
        """Poses and moving transforms, for `restore`."""
        return {
            "child": self._child,
            **self._buffer.kept(),
            **prefixed("deviations", self._deviations.kept()),
        }

    def restore(self, state: State) -> None:
        """Take over what another source kept; this one must have nothing but static transforms."""
        self._child = state["child"]
        self._buffer.restore(state)
        self._deviations.restore(without_prefix("deviations", state))

    def forget(self, before_ns: int) -> None:
        """Drop what look-ups from ``before_ns`` on do not need."""
        self._buffer.forget(before_ns)
        self._deviations.forget(before_ns)

    def forget_all_but(self, span_ns: int) -> None:
        """Drop what lies more than ``span_ns`` behind the newest of its kind."""
        self._buffer.forget_all_but(span_ns)
        self._deviations.forget_all_but(span_ns)

    def _base(self, laser: str) -> str:
        """The frame that the topic's poses are of."""
        if self._child is not None:
            return self._child
        above = self._buffer.ancestors(laser)
        named = [frame for frame in BASE_FRAMES if frame in above]
        return named[0] if named else self._buffer.ancestors(laser, static_only=True)[-1]
