"""What a replay did, for people and for programs."""

from typing import TYPE_CHECKING

from timemap_cli.file_names import json_text

if TYPE_CHECKING:
    from timemap_cli.replay import ReplaySummary


def replay_text(summary: "ReplaySummary") -> str:
    """A few lines: the result, its nodes and levels, and what became of the scans."""
    dropped = sum(summary.dropped.values())
    reasons = ", ".join(f"{reason} {count}" for reason, count in summary.dropped.items() if count)
    scans = f"{summary.scans_read} read, {summary.scans_used} used, {dropped} dropped"
    return "\n".join(
        (
            str(summary.result),
            f"  nodes   {summary.nodes}",
            f"  levels  {', '.join(summary.levels)}",
            f"  scans   {scans} ({reasons})" if reasons else f"  scans   {scans}",
            f"  time    {summary.seconds:.1f} s",
        )
    )


def replay_json(summary: "ReplaySummary") -> str:
    """The same as JSON of the schema timemap.replay/1."""
    report = {
        "schema": "timemap.replay/1",
        "result": str(summary.result),
        "nodes": summary.nodes,
        "levels": list(summary.levels),
        "scans": {
            "read": summary.scans_read,
            "used": summary.scans_used,
            "dropped": {reason: count for reason, count in summary.dropped.items() if count},
        },
        "seconds": round(summary.seconds, 3),
        "warnings": list(summary.warnings),
    }
    return json_text(report, indent=2)
