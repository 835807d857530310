"""Writes a result: one MCAP that ROS 2 tools open, and that timemap reads back to the last bit."""

import json
import pickle
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self, cast

import numpy as np
from mcap.writer import CompressionType, IndexType, Writer
from zstandard import compress, decompress

from timemap_cli import __version__
from timemap_cli.changes.events import Event, Transition
from timemap_cli.errors import TimemapError
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.level_map import merged_points, occupancy_grid
from timemap_cli.model.nodes import Node
from timemap_cli.results import channels, definitions, state_messages
from timemap_cli.results.atomic_file import AtomicFile
from timemap_cli.results.change_messages import pack_change, pack_markers
from timemap_cli.results.channels import LevelTopic
from timemap_cli.results.container import is_result
from timemap_cli.results.layouts import pack_scans, pack_statuses
from timemap_cli.results.messages import NodeFrames, pack_grid, pack_points
from timemap_cli.results.state_messages import StatePart, pack_state

VIEWERS_SPAN_NS = 93 * 24 * 3600 * 1_000_000_000  # Foxglove and Lichtblick refuse files that span more


class ResultWriter:
    """A result in the making; its file appears at `finish`, whole, or not at all.

    Use it as a context manager: leaving it without `finish`, by an exception or Ctrl-C too, leaves no file
    behind. Messages come in log-time order, so the log time of an estimate is its own stamp, or that of the
    message before where it is older. The same calls give the same bytes.

    Raises UsageError if the path exists and `force` is not given, or if it is anything else than a result;
    TimemapError where it cannot be written.
    """

    def __init__(
        self,
        path: Path,
        *,
        levels: Sequence[str],
        angle_bins: int,
        radius: float,
        map_frame: str,
        force: bool = False,
    ) -> None:
        self._levels = tuple(levels)
        self._angle_bins = angle_bins
        self._radius = radius
        self._map_frame = map_frame
        self._range_max = _float32_not_below(radius)
        self._frames = NodeFrames(map_frame)
        self._frames_written = 0
        self._frames_due_ns: int | None = None
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._counts: dict[int, int] = {}
        self._first_ns: int | None = None
        self._now_ns = 0
        self._held_state: list[bytes] = []  # packed: a resumed map may be large
        self._file = AtomicFile(path, force=force, may_replace=is_result)
        self._mcap = Writer(
            cast(IO[bytes], self._file), compression=CompressionType.ZSTD, index_types=IndexType.ALL
        )
        self._mcap.start(profile="ros2", library=f"timemap {__version__}")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.discard()

    @property
    def span_ns(self) -> int:
        """Time between the first message and the last [ns]; see VIEWERS_SPAN_NS."""
        return self._now_ns - (self._now_ns if self._first_ns is None else self._first_ns)

    def write_nodes(self, nodes: Sequence[Node], stamp_ns: int) -> None:
        """Make nodes known: all of them, those known before first.

        The frames of new ones are written before what comes next, not later than `stamp_ns`.
        """
        self._frames.extend(tuple(nodes))
        if len(nodes) > self._frames_written and self._frames_due_ns is None:
            self._frames_due_ns = stamp_ns

    def write_estimates(self, estimates: Sequence[Estimate], stamp_ns: int) -> None:
        """Write a scan and a status for each estimate, made when the newest scan replayed was `stamp_ns`.

        Raises ValueError for an estimate newer than that, for an unknown node or level, and for a finite
        range beyond the radius.
        """
        for one in estimates:
            self._refuse_misplaced(one, stamp_ns)
        ordered = sorted(estimates, key=lambda e: (e.stamp_ns, e.node, self._levels.index(e.level)))
        if ordered:
            self._write_frames(ordered[0].stamp_ns)
        scans = pack_scans(ordered, self._angle_bins, self._range_max)
        statuses = pack_statuses(ordered, self._angle_bins)
        for estimate, scan, status in zip(ordered, scans, statuses, strict=True):
            now_ns = self._advance(estimate.stamp_ns)
            self._add_of_level(LevelTopic.SCAN, estimate.level, scan, now_ns)
            self._add_of_level(LevelTopic.STATUS, estimate.level, status, now_ns)

    def write_maps(
        self, estimates_by_level: Mapping[str, Mapping[int, Estimate]], nodes: Sequence[Node], stamp_ns: int
    ) -> None:
        """Write every level as points and as a grid, in the map frame; estimates by node."""
        self._write_frames(stamp_ns)
        now_ns = self._advance(stamp_ns)
        for level, by_node in estimates_by_level.items():
            estimates = dict(sorted(by_node.items()))  # not in the order in which they came first
            points = pack_points(merged_points(nodes, estimates), stamp_ns, self._map_frame)
            self._add_of_level(LevelTopic.POINTS, level, points, now_ns)
            grid = pack_grid(occupancy_grid(nodes, estimates, self._radius), stamp_ns, self._map_frame)
            self._add_of_level(LevelTopic.MAP, level, grid, now_ns)

    def write_changes(
        self, transitions: Sequence[Transition], events: Sequence[Event], stamp_ns: int
    ) -> None:
        """Write what was found out about change events when the newest scan replayed was `stamp_ns`.

        `events` are all events as they are then: the markers show those that hold.
        """
        now_ns = self._advance(stamp_ns)
        for transition in transitions:
            message = pack_change(transition, now_ns, self._map_frame)
            self._add(channels.CHANGE_TOPIC, definitions.CHANGE, message, now_ns, latched=False)
        markers = pack_markers(events, now_ns, self._map_frame)
        self._add(channels.MARKER_TOPIC, definitions.MARKERS, markers, now_ns, latched=True)

    def write_known(self, nodes: Sequence[Node], estimates: Sequence[Estimate], stamp_ns: int) -> None:
        """Write what an earlier result knew, as known at `stamp_ns`: a result holds every node's newest estimates.

        All are logged at that time, so that a result does not span what lies between.
        """
        self._advance(stamp_ns)
        self.write_nodes(nodes, stamp_ns)
        newest_ns = max((one.stamp_ns for one in estimates), default=stamp_ns)
        self.write_estimates(estimates, max(stamp_ns, newest_ns))  # newer where a clock began anew

    def write_state(self, kept: StatePart, stamp_ns: int | None) -> None:
        """Write a part of what a later replay needs, when the newest scan replayed was `stamp_ns`.

        None: nothing was replayed yet. Then it is held back, and logged with what comes first.
        """
        if stamp_ns is None:
            self._held_state.append(compress(pickle.dumps(kept)))
            return
        now_ns = self._advance(stamp_ns)
        message = pack_state(kept, now_ns, self._map_frame)
        self._add(channels.STATE_TOPIC, definitions.STATE, message, now_ns, latched=False)

    def finish(
        self,
        metadata: Mapping[str, str],
        config_yaml: str,
        report: Mapping[str, Any],
        changes: Mapping[str, Any],
    ) -> None:
        """Write what describes the whole, and put the file in its place.

        Raises TimemapError if nothing was written: an empty result helps nobody.
        """
        if self._first_ns is None:  # not one message
            raise TimemapError("there is nothing to write: no scan could be used")
        self._attach(channels.CONFIG, "application/yaml", config_yaml)
        for name, document in ((channels.REPORT, report), (channels.CHANGES, changes)):
            text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
            self._attach(name, "application/json", text + "\n")
        self._mcap.add_metadata(channels.METADATA, {**metadata, **self._own_metadata()})
        self._mcap.finish()  # type: ignore[no-untyped-call]
        self._file.commit()

    def _refuse_misplaced(self, one: Estimate, stamp_ns: int) -> None:
        if one.level not in self._levels:
            raise ValueError(f"an estimate of an unknown level: {one.level}")
        if one.node >= len(self._frames.nodes):
            raise ValueError(f"an estimate of a node that was not written: {one.node}")
        if one.stamp_ns > stamp_ns:
            raise ValueError(f"an estimate is newer than the newest scan: {one.stamp_ns} > {stamp_ns}")

    def _write_frames(self, next_ns: int) -> None:
        """Write the nodes' frames if any is new, not later than the message that comes next."""
        if self._frames_due_ns is None:
            return
        now_ns = self._advance(min(self._frames_due_ns, next_ns))
        message = self._frames.message(now_ns)
        self._add(channels.TF_STATIC, definitions.TF_MESSAGE, message, now_ns, latched=True)
        self._frames_written = len(self._frames.nodes)
        self._frames_due_ns = None

    def _own_metadata(self) -> dict[str, str]:
        return {
            "format": channels.FORMAT,
            "version": __version__,
            "levels": ",".join(self._levels),
            "angle_bins": str(self._angle_bins),
            "radius": repr(self._radius),
            "map_frame": self._map_frame,
            "nodes": str(len(self._frames.nodes)),
            "state": state_messages.FORMAT,
        }

    def _attach(self, name: str, media_type: str, text: str) -> None:
        self._mcap.add_attachment(self._now_ns, self._now_ns, name, media_type, text.encode())

    def _advance(self, stamp_ns: int) -> int:
        """Log time of a message with this stamp."""
        if self._first_ns is None:
            self._first_ns = self._now_ns = stamp_ns
            for kept in self._held_state:
                self.write_state(pickle.loads(decompress(kept)), stamp_ns)
            self._held_state.clear()
        self._now_ns = max(self._now_ns, stamp_ns)
        return self._now_ns

    def _add_of_level(self, topic: LevelTopic, level: str, message: bytes, now_ns: int) -> None:
        msgtype, latched = channels.MSGTYPES[topic], topic in channels.LATCHED
        self._add(topic.of(level), msgtype, message, now_ns, latched=latched)

    def _add(self, topic: str, msgtype: str, message: bytes, now_ns: int, *, latched: bool) -> None:
        """Append a message; the first one of a topic declares its channel, so that no channel is empty."""
        if topic not in self._channels:
            if msgtype not in self._schemas:
                text = definitions.definition(msgtype).encode()
                self._schemas[msgtype] = self._mcap.register_schema(msgtype, "ros2msg", text)
            qos = channels.offered_qos_profiles(latched=latched)
            self._channels[topic] = self._mcap.register_channel(
                topic, "cdr", self._schemas[msgtype], {"offered_qos_profiles": qos}
            )
        channel = self._channels[topic]
        self._counts[channel] = self._counts.get(channel, 0) + 1
        self._mcap.add_message(channel, now_ns, message, now_ns, self._counts[channel])


def _float32_not_below(value: float) -> np.float32:
    """The least float32 that is not below the value, so that no range up to it lies outside."""
    rounded = np.float32(value)
    return rounded if float(rounded) >= value else np.nextafter(rounded, np.float32(np.inf))
