"""A check as JSON, schema timemap.check/1."""

from collections.abc import Sequence
from typing import Any

from timemap_cli.checks.verdict import CheckedCase, Measure, exit_code_of
from timemap_cli.file_names import json_text
from timemap_cli.reports.check_values import outcome

SCHEMA = "timemap.check/1"
_DIGITS = 6


def check_json(cases: Sequence[CheckedCase]) -> str:
    """All checks with every figure; no NaN or Infinity."""
    words = [outcome(case) for case in cases]
    document = {
        "schema": SCHEMA,
        "exit_code": int(exit_code_of(cases)),
        "checks": [_case(case) for case in cases],
        "summary": {word: words.count(word) for word in ("passed", "failed", "error")},
    }
    return json_text(document, indent=2)


def _case(case: CheckedCase) -> dict[str, Any]:
    verdict = case.verdict
    return {
        "name": case.name,
        "baseline": case.baseline,
        "outcome": outcome(case),
        "error": case.error.message if case.error else None,
        "data_lost": case.lost,
        "warnings": list(case.warnings),
        "causes": list(verdict.causes) if verdict else [],
        "notes": list(verdict.notes) if verdict else [],
        "unequal": list(verdict.unequal) if verdict and verdict.unequal is not None else None,
        "measures": [_measure(one) for one in verdict.measures] if verdict else [],
    }


def _measure(one: Measure) -> dict[str, Any]:
    return {
        "name": one.name,
        "level": one.level,
        "value": round(one.value, _DIGITS),
        "allowed": one.allowed,
        "unit": one.unit or "share",
        "passed": one.passed,
        "text": one.text,
        "spots": [
            {"x": round(spot.x, 3), "y": round(spot.y, 3), "text": spot.text, "nodes": list(spot.nodes)}
            for spot in one.spots
        ],
    }
