"""How well timemap tells the changes of a building whose changes are known: `python -m benchmarks.changes`.

Twelve patrols are made if the folder does not hold them yet, replayed into one result, and its events are judged
against the truth; so are the differences from day to day.
"""

import hashlib
import subprocess
from pathlib import Path

import click
import numpy as np

from benchmarks.changes import building, patrols
from benchmarks.changes.building import DAYS
from benchmarks.changes.days import TIMEMAP, day_by_day, timemap_json
from benchmarks.changes.places import read_events
from benchmarks.changes.scores import score
from benchmarks.changes.table import days_table, events_table, recordings_table
from benchmarks.changes.truth import Truth, building_truth
from benchmarks.changes.truth_json import from_json, to_json
from benchmarks.changes.visits import paces
from timemap_cli.results.reader import ResultReader

ROOT = Path(__file__).resolve().parents[2]
QUICK_DAYS = 6  # the door, the furniture and the pallet's coming


def recordings_folder(folder: Path) -> Path:
    """Where recordings made by the scripts as they are now belong."""
    made_by = sorted((ROOT / "sample_logs").glob("*.py"))
    made_by += [Path(str(module.__file__)) for module in (building, patrols)]
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in made_by))
    return folder / digest.hexdigest()[:8]


def replay(recordings: list[Path], result: Path) -> None:
    """Replay all recordings into one result."""
    subprocess.run(
        [TIMEMAP, "replay", *map(str, recordings), "-o", str(result), "--force", "--quiet"], check=True
    )


def unknown_share(reader: ResultReader, level: str) -> float:
    """Share of all angle bins of all nodes of which a level knows nothing at the end."""
    known = sum(int(np.sum(~np.isnan(e.ranges))) for e in reader.estimates(level).values())
    return 1 - known / (len(reader.nodes) * reader.angle_bins)


def report(result: Path, truth: Truth) -> str:
    """All figures of a result."""
    with ResultReader(result) as reader:
        nodes = len(reader.nodes)
        unknown = {level: unknown_share(reader, level) for level in reader.levels}
    parts = [recordings_table(truth.recordings) + f", {nodes} nodes"]
    try:
        document = timemap_json("changes", str(result))
    except RuntimeError as error:
        parts.append(f"no events: {error}")
    else:
        level_paces = paces(result, patrols.patrols(len(truth.recordings)))
        parts.append(events_table(score(read_events(document), truth, level_paces)))
    days = [day_by_day(result, level, truth, nodes) for level in unknown]
    return "\n\n".join([*parts, days_table(days, unknown)])


@click.command()
@click.option("--quick", is_flag=True, help=f"Only the first {QUICK_DAYS} days.")
@click.option(
    "--folder", type=click.Path(path_type=Path), default=ROOT / "build" / "changes", show_default=True
)
def main(quick: bool, folder: Path) -> None:
    """Make the patrols, replay them, and judge what timemap tells of them."""
    days = QUICK_DAYS if quick else DAYS
    made = recordings_folder(folder.resolve())
    recordings = patrols.make(made, patrols.patrols(days))
    truth = made / f"truth_{days}.json"
    truth.write_text(to_json(building_truth(days)), encoding="utf-8")
    result = made / f"days_{days}.timemap.mcap"
    replay(recordings, result)
    click.echo(report(result, from_json(truth.read_text(encoding="utf-8"))))


if __name__ == "__main__":
    main()
