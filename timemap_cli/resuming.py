"""Going on where an earlier replay stopped: its settings, what it chose to read, and all that it kept."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from timemap_cli.config import Settings, loads
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.scan_window import WINDOW_NS
from timemap_cli.logs.static_transforms import StaticTransforms
from timemap_cli.logs.survey import Known
from timemap_cli.model.learner import Kept
from timemap_cli.model.nodes import Node
from timemap_cli.model.state import State, without_prefix
from timemap_cli.overridden import differing
from timemap_cli.results.reader import ResultReader
from timemap_cli.results.state_messages import Part, StatePart
from timemap_cli.times import format_time

_MAY_DIFFER = ("input.max_dropped",)  # it changes nothing that is remembered


@dataclass(frozen=True)
class Earlier:
    """A result that a replay goes on from. What it kept is read part by part, each time it is asked for."""

    path: Path
    settings: Settings
    reading: State  # what is of the recordings, their scans and poses
    nodes: tuple[Node, ...]  # all that the earlier replay made, also those that nothing was learnt of

    @classmethod
    def of(cls, path: Path) -> "Earlier":
        """Read a result so far as a replay has to know it before it begins.

        UsageError where it is missing or none, TimemapError where it is damaged or cannot be resumed.
        """
        with ResultReader(path) as result:
            settings = loads(result.config, f"the settings of {path}")
            reading = next((kept.state for kept in result.state() if kept.part is Part.READING), None)
        if reading is None:
            raise TimemapError(f"{path} does not hold what a replay needs to go on")
        nodes = tuple(Node(x, y) for x, y in reading["observer.nodes"].tolist())
        return cls(path, settings, reading, nodes)

    def parts(self) -> Iterator[StatePart]:
        """All that was kept."""
        with ResultReader(self.path) as result:
            yield from result.state()

    def learnt(self) -> Iterator[Kept]:
        """What the memory kept."""
        for kept in self.parts():
            if kept.part in (Part.LEARNING, Part.NODE):
                yield Kept(kept.node if kept.part is Part.NODE else None, kept.state)

    @property
    def known(self) -> Known:
        """What was found out about the recordings so far."""
        static = StaticTransforms.of((), without_prefix("stream.static", self.reading))
        found = self.reading["missing_so_far"]
        return Known(static.earlier, {topic: MissingReturns(*counted) for topic, counted in found.items()})

    def settings_to_read_by(self) -> Settings:
        """The settings with what the earlier replay chose to read, so that this one chooses the same."""
        chosen = self.reading["selection"]
        wanted = replace(
            self.settings.input,
            scan_topics=tuple(chosen["scan_topics"]),
            map_frame=chosen["map_frame"],
            poses=chosen["poses"],
        )
        return replace(self.settings, input=wanted)

    def require_before(self, begin_ns: int) -> None:
        """UsageError for scans that begin earlier than this result ends, by more than may come out of order."""
        end_ns = self.reading["stream.window.clock_ns"]
        if begin_ns < end_ns - WINDOW_NS:
            raise UsageError(
                f"the recordings begin at {format_time(begin_ns)}, before {self.path} ends ({format_time(end_ns)})",
                hint=f"the days in their order; to replay only what is not known yet: --start {format_time(end_ns)}",
            )

    def require_same(self, settings: Settings) -> None:
        """UsageError for settings that differ from the earlier replay's, by name."""
        other = differing(settings, self.settings)
        as_chosen = differing(settings, self.settings_to_read_by())
        found = [text for name, text in other.items() if name in as_chosen and name not in _MAY_DIFFER]
        if found:
            raise UsageError(
                f"the settings differ from those of {self.path}: {', '.join(found)}",
                hint="leave them out: those of the earlier result hold; or replay all recordings in one go",
            )
