"""A check as text: the worst first, and what probably made it."""

from collections.abc import Iterator, Sequence

from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.verdict import CheckedCase, Measure, Spot, Verdict
from timemap_cli.reports.check_values import compared, outcome, title
from timemap_cli.reports.tables import place, plural, table

_SHOWN = 12  # failures; the others are counted


def check_text(cases: Sequence[CheckedCase]) -> str:
    """The verdicts one after another, and a line for all where there are several. Ends without a newline."""
    blocks = ["\n".join(_case(case)) for case in cases]
    if len(cases) > 1:
        counts = [outcome(case) for case in cases]
        told = ", ".join(
            f"{counts.count(word)} {word}" for word in ("passed", "failed", "error") if word in counts
        )
        blocks.append(f"{plural(len(cases), 'check')}: {told}.")
    return "\n\n".join(blocks)


def _case(case: CheckedCase) -> Iterator[str]:
    if case.verdict is None:
        yield f"error   {case.name}: {case.error.message if case.error else 'nothing was compared'}"
        return
    yield f"{outcome(case)}  {case.name} against {case.baseline}: {_summary(case.verdict)}"
    yield from _failures(case.verdict)
    yield from _listed("likely", case.verdict.causes)
    yield from _listed("differs", case.verdict.unequal or ())
    yield from _listed("note", [note for note in case.verdict.notes if note not in case.verdict.causes])


def _summary(verdict: Verdict) -> str:
    failed, measured = len(verdict.failures), plural(len(verdict.measures), "figure")
    within = f"{failed} of {measured} out of tolerance" if failed else f"{measured} within tolerance"
    if verdict.unequal is None:
        return within
    return f"{within}, {'not the same' if verdict.unequal else 'the same'} to the digest"


def _failures(verdict: Verdict) -> Iterator[str]:
    failures = verdict.failures
    if not failures:
        return
    yield ""
    yield from table([_row(measure) for measure in failures[:_SHOWN]])
    if len(failures) > _SHOWN:
        yield f"  and {len(failures) - _SHOWN} more"
    spots = [(one, spot) for one in failures for spot in one.spots[:3] if one.name == "ranges.places"]
    if spots:
        yield ""
        yield from table([("  place [m]", "level", "what moved"), *(_spot(*pair) for pair in spots[:_SHOWN])])


def _spot(measure: Measure, spot: Spot) -> tuple[str, ...]:
    return f"  {place(spot.x, spot.y)}", measure.level or "", spot.text


def _row(measure: Measure) -> tuple[str, ...]:
    return f"  {title(measure)}", compared(measure), measure.text


def _listed(word: str, lines: Sequence[str]) -> Iterator[str]:
    if lines:
        yield ""
    yield from (f"  {word + ':':<8} {line}" for line in lines)


def updated_text(path: str, snapshot: Snapshot, was: Verdict | None) -> str:
    """What a baseline that was written holds, and what of it is new. Ends without a newline."""
    held = (
        f"{plural(len(snapshot.nodes), 'node')}, {plural(len(snapshot.levels), 'level')}, "
        f"{plural(len(snapshot.events), 'change event')}"
    )
    lines = [f"{path}: {held}"]
    if was is None:
        return lines[0]
    if not was.unequal and not was.notes:
        lines.append("  nothing differs from the baseline that was there")
    lines += list(_failures(was))
    lines += list(_listed("differs", was.unequal or ()))
    lines += list(_listed("note", was.notes))
    return "\n".join(lines)
