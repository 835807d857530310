"""What is in recordings, as JSON for programs, schema timemap.info/1."""

from dataclasses import asdict
from math import degrees, isfinite

from timemap_cli.file_names import json_text
from timemap_cli.logs.inspect import Inspection, LogInfo, PoseInfo
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.pose_quality import PoseReport
from timemap_cli.logs.scan_statistics import ScanTopic


def info_json(inspection: Inspection) -> str:
    """The document as text, without NaN or Infinity.

    Times are strings of nanoseconds, lengths metres; null stands for what is not known.
    """
    return json_text(info_document(inspection), indent=2)


def info_document(inspection: Inspection) -> dict[str, object]:
    """The document as values that JSON knows."""
    selected = _selected(inspection)
    trouble = [inspection.trouble.message] if inspection.trouble else []
    warnings = list(inspection.selection.warnings) if inspection.selection else []
    return {
        "schema": "timemap.info/1",
        "logs": [
            _log(log, selected, trouble, _missing_of(inspection, index))
            for index, log in enumerate(inspection.logs)
        ],
        "span_ns": [str(stamp_ns) for stamp_ns in inspection.span_ns] if inspection.span_ns else None,
        "no_return": inspection.no_return,
        "problems": [*trouble, *warnings, *inspection.problems],
    }


def _missing_of(inspection: Inspection, index: int) -> dict[str, object]:
    """By topic, what the test of a log's missing returns found."""
    return {
        topic: {**_missing(found), "are_clear": inspection.missing_are_clear[log, topic]}
        for (log, topic), found in inspection.missing_returns.items()
        if log == index
    }


def _log(
    log: LogInfo, selected: dict[str, object] | None, trouble: list[str], missing: dict[str, object]
) -> dict[str, object]:
    return {
        "path": log.path,
        "format": log.format,
        "start_ns": str(log.start_ns),
        "end_ns": str(log.end_ns),
        "scans": [_scan(scan) for scan in log.scans],
        "poses": [_pose(pose) for pose in log.poses],
        "selected": selected,
        "missing_returns": missing,
        "problems": [*trouble, *log.problems],
    }


def _selected(inspection: Inspection) -> dict[str, object] | None:
    selection = inspection.selection
    if selection is None:
        return None
    return {
        "scan_topics": list(selection.scan_topics),
        "map_frame": selection.map_frame,
        "poses": selection.pose,
    }


def _scan(scan: ScanTopic) -> dict[str, object]:
    return {
        "topic": scan.topic,
        "frame_id": scan.frame_id,
        "count": scan.count,
        "rate_hz": _number(scan.rate_hz),
        "fov_deg": _number(scan.fov_deg),
        "n_beams": scan.n_beams,
        "range_min_m": _number(scan.range_min_m),
        "range_max_m": _number(scan.range_max_m) or None,
        "beams": asdict(scan.beams),
        "with_pose": scan.with_pose,
        "found": list(scan.found),
        "pose_quality": _pose_quality(scan.pose_report),
    }


def _pose_quality(found: PoseReport | None) -> dict[str, object] | None:
    if found is None:
        return None
    return {
        "covariances": found.covariances,
        "position_std_m": _number(found.position_std),
        "yaw_std_deg": _number(None if found.yaw_std is None else degrees(found.yaw_std)),
        "jumps": found.jumps,
        "largest_jump_m": _number(found.largest_jump) if found.jumps else None,
        "largest_jump_ns": str(found.largest_jump_ns) if found.jumps else None,
        "set_aside": dict(found.set_aside),
    }


def _pose(pose: PoseInfo) -> dict[str, object]:
    return {
        "topic": pose.topic,
        "type": pose.msgtype,
        "count": pose.count,
        "frame_id": pose.frame_id,
        "child_frame_id": pose.child_frame_id,
    }


def _missing(found: MissingReturns) -> dict[str, object]:
    return {"tested": found.beams, "contradicted": _number(found.contradicted)}


def _number(value: float | None) -> float | None:
    return round(value, 4) if value is not None and isfinite(value) else None
