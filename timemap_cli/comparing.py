"""Comparing two levels, two times of a level, or two results."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.compare import compare
from timemap_cli.changes.difference import Difference
from timemap_cli.changes.rules import Rules
from timemap_cli.changes.sides import Side
from timemap_cli.errors import UsageError
from timemap_cli.maps.alignment import align
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.nodes import Node
from timemap_cli.reports.sides import ComparedSide
from timemap_cli.results.reader import ResultReader
from timemap_cli.times import format_time, parse_time

# Nodes that two results share are given with the same numbers; this is far below any node spacing.
_SAME_PLACE_M = 1e-3


@dataclass(frozen=True, slots=True)
class Comparison:
    """A difference with its two sides; the numbers of nodes are places in `nodes`."""

    difference: Difference
    nodes: Sequence[Node]
    before: ComparedSide
    after: ComparedSide
    without_partner: tuple[int, int] | None = (
        None  # of two results: nodes of the one, the other, that it alone has
    )
    warnings: tuple[str, ...] = ()
    hint: str | None = None  # what to try, where nothing was compared or nothing found


def compare_levels(result: Path, levels: tuple[str, str], at: str | None = None) -> Comparison:
    """The slower of two levels against the faster one, at a time, by default the result's end."""
    with ResultReader(result) as reader:
        for level in levels:
            require_level(reader, result, level)
        if levels[0] == levels[1]:
            raise UsageError(f"level {levels[0]} cannot differ from itself", hint=_level_pair(result, reader))
        slower, faster = sorted(levels, key=reader.levels.index, reverse=True)
        asked = f"--level {' '.join(levels)} --at"
        until_ns = _time_within(reader, result, "end" if at is None else at, asked)
        before, after = reader.estimates(slower, until_ns), reader.estimates(faster, until_ns)
        rules = Rules.of_level(is_fastest=faster == reader.levels[0])
        difference = compare(reader.nodes, before, after, rules, radius=reader.radius)
        old_side, new_side = (ComparedSide(str(result), level, until_ns) for level in (slower, faster))
        warnings = _beyond(reader, result, until_ns)
        hint = (
            None if difference.changes else f"{_two_times(reader, result, faster)}\ntimemap changes {result}"
        )
        return Comparison(difference, tuple(reader.nodes), old_side, new_side, warnings=warnings, hint=hint)


def compare_times(result: Path, level: str, times: tuple[str, str]) -> Comparison:
    """The earlier of two times of a level against the later one: each node's newest estimates until then."""
    with ResultReader(result) as reader:
        require_level(reader, result, level)
        asked = f"{result} --level {level}"
        earlier_ns, later_ns = sorted(_time_within(reader, result, time, asked) for time in times)
        before, after = reader.estimates(level, earlier_ns), reader.estimates(level, later_ns)
        rules = Rules.of_level(is_fastest=level == reader.levels[0])
        difference = compare(reader.nodes, before, after, rules, radius=reader.radius, only_renewed=True)
        old_side, new_side = (ComparedSide(str(result), level, ns) for ns in (earlier_ns, later_ns))
        warnings = _beyond(reader, result, later_ns)
        hint = None if difference.nodes else _two_times(reader, result, level)
        return Comparison(difference, tuple(reader.nodes), old_side, new_side, warnings=warnings, hint=hint)


def compare_results(one: Path, other: Path, level: str) -> Comparison:
    """The end of the result that ends earlier against the end of the other one; both must lie in one map frame."""
    with ResultReader(one) as first, ResultReader(other) as second:
        pairs = [(one, first), (other, second)]
        for path, reader in pairs:
            require_level(reader, path, level)
        (old_path, old), (new_path, new) = sorted(pairs, key=lambda pair: pair[1].end_ns)
        _require_same_map(old_path, old, new_path, new)
        numbers = _common_numbers(old.nodes, new.nodes)
        nodes = [*old.nodes, *(n for i, n in enumerate(new.nodes) if numbers[i] >= len(old.nodes))]
        before, after = old.estimates(level, None), _renumbered(new.estimates(level, None), numbers)
        _require_aligned(old_path, new_path, *(_ends(nodes, side, old.radius) for side in (before, after)))
        rules = Rules.of_level(is_fastest=level == old.levels[0])
        difference = compare(nodes, before, after, rules, radius=old.radius)
        if not difference.nodes:
            raise UsageError(
                f"{old_path} and {new_path} have looked at no common place",
                hint="two results of one building, in one map frame",
            )
        old_side, new_side = (
            ComparedSide(str(path), level, reader.end_ns)
            for path, reader in ((old_path, old), (new_path, new))
        )
        shared = sum(number < len(old.nodes) for number in numbers)
        alone = len(old.nodes) - shared, len(new.nodes) - shared
        return Comparison(difference, nodes, old_side, new_side, alone)


def newest_result(folder: Path) -> Path:
    """The newest `*.timemap.mcap` in a folder; UsageError where there is none."""
    found = sorted(folder.glob("*.timemap.mcap"), key=lambda path: (path.stat().st_mtime_ns, path.name))
    if not found:
        raise UsageError("no result given, and no *.timemap.mcap in this folder", hint="timemap replay LOG")
    return found[-1]


def require_level(reader: ResultReader, result: Path, level: str, hint: str | None = None) -> None:
    """UsageError for a level that a result does not have; without a hint a diff of two levels is proposed."""
    if level not in reader.levels:
        raise UsageError(
            f"{result} has no level '{level}', only {', '.join(reader.levels)}",
            hint=hint or _level_pair(result, reader),
        )


def _level_pair(result: Path, reader: ResultReader) -> str | None:
    slow_and_next = list(reader.levels)[:-3:-1]
    return f"timemap diff {result} --level {' '.join(slow_and_next)}" if len(slow_and_next) == 2 else None


def _time_within(reader: ResultReader, result: Path, time: str, asked: str) -> int:
    """A time of a result; UsageError before its first estimates, where `asked` is put to the result it goes on from.

    What is asked with `--at` is asked with the time in full: a span from an end means another time there.
    """
    stamp_ns = parse_time(time, reader.start_ns, reader.end_ns)
    if stamp_ns < reader.start_ns:
        span = f"from {format_time(reader.start_ns)} to {format_time(reader.end_ns)}"
        hint, before = "+10s or end-5s, counted from these", ""
        if (earlier := reader.resumed_from) is not None:
            name = earlier["name"]
            time_there = f" {format_time(stamp_ns)}" if asked.endswith("--at") else ""
            hint, before = (
                f"timemap diff {result.with_name(name)} {asked}{time_there}\n{hint}",
                f", it goes on from {name}",
            )
        raise UsageError(f"{result} knows nothing at {time}: its estimates go {span}{before}", hint=hint)
    return stamp_ns


def _beyond(reader: ResultReader, result: Path, stamp_ns: int) -> tuple[str, ...]:
    """A warning where a result tells of an earlier time than was asked for."""
    if stamp_ns <= reader.end_ns:
        return ()
    return (f"{result} ends at {format_time(reader.end_ns)}: what it knew then is compared",)


def _two_times(reader: ResultReader, result: Path, level: str) -> str:
    """A comparison of two times to paste that compares something; in words, where none is found."""
    ends_ns = reader.recording_ends_ns or (reader.end_ns,)
    middle_ns = (reader.start_ns + reader.end_ns) // 2 // 10**9 * 10**9
    for earlier_ns, later_ns in ((ends_ns[0], ends_ns[-1]), (middle_ns, reader.end_ns)):
        if earlier_ns < later_ns and _any_renewed(reader, level, earlier_ns, later_ns):
            times = f"{format_time(earlier_ns)} {format_time(later_ns)}"
            return f"timemap diff {result} --level {level} --between {times}"
    first, last = map(format_time, (reader.start_ns, reader.end_ns))
    return f"--level {level} --between TIME TIME; the first estimates are of {first}, the last of {last}"


def _any_renewed(reader: ResultReader, level: str, earlier_ns: int, later_ns: int) -> bool:
    before, after = reader.estimates(level, earlier_ns), reader.estimates(level, later_ns)
    return any(after[node].stamp_ns > known.stamp_ns for node, known in before.items())


def _require_same_map(old_path: Path, old: ResultReader, new_path: Path, new: ResultReader) -> None:
    for what, one, other in (
        ("map frame", old.map_frame, new.map_frame),
        ("angle_bins", old.angle_bins, new.angle_bins),
        ("radius", old.radius, new.radius),
    ):
        if one != other:
            raise UsageError(
                f"{old_path} and {new_path} cannot be compared: {what} is {one} here and {other} there",
                hint="replay both with the same settings",
            )


def _ends(nodes: Sequence[Node], estimates: Mapping[int, Estimate], radius: float) -> npt.NDArray[np.float64]:
    """Where the firm angle bins of all estimates end, (n, 2) [m, map frame]."""
    if not estimates:
        return np.empty((0, 2))
    side = Side.of(estimates, nodes, radius, Rules())
    return side.ends(*np.nonzero(side.shows_surface))


def _require_aligned(
    old_path: Path, new_path: Path, old: npt.NDArray[np.float64], new: npt.NDArray[np.float64]
) -> None:
    """UsageError where the newer surfaces fit the older ones as a whole once they are shifted: nothing has changed."""
    found = align(new, old)
    if not found.shifted:
        return
    x, y = found.shift
    turn = math.degrees(found.offset.yaw)
    loose = ""
    if found.undetermined is not None:
        loose = " (along {:.2f}, {:.2f} the place does not tell)".format(*found.undetermined)
    raise UsageError(
        f"{new_path} lies beside {old_path}: moved by {x:.2f}, {y:.2f} m and turned by {turn:.1f} degrees{loose} "
        f"{found.inliers_after:.0%} of its surfaces fit, as it is {found.inliers_before:.0%}",
        hint="the poses of both must be in one map frame: localise both recordings in the same map",
    )


def _common_numbers(old: Sequence[Node], new: Sequence[Node]) -> list[int]:
    """A number for each node of `new`: that of the old node at the same place, else one of its own after all old."""

    def cell(node: Node) -> tuple[int, int]:
        return round(node.x / _SAME_PLACE_M), round(node.y / _SAME_PLACE_M)

    known = {cell(node): number for number, node in enumerate(old)}
    unused = count(len(old))
    return [known[cell(node)] if cell(node) in known else next(unused) for node in new]


def _renumbered(estimates: Mapping[int, Estimate], numbers: Sequence[int]) -> dict[int, Estimate]:
    return {numbers[node]: replace(estimate, node=numbers[node]) for node, estimate in estimates.items()}
