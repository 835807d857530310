"""Reads a result back: nodes, settings, and the estimates of one level at one time."""

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from timemap_cli.errors import TimemapError, shown
from timemap_cli.model.elementary import distance
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import MOST_NODES
from timemap_cli.plain_yaml import plain_values
from timemap_cli.results import channels
from timemap_cli.results.channels import LevelTopic
from timemap_cli.results.container import ResultFile
from timemap_cli.results.documents import (
    CHANGES_FORMAT,
    REPORT_FORMAT,
    check_changes,
    check_dropped,
    check_inputs,
    check_report,
    parsed,
)
from timemap_cli.results.layouts import frame_of, unpack_estimate
from timemap_cli.results.messages import unpack_nodes
from timemap_cli.results.state_messages import FORMAT as STATE_FORMAT
from timemap_cli.results.state_messages import StatePart, unpack_state
from timemap_cli.versions import require_readable

_LEVEL = re.compile("[a-z][a-z0-9_]{0,254}")
_MOST_BINS = 3600  # what settings allow
_FARTHEST_M = 1e9
_MOST_LEVELS = 100
_ANEW = "make it again with `timemap replay`"


class ResultReader:
    """A result opened for reading, also a context manager.

    Raises UsageError if there is no such file, or if it is a recording or anything else than a result;
    and if another version of timemap wrote it in a format that this one does not read; TimemapError where it is
    damaged, then or at any later call.
    """

    def __init__(self, path: Path) -> None:
        self._file = ResultFile(path)
        try:
            self.path = path
            self.metadata = self._file.metadata
            self._check_format()
            self.levels = tuple(self.metadata["levels"].split(","))
            self.angle_bins = int(self.metadata["angle_bins"])
            self.radius = float(self.metadata["radius"])  # [m]
            self._check_dimensions()
            self.map_frame = self.metadata["map_frame"]
            self.start_ns, self.end_ns = self._file.span_ns
            self.nodes = self._read_nodes()
        except (KeyError, ValueError, struct.error) as error:
            self._file.close()
            raise self._unreadable() from error
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @property
    def config(self) -> str:
        """The settings of the replay, as YAML."""
        return self._file.attachment(channels.CONFIG)

    @property
    def report(self) -> dict[str, Any]:
        """The report of the replay."""
        try:
            return check_report(self._document(channels.REPORT, REPORT_FORMAT))
        except ValueError as error:
            raise self._unreadable() from error

    @property
    def changes(self) -> dict[str, Any]:
        """The change events of the replay, schema timemap.changes/1."""
        try:
            document = self._document(channels.CHANGES, CHANGES_FORMAT)
            return check_changes(document, self.levels, len(self.nodes))
        except ValueError as error:
            raise self._unreadable() from error

    @property
    def inputs(self) -> list[dict[str, str]]:
        """Name and SHA-256 of each recording; none where the result does not tell."""
        try:
            return check_inputs(parsed(self.metadata.get("inputs", "[]")))
        except ValueError as error:
            raise self._unreadable() from error

    @property
    def settings(self) -> dict[str, Any]:
        """The settings of the replay, as nested mappings; they may be those of another version."""
        try:
            settings = plain_values(self.config)
        except ValueError as error:
            raise self._unreadable() from error
        if not isinstance(settings, dict):
            raise self._unreadable()
        return settings

    @property
    def scans(self) -> tuple[int, int, dict[str, int]]:
        """How many scans were read, how many used, and how many dropped by reason."""
        read, used = (self.metadata.get(name, "0") for name in ("scans_read", "scans_used"))
        try:
            dropped = check_dropped(parsed(self.metadata.get("scans_dropped", "{}")))
        except ValueError as error:
            raise self._unreadable() from error
        if not all(re.fullmatch("[0-9]{1,15}", count) for count in (read, used)):
            raise self._unreadable()
        return int(read), int(used), dropped

    @property
    def version(self) -> str:
        """The timemap that wrote it."""
        return shown(self.metadata.get("version", "unknown"))

    @property
    def resumed_from(self) -> dict[str, str] | None:
        """Name and SHA-256 of the earlier result that it goes on from."""
        try:
            (earlier,) = check_inputs([parsed(self.metadata["resumed_from"])])
        except KeyError:
            return None
        except ValueError as error:
            raise self._unreadable() from error
        return earlier

    @property
    def recording_ends_ns(self) -> tuple[int, ...]:
        """When recordings ended that had taught something: the maps of the levels are written then."""
        return self._file.times_ns(LevelTopic.MAP.of(self.levels[0]))

    @property
    def can_be_resumed(self) -> bool:
        """Whether this timemap can go on from it."""
        return self.metadata.get("state") == STATE_FORMAT

    @property
    def nodes_were_given(self) -> bool | None:
        """Whether its nodes were known from the start, not made on the way; None where that cannot be told."""
        if not self.can_be_resumed:
            return None
        given = next((kept.state.get("observer.all_given") for kept in self.state()), None)
        return given if isinstance(given, bool) else None

    def count(self, topic: str) -> int:
        """How many messages a topic has."""
        return self._file.count(topic)

    def estimates(self, level: str, until_ns: int | None = None) -> dict[int, Estimate]:
        """Each node's newest estimate of a level, not later than a time; nodes in order of their number.

        Only this level is read. Raises KeyError for a level that the result does not have.
        """
        if level not in self.levels:
            raise KeyError(level)
        scans, statuses = LevelTopic.SCAN.of(level), LevelTopic.STATUS.of(level)
        newest: dict[str, dict[str, bytes]] = {scans: {}, statuses: {}}  # by topic and frame
        try:
            for topic, message in self._file.messages(newest.keys(), until_ns):
                newest[topic][frame_of(message)] = message
            found = [
                self._estimate(scan, newest[statuses][frame], level) for frame, scan in newest[scans].items()
            ]
        except (KeyError, ValueError) as error:
            raise self._unreadable() from error
        return {e.node: e for e in sorted(found, key=lambda e: e.node)}

    def history(self, level: str) -> Iterator[tuple[int, Estimate]]:
        """Every estimate of a level with its stamp [ns], in the order of writing."""
        scans, statuses = LevelTopic.SCAN.of(level), LevelTopic.STATUS.of(level)
        scan = b""
        try:
            for topic, message in self._file.messages((scans, statuses)):
                if topic == scans:
                    scan = message
                else:  # the status follows its scan
                    estimate = self._estimate(scan, message, level)
                    yield estimate.stamp_ns, estimate
        except ValueError as error:
            raise self._unreadable() from error

    def state(self) -> Iterator[StatePart]:
        """What a later replay needs to go on, one part at a time: first those of no node, but the changes last."""
        self.require_resumable()
        try:
            for _, message in self._file.messages([channels.STATE_TOPIC]):
                yield unpack_state(message)
        except (ValueError, TypeError, RecursionError, struct.error) as error:
            raise self._unreadable() from error

    def require_resumable(self) -> None:
        """UsageError where this timemap cannot go on from it: its state is that of another version."""
        found = self.metadata.get("state", "timemap.state/0")  # the first results kept none
        try:
            require_readable(self.path, found, STATE_FORMAT, self.version, "replay all recordings in one go")
        except ValueError as error:
            raise self._unreadable() from error

    def _document(self, name: str, form: str) -> Any:
        """A document in it, of the format that this timemap reads; ValueError where it is none."""
        document = parsed(self._file.attachment(name))
        schema = document.get("schema") if isinstance(document, dict) else None
        require_readable(self.path, schema, form, self.version, _ANEW)
        return document

    def _estimate(self, scan: bytes, status: bytes, level: str) -> Estimate:
        """The estimate in two messages; ValueError where it is none that a replay writes."""
        estimate = unpack_estimate(scan, status, level, self.angle_bins)
        ranges = estimate.ranges
        reach = np.nextafter(np.float32(self.radius), np.float32(np.inf))
        sound = np.isnan(ranges) | np.isposinf(ranges) | ((ranges >= 0) & (ranges <= reach))
        shares = np.stack((estimate.support, estimate.known))
        if estimate.node >= len(self.nodes) or not sound.all() or not ((shares >= 0) & (shares <= 1)).all():
            raise ValueError("an estimate that cannot be")
        return estimate

    def _check_dimensions(self) -> None:
        """ValueError where levels, angle bins or radius are none that settings could have."""
        names = len(self.levels) <= _MOST_LEVELS and all(map(_LEVEL.fullmatch, self.levels))
        distinct = len(set(self.levels)) == len(self.levels)
        if not (names and distinct and 0 < self.angle_bins <= _MOST_BINS and 0 < self.radius <= _FARTHEST_M):
            raise ValueError("no levels, angle bins or radius of a map")

    def _read_nodes(self) -> tuple[Node, ...]:
        """The nodes of the last message that places them: it holds all."""
        message = self._file.last_message(channels.TF_STATIC)
        nodes = unpack_nodes(message) if message else ()
        if len(nodes) != int(self.metadata["nodes"]) or len(nodes) > MOST_NODES:
            raise ValueError("nodes are missing, or more than there may be")
        if not all(distance(node.x, node.y) <= _FARTHEST_M for node in nodes):
            raise ValueError("a node that is not on earth")
        return nodes

    def _check_format(self) -> None:
        """UsageError where another version wrote it, ValueError where it has no format."""
        require_readable(self.path, self.metadata["format"], channels.FORMAT, self.version, _ANEW)

    def _unreadable(self) -> TimemapError:
        return TimemapError(
            f"{self.path} is damaged: its parts do not fit together",
            hint=_ANEW,
        )
