"""Going on where an earlier replay stopped: its settings, what it chose to read, and all that it kept."""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from timemap_cli.config import Settings, loads
from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.scan_window import WINDOW_NS
from timemap_cli.logs.selection import Selection
from timemap_cli.logs.static_transforms import StaticTransforms
from timemap_cli.logs.survey import Known
from timemap_cli.model.learner import Kept
from timemap_cli.model.nodes import Node
from timemap_cli.model.state import State, without_prefix
from timemap_cli.overridden import differing
from timemap_cli.results.reader import ResultReader
from timemap_cli.results.state_messages import Part, StatePart
from timemap_cli.times import format_time

# What taking over arrays of other shapes, and texts in the place of numbers, raises.
_MISFITS = (ArithmeticError, AttributeError, LookupError, RuntimeError, StopIteration, TypeError, ValueError)
_MAY_DIFFER = ("input.max_dropped",)  # it changes nothing that is remembered


@dataclass(frozen=True)
class Earlier:
    """A result that a replay goes on from. What it kept is read part by part, each time it is asked for."""

    path: Path
    settings: Settings
    reading: State  # what is of the recordings, their scans and poses
    nodes: tuple[Node, ...]  # all that the earlier replay made, also those that nothing was learnt of
    known: Known  # what was found out about the recordings so far
    to_read_by: Settings  # with what the earlier replay chose to read, so that this one chooses the same
    resumed_from: str | None  # name of the result that it goes on from itself

    @classmethod
    def of(cls, path: Path) -> "Earlier":
        """Read a result so far as a replay has to know it before it begins.

        UsageError where it is missing or none, TimemapError where it is damaged or cannot be resumed.
        """
        with ResultReader(path) as result, _damage_told(path):
            result.require_resumable()  # the settings of another version may have other names
            settings = loads(result.config, f"the settings of {path}")
            reading = next(kept.state for kept in result.state() if kept.part is Part.READING)
            nodes = tuple(Node(x, y) for x, y in reading["observer.nodes"].tolist())
            found = {topic: MissingReturns(*one) for topic, one in reading["missing_so_far"].items()}
            static = StaticTransforms.of((), without_prefix("stream.static", reading))
            chosen = _chosen(reading["selection"])
            known = Known(static.earlier, found, chosen)
            read_by = _read_by(settings, chosen)
            before = result.resumed_from
            name = None if before is None else before["name"]
            return cls(path, settings, reading, nodes, known, read_by, name)

    def damage_told(self) -> AbstractContextManager[None]:
        """Inside it, what comes of parts that do not fit together is a TimemapError.

        A sound file says nothing about who wrote it, and what is wrong may show late: where a number is used.
        """
        return _damage_told(self.path)

    def parts(self) -> Iterator[StatePart]:
        """All that was kept."""
        with ResultReader(self.path) as result:
            yield from result.state()

    def learnt(self) -> Iterator[Kept]:
        """What the memory kept."""
        for kept in self.parts():
            if kept.part in (Part.LEARNING, Part.NODE):
                yield Kept(kept.node if kept.part is Part.NODE else None, kept.state)

    def require_before(self, logs: Sequence[Path], span_ns: tuple[int, int], start_ns: int | None) -> None:
        """UsageError for recordings of this span that, or whose `start_ns`, lie before the end of this result.

        By no more than may come out of order.
        """
        begin_ns = span_ns[0] if start_ns is None else start_ns
        if begin_ns >= self.end_ns - WINDOW_NS:
            return
        if span_ns[1] > self.end_ns:
            hint = f"the days in their order; to replay only what is not known yet: --start {format_time(self.end_ns)}"
        else:
            hint = f"the days in their order\n{self._way_back(logs, begin_ns)}"
        raise UsageError(
            f"the recordings begin at {format_time(begin_ns)}, before {self.path} ends ({format_time(self.end_ns)})",
            hint=hint,
        )

    @property
    def end_ns(self) -> int:
        """Stamp of its newest scan."""
        clock_ns, newest_ns = self.reading["stream.window.clock_ns"], self.reading["newest_ns"]
        is_silent = clock_ns < 0 and newest_ns is not None  # the last drive had no scans
        return int(newest_ns if is_silent else clock_ns)

    def _way_back(self, logs: Sequence[Path], begin_ns: int) -> str:
        """A hint: the newest result of before a time that this one goes on from, if they lie beside each other."""
        passed, one = {self.path}, self
        while one.resumed_from is not None:
            path = one.path.with_name(one.resumed_from)
            if path in passed or not path.is_file():
                break
            passed.add(path)
            try:
                one = Earlier.of(path)
            except TimemapError:  # another file took its place, perhaps
                break
            if begin_ns >= one.end_ns - WINDOW_NS:
                told = f"timemap replay {' '.join(map(str, logs))} --resume {path}"
                return f"if the clock of a later day was wrong, go on from a result of before it:\n{told}"
        named = f"resume {one.resumed_from}, which {one.path} goes on from, or " if one.resumed_from else ""
        return f"if the clock of a later day was wrong: {named}replay all others in one go"

    def require_same(self, settings: Settings) -> None:
        """UsageError for settings that differ from the earlier replay's, by name."""
        other = differing(settings, self.settings)
        as_chosen = differing(settings, self.to_read_by)
        found = [as_chosen[name] for name in other if name in as_chosen and name not in _MAY_DIFFER]
        if found:
            raise UsageError(
                f"the settings differ from those of {self.path}: {', '.join(found)}",
                hint="leave them out: those of the earlier result hold; or replay all recordings in one go",
            )


def _chosen(kept: State) -> Selection:
    topics = tuple(kept["scan_topics"])
    return Selection(topics, kept["map_frame"], kept["pose"], covariances=kept["covariances"])


def _read_by(settings: Settings, chosen: Selection) -> Settings:
    wanted = replace(
        settings.input,
        scan_topics=chosen.scan_topics,
        map_frame=chosen.map_frame,
        poses=chosen.pose,
    )
    return replace(settings, input=wanted)


@contextmanager
def _damage_told(path: Path) -> Iterator[None]:
    try:
        yield
    except TimemapError:
        raise
    except _MISFITS as error:
        raise TimemapError(
            f"{path} is damaged: what it kept to go on from does not fit together ({type(error).__name__}: {error})",
            hint="make it again, or replay all recordings in one go",
        ) from error
