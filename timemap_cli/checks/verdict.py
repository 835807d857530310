"""What a check says."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from timemap_cli.checks.tolerances import within
from timemap_cli.errors import ExitCode, TimemapError
from timemap_cli.model.ordering import to_order


class Outcome(Enum):
    """How a check ended."""

    PASSED = "passed"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Spot:
    """A place of the map that a finding is about."""

    x: float  # [m] map frame
    y: float
    text: str  # what is there, in words
    nodes: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Measure:
    """One figure that was compared with its tolerance."""

    name: str  # of the tolerance
    level: str | None
    value: float
    allowed: float
    unit: str  # empty: a share 0..1
    text: str  # one sentence
    spots: tuple[Spot, ...] = ()  # worst first
    cause: str = ""  # what would make it, where more than its name tells that

    @property
    def passed(self) -> bool:
        """Whether it is within its tolerance."""
        return within(self.value, self.allowed)

    @property
    def excess(self) -> float:
        """How many times its tolerance it is; to order by."""
        return self.value / self.allowed if self.allowed else 2.0 * self.value


@dataclass(frozen=True, slots=True)
class Verdict:
    """The result of one check."""

    name: str  # of what was checked
    baseline: str  # its file
    measures: tuple[Measure, ...]  # in the order of comparing
    causes: tuple[str, ...]  # likely ones, the likeliest first
    notes: tuple[str, ...]  # what is different and fails nothing
    unequal: tuple[str, ...] | None  # with --exact: what has another digest; None: not asked for

    @property
    def failures(self) -> list[Measure]:
        """What is out of tolerance, the worst first."""
        return sorted((one for one in self.measures if not one.passed), key=lambda one: -to_order(one.excess))

    @property
    def outcome(self) -> Outcome:
        """Whether all is within its tolerance, and equal where that was asked for."""
        return Outcome.FAILED if self.failures or self.unequal else Outcome.PASSED


@dataclass(frozen=True, slots=True)
class CheckedCase:
    """One check as it went: a verdict, or why there is none."""

    name: str
    baseline: str
    verdict: Verdict | None
    error: TimemapError | None = None
    lost: bool = False  # recordings are damaged, or too many scans were dropped
    warnings: tuple[str, ...] = ()

    @property
    def exit_code(self) -> ExitCode:
        """What it alone would tell the shell."""
        if self.error is not None:
            return self.error.exit_code
        if self.verdict is not None and self.verdict.outcome is Outcome.FAILED:
            return ExitCode.DIFFERENT
        return ExitCode.DATA_LOST if self.lost else ExitCode.DONE


def exit_code_of(cases: Sequence[CheckedCase]) -> ExitCode:
    """What several checks tell the shell: the gravest of their codes."""
    codes = {case.exit_code for case in cases}
    gravest = (ExitCode.DIFFERENT, ExitCode.USAGE, ExitCode.FAILED, ExitCode.DATA_LOST)
    return next((code for code in gravest if code in codes), ExitCode.DONE)
