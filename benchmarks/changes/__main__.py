"""How well timemap tells what changed where that is known: `python -m benchmarks.changes`.

Recordings are made if their folder does not hold them yet, replayed, and what is told of them is judged against the
truth, scene by scene. The program measured is the `timemap` beside the Python that runs this.
"""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import click

from benchmarks.changes.recordings import ROOT
from benchmarks.changes.scenes.building import far_lanes, other_lanes, same_lanes
from benchmarks.changes.scenes.hall import open_halls
from benchmarks.changes.scenes.pallets import pallet_halls
from benchmarks.changes.scenes.real import real_recordings
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.worlds.pallet_hall import DAYS

SCENES: Mapping[str, Callable[[Work], Iterator[str]]] = {
    "building": same_lanes,
    "lanes": other_lanes,
    "far_lanes": far_lanes,
    "hall": open_halls,
    "pallets": pallet_halls,
    "real": real_recordings,
}


@click.command()
@click.option("--scene", "scenes", type=click.Choice(list(SCENES)), multiple=True, help="Default: all.")
@click.option("--quick", is_flag=True, help="Fewer days and layouts.")
@click.option("--again", is_flag=True, help="Replay anew what has been replayed before.")
@click.option(
    "--folder", type=click.Path(path_type=Path), default=ROOT / "build" / "changes", show_default=True
)
@click.option("--pallet-days", type=click.IntRange(2), default=DAYS, show_default=True)
@click.option(
    "--data",
    type=click.Path(path_type=Path, exists=True, file_okay=False),
    envvar="TIMEMAP_RECORDINGS",
    help="Folder of real recordings; also the environment variable TIMEMAP_RECORDINGS.",
)
def main(
    scenes: tuple[str, ...], quick: bool, again: bool, folder: Path, pallet_days: int, data: Path | None
) -> None:
    """Make recordings, replay them, and judge what timemap tells of them."""
    work = Work(folder.resolve(), quick, again, pallet_days, data.resolve() if data else None)
    for name in scenes or SCENES:
        click.echo(f"== {name}\n")
        for part in SCENES[name](work):
            click.echo(part + "\n")


if __name__ == "__main__":
    main()
