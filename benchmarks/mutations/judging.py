"""One check of a recording, as a row of the table."""

from dataclasses import dataclass
from pathlib import Path

from timemap_cli.checking import Check, check, update
from timemap_cli.checks.verdict import Measure, Verdict


@dataclass(frozen=True, slots=True)
class Row:
    """What a check told of one twin of the clean recording."""

    twin: str
    verdict: Verdict

    @property
    def worst(self) -> Measure:
        """The figure that lies farthest beyond its tolerance, or nearest to it."""
        return max(self.verdict.measures, key=lambda measure: measure.excess)

    @property
    def told(self) -> str:
        """What a reader is told first."""
        if not self.verdict.failures:
            return ""
        return self.verdict.causes[0] if self.verdict.causes else self.verdict.failures[0].text


def make_baseline(log: Path, baseline: Path) -> None:
    """Write the baseline of the clean recording."""
    update(Check((log,), baseline, log.stem))


def judge(twin: str, log: Path, baseline: Path, config: Path | None = None) -> Row:
    """Check a twin against the clean recording's baseline, at default tolerance."""
    case = check(Check((log,), baseline, twin, config=config))
    assert case.verdict is not None
    return Row(twin, case.verdict)
