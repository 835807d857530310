"""What the page of a checked result shows beside it: the baseline's ranges, and what is out of tolerance."""

from typing import Any

import numpy as np

from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.verdict import Measure, Verdict
from timemap_cli.reports.check_values import title, value
from timemap_cli.reports.page_data import packed


def check_data(expected: Snapshot, verdict: Verdict) -> dict[str, Any]:
    """To stand as `check` in the data of a page; ranges as `page_data` has them, at step 0."""
    numbers = np.arange(len(expected.nodes))
    return {
        "outcome": verdict.outcome.value,
        "baseline": verdict.baseline,
        "nodes": [[node.x, node.y] for node in expected.nodes],
        "estimates": {
            level: packed(np.zeros_like(numbers), numbers, rings.ranges)
            for level, rings in expected.levels.items()
        },
        "figures": len(verdict.measures),
        "failures": [_failure(one) for one in verdict.failures],
        "causes": list(verdict.causes),
        "notes": [note for note in verdict.notes if note not in verdict.causes],
    }


def _failure(one: Measure) -> dict[str, Any]:
    return {
        "name": title(one),
        "level": one.level,
        "value": value(one.value, one.unit),
        "allowed": value(one.allowed, one.unit),
        "text": one.text,
        "spots": [
            {"x": spot.x, "y": spot.y, "text": spot.text, "nodes": list(spot.nodes)} for spot in one.spots
        ],
    }
