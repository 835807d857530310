"""A comparison as JSON for programs, schema timemap.diff/1."""

from collections.abc import Sequence
from math import isfinite

from timemap_cli.changes.difference import Change, ComparedNode, Difference, Kind, Sector
from timemap_cli.file_names import json_text
from timemap_cli.model.nodes import Node
from timemap_cli.reports.sides import ComparedSide

_DIGITS = 4  # of a metre, a degree or a share: finer than any scanner


def diff_json(
    difference: Difference,
    nodes: Sequence[Node],
    old: ComparedSide,
    new: ComparedSide,
    without_partner: tuple[int, int] | None = None,
) -> str:
    """The document as text, one line, without NaN or Infinity.

    Times are strings of nanoseconds, lengths metres in the map frame, bearings degrees; a sector runs
    counter-clockwise from start_deg (0 <= start < 360) to stop_deg (0 < stop <= 360) and passes 0 where the
    stop is not beyond the start. A range is a number or "clear". `without_partner` counts the nodes of "from" and
    of "to" that the other result does not have; None where both sides are of one result.
    """
    return json_text(diff_document(difference, nodes, old, new, without_partner))


def diff_document(
    difference: Difference,
    nodes: Sequence[Node],
    old: ComparedSide,
    new: ComparedSide,
    without_partner: tuple[int, int] | None = None,
) -> dict[str, object]:
    """The document as values that JSON knows."""
    return {
        "schema": "timemap.diff/1",
        "from": _side(old),
        "to": _side(new),
        "changes": [_change(change, difference.angle_bins) for change in difference.changes],
        "nodes": [_node(compared, nodes[compared.node]) for compared in difference.nodes],
        "summary": _summary(difference) | _alone(without_partner),
    }


def _summary(difference: Difference) -> dict[str, object]:
    counts: dict[str, object] = {kind.value: difference.count(kind) for kind in Kind}
    return counts | {
        "changes": len(difference.changes),
        "small": difference.small,
        "compared_nodes": len(difference.nodes),
        "silent_nodes": len(difference.silent_nodes),
        "compared_bins": difference.compared_bins,
        "changed_bins": difference.changed_bins,
        "angle_bins": difference.angle_bins or None,
    }


def _alone(without_partner: tuple[int, int] | None) -> dict[str, object]:
    if without_partner is None:
        return {}
    return {"without_partner": dict(zip(("from", "to"), without_partner, strict=True))}


def _side(side: ComparedSide) -> dict[str, object]:
    return {"result": side.result, "level": side.level, "stamp_ns": str(side.stamp_ns)}


def _change(change: Change, angle_bins: int) -> dict[str, object]:
    return {
        "kind": change.kind.value,
        "x": _number(change.x),
        "y": _number(change.y),
        "bounds": [_number(value) for value in change.bounds],
        "support": _number(change.support),
        "moved_from": [_number(value) for value in change.moved_from] if change.moved_from else None,
        "sectors": [_sector(sector, angle_bins) for sector in change.sectors],
    }


def _sector(sector: Sector, angle_bins: int) -> dict[str, object]:
    return {
        "node": sector.node,
        "start_deg": _number(sector.start_bin * 360 / angle_bins),
        "stop_deg": _number(sector.stop_bin * 360 / angle_bins),
        "range_from_m": _range(sector.range_from_m),
        "range_to_m": _range(sector.range_to_m),
    }


def _node(compared: ComparedNode, node: Node) -> dict[str, object]:
    return {
        "id": compared.node,
        "x": _number(node.x),
        "y": _number(node.y),
        "compared_bins": compared.compared_bins,
        "changed_bins": compared.changed_bins,
    }


def _range(metres: float) -> float | str:
    return _number(metres) if isfinite(metres) else "clear"


def _number(value: float) -> float:
    return round(float(value), _DIGITS) + 0.0  # the sum turns -0.0 into 0.0
