"""What becomes of recordings that are damaged at random: `python -m benchmarks.damage`.

Small recordings of every format are damaged, thousands of times, and replayed. No damage may end in a traceback,
a hang, more than 1 GB of memory, or a result that looks complete and is not.
"""

import sys
from collections import Counter

import click

from benchmarks.damage.recordings import FORMATS
from benchmarks.damage.table import row, table
from benchmarks.damage.trial import BAD, Trial, sentence
from benchmarks.damage.workers import run


@click.command()
@click.option("--cases", default=20_000, show_default=True, help="Over all formats.")
@click.option("--seed", default=0, show_default=True)
@click.option("--format", "names", multiple=True, type=click.Choice(tuple(FORMATS)), help="Only this format.")
@click.option(
    "--from", "first", default=0, show_default=True, help="Number of the first case of each format."
)
@click.option("--workers", default=2, show_default=True)
@click.option("--sentences", is_flag=True, help="Print what was said, and how often.")
def main(cases: int, seed: int, names: tuple[str, ...], first: int, workers: int, sentences: bool) -> None:
    """Damage recordings, replay them, and print a table of what became of them."""
    chosen = names or tuple(FORMATS)
    each = -(-cases // len(chosen))
    found: dict[str, list[Trial]] = {}
    for name in chosen:
        found[name] = run(name, range(first, first + each), seed, workers)
        click.echo(row(name, found[name]), err=True)
        for trial in found[name]:
            if trial.verdict in BAD:
                click.echo(f"{name}, case {trial.number}: {trial.damage}: {trial.verdict}\n{trial.words}")
    click.echo(table(found))
    if sentences:
        said = Counter(sentence(trial.words) for trials in found.values() for trial in trials)
        click.echo("\n".join(f"{count:6} {line}" for line, count in said.most_common()))
    sys.exit(any(trial.verdict in BAD for trials in found.values() for trial in trials))


if __name__ == "__main__":
    main()
