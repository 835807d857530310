"""How the figures of a check are written, in every format."""

from timemap_cli.checks.verdict import CheckedCase, Measure, Outcome, Verdict


def title(measure: Measure) -> str:
    """`ranges.moved (long)`: the tolerance's name, and the level."""
    return f"{measure.name} ({measure.level})" if measure.level else measure.name


def value(number: float, unit: str) -> str:
    """A figure with its unit: `3.1 %`, `0.022 m`, `2 places`."""
    if not unit:
        return f"{100 * number:.3g} %"
    if unit == "m":
        return f"{number:.3f} m"
    if unit.endswith("s") and number == 1 and len(unit) > 1:
        unit = unit[:-1]
    return f"{number:.3g} {unit}" if number < 1000 else f"{number:.0f} {unit}"


def compared(measure: Measure) -> str:
    """The figure beside what is allowed."""
    return f"{value(measure.value, measure.unit)}, allowed {value(measure.allowed, measure.unit)}"


def within(verdict: Verdict) -> str:
    """`all 29 figures are`, of a check that passed."""
    count = len(verdict.measures)
    return "the one figure is" if count == 1 else f"all {count} figures are"


def outcome(case: CheckedCase) -> str:
    """One word: passed, failed, or error where nothing could be compared."""
    return (
        Outcome.PASSED.value
        if case.verdict and case.verdict.outcome is Outcome.PASSED
        else (Outcome.FAILED.value if case.verdict else "error")
    )
