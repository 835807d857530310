"""The table of what became of damaged recordings."""

from collections import Counter
from collections.abc import Mapping, Sequence

from benchmarks.damage.trial import Trial, Verdict


def table(found: Mapping[str, Sequence[Trial]]) -> str:
    """A line for each format, and one for all."""
    head = ["| format | cases | " + " | ".join(Verdict) + " |", "|---" * (len(Verdict) + 2) + "|"]
    everything = [trial for trials in found.values() for trial in trials]
    return "\n".join([*head, *(row(name, trials) for name, trials in found.items()), row("all", everything)])


def row(name: str, trials: Sequence[Trial]) -> str:
    """How many trials came to which verdict."""
    counts = Counter(trial.verdict for trial in trials)
    return f"| {name} | {len(trials)} | " + " | ".join(str(counts[verdict]) for verdict in Verdict) + " |"
