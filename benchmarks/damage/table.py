"""The table of what became of damaged recordings."""

from collections import Counter
from collections.abc import Mapping, Sequence

from benchmarks.damage.trial import Trial, Verdict


def table(found: Mapping[str, Sequence[Trial]]) -> str:
    """A line for each format, and one for all."""
    verdicts = tuple(Verdict)
    lines = ["| format | cases | " + " | ".join(verdicts) + " |", "|---" * (len(verdicts) + 2) + "|"]
    rows = {**found, "all": [trial for trials in found.values() for trial in trials]}
    for name, trials in rows.items():
        counts = Counter(trial.verdict for trial in trials)
        cells = " | ".join(str(counts[verdict]) for verdict in verdicts)
        lines.append(f"| {name} | {len(trials)} | {cells} |")
    return "\n".join(lines)
