"""Print what `timemap check` tells of each mistake and of noise alone, for a simulated recording and given ones."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import click

from benchmarks.mutations.judging import Row, judge, make_baseline
from benchmarks.mutations.mistakes import mistakes, noise
from benchmarks.mutations.rewriting import rewrite
from benchmarks.mutations.simulated import simulated
from benchmarks.mutations.table import table

_SEEDS = 12
_BY = {
    "desk": (0.0, 0.15),
    "machine": (-0.15, 0.0),
    "barrel": (0.15, 0.0),
    "column": (0.0, -0.15),
    "sofa": (0.0, 0.15),  # along the wall behind it: only its side tells
}
_DOUBLED = """levels:
  - {name: short, window: 7, half_life: 5obs}
  - {name: mid, window: 25, half_life: 40obs}
  - {name: long, window: 100, half_life: 200obs}
"""


@click.command()
@click.argument("logs", nargs=-1, type=click.Path(exists=True, path_type=Path))
@click.option(
    "--seeds", default=_SEEDS, show_default=True, help="How many twins differ in nothing but noise."
)
@click.option("--minute-from", default=60.0, show_default=True, help="Where the missing minute begins [s].")
def main(logs: tuple[Path, ...], seeds: int, minute_from: float) -> None:
    """Mutate the simulated recording and LOGS, and check every twin against the baseline of the clean one."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        clean = folder / "simulated.mcap"
        simulated(clean)
        click.echo(table("Simulated", [*_simulated_rows(clean, folder, seeds, minute_from)]))
        for log in logs:
            click.echo(table(log.stem, [*_recorded_rows(log, folder, seeds, minute_from)]))


def _simulated_rows(clean: Path, folder: Path, seeds: int, minute_from: float) -> Iterator[Row]:
    baseline = folder / "simulated.yaml"
    make_baseline(clean, baseline)
    yield judge("nothing", clean, baseline)
    twin = folder / "twin" / clean.name
    twin.parent.mkdir()
    for seed in range(2, seeds + 2):
        simulated(twin, seed=seed)
        yield judge(f"noise, seed {seed}", twin, baseline)
    yield from _mistaken(clean, twin, baseline, minute_from)
    for thing, by in _BY.items():
        simulated(twin, moved=thing, by=by)
        yield judge(f"{thing} moved by 15 cm", twin, baseline)


def _recorded_rows(log: Path, folder: Path, seeds: int, minute_from: float) -> Iterator[Row]:
    baseline, twin = folder / f"{log.stem}.yaml", folder / log.stem / f"{log.stem}.mcap"
    twin.parent.mkdir()
    make_baseline(log, baseline)
    yield judge("nothing", log, baseline)
    for seed in range(seeds):
        rewrite(log, twin, noise(0.01, seed))
        yield judge(f"1 cm more noise, seed {seed}", twin, baseline)
    yield from _mistaken(log, twin, baseline, minute_from)


def _mistaken(clean: Path, twin: Path, baseline: Path, minute_from: float) -> Iterator[Row]:
    for name, change in mistakes(minute_from).items():
        rewrite(clean, twin, change)
        yield judge(name, twin, baseline)
    config = twin.parent / "doubled.yaml"
    config.write_text(_DOUBLED, encoding="utf-8")
    yield judge("half-life of mid doubled", clean, baseline, config)


if __name__ == "__main__":
    main()
