"""A result's snapshot against a baseline's: every figure, and what probably made the difference."""

from collections.abc import Iterator, Mapping

import numpy as np

from timemap_cli.checks.causes import different_inputs, likely_causes
from timemap_cli.checks.event_measures import event_measures
from timemap_cli.checks.level_measures import both_ends, level_measures
from timemap_cli.checks.matching import Matched, matched
from timemap_cli.checks.motion_measures import motion_measures
from timemap_cli.checks.pairs import Pair
from timemap_cli.checks.places import confirmed, moved_places
from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.surfaces import offsets
from timemap_cli.checks.verdict import Measure, Verdict
from timemap_cli.checks.whole_measures import whole_measures
from timemap_cli.errors import UsageError


def compare(
    expected: Snapshot,
    found: Snapshot,
    allowed: Mapping[str, float],
    *,
    name: str,
    baseline: str,
    exact: bool = False,
) -> Verdict:
    """The verdict on `found`; UsageError where nothing can be compared: other maps, no node or level in common.

    `allowed` holds every tolerance; `name` and `baseline` say what was checked against which file.
    """
    nodes = matched(expected.nodes, found.nodes, allowed["nodes.place"])
    _require_comparable(expected, found, nodes, baseline)
    measures = [
        *whole_measures(expected, found, nodes, allowed),
        *_ring_measures(expected, found, nodes, allowed),
        *event_measures(expected.events, found.events, allowed),
    ]
    verdict = Verdict(
        name=name,
        baseline=baseline,
        measures=tuple(measures),
        causes=(),
        notes=tuple(_notes(expected, found, nodes)),
        unequal=tuple(_unequal(expected, found)) if exact else None,
    )
    causes = tuple(likely_causes(expected, found, verdict.failures))
    return Verdict(name, baseline, verdict.measures, causes, verdict.notes, verdict.unequal)


def _ring_measures(
    expected: Snapshot, found: Snapshot, nodes: Matched, allowed: Mapping[str, float]
) -> Iterator[Measure]:
    """Figures of all levels together, then of each."""
    levels = [level for level in expected.levels if level in found.levels]
    pairs = [_pair(expected, found, nodes, level) for level in levels]
    come = [offsets(pair.found, pair.expected, pair.apart) for pair in pairs]
    gone = [offsets(pair.expected, pair.found, -pair.apart) for pair in pairs]
    yield from motion_measures(pairs[-1], come[-1], allowed)  # the slowest level averages most
    sides = list(zip(pairs, come, gone, strict=True))
    places = confirmed(
        [moved_places(both_ends(*one), allowed["ranges.step"], len(nodes.pairs)) for one in sides]
    )
    for level, (pair, ours, theirs), moved in zip(levels, sides, places, strict=True):
        yield from level_measures(level, pair, ours, theirs, moved, allowed)


def _pair(expected: Snapshot, found: Snapshot, nodes: Matched, level: str) -> Pair:
    rows, others = (np.array(side, np.int64) for side in zip(*nodes.pairs, strict=True))
    places, other_places = (
        np.array([(node.x, node.y) for node in side.nodes], np.float64) for side in (expected, found)
    )
    centres = other_places[others]
    return Pair(
        expected=expected.levels[level].ranges[rows],
        found=found.levels[level].ranges[others],
        centres=centres,
        apart=places[rows] - centres,
        numbers=tuple(rows.tolist()),
    )


def _require_comparable(expected: Snapshot, found: Snapshot, nodes: Matched, baseline: str) -> None:
    trouble = None
    if expected.map_frame != found.map_frame:
        trouble = f"the map frame is '{found.map_frame}' and was '{expected.map_frame}'"
    elif expected.angle_bins != found.angle_bins:
        trouble = f"a node has {found.angle_bins} angle bins and had {expected.angle_bins}"
    elif not expected.levels.keys() & found.levels.keys():
        trouble = "they have no level in common"
    elif not nodes.pairs:
        trouble = "they have no node in common"
    if trouble:
        raise UsageError(
            f"nothing can be compared with {baseline}: {trouble}",
            hint="--update-baseline, if that is how it should be now",
        )


def _notes(expected: Snapshot, found: Snapshot, nodes: Matched) -> Iterator[str]:
    """What is different and fails nothing by itself."""
    yield from different_inputs(expected, found)
    if expected.version != found.version:
        yield f"made by timemap {found.version}, the baseline by {expected.version}"
    moved = sum(expected.nodes[i] != found.nodes[j] for i, j in nodes.pairs)
    if moved or nodes.missing or nodes.new:
        yield (
            f"{moved} of {len(nodes.pairs)} nodes stand a little elsewhere: `timemap check LOG...` replays with "
            "the baseline's nodes and compares more closely"
        )


def _unequal(expected: Snapshot, found: Snapshot) -> Iterator[str]:
    """What has not the same digest, or is not the same."""
    if expected.nodes != found.nodes:
        yield "the nodes"
    if expected.scans != found.scans:
        yield "the counts of scans"
    for level in [*expected.levels, *(name for name in found.levels if name not in expected.levels)]:
        if level not in expected.levels or level not in found.levels:
            yield f"level {level} is on one side only"
            continue
        one, other = expected.levels[level].digests, found.levels[level].digests
        nodes = [str(i) for i in range(max(len(one), len(other))) if one[i : i + 1] != other[i : i + 1]]
        if nodes:
            rest = f" and {len(nodes) - 8} more" if len(nodes) > 8 else ""
            yield f"level {level} at node {', '.join(nodes[:8])}{rest}"
    if expected.events != found.events:
        yield "the change events"
