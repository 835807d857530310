"""Make the sample recordings beside this file: `python -m sample_logs.make_samples [FOLDER]`.

The same bytes come out every time (with the same versions of NumPy, rosbags and SQLite).
"""

import json
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

import click
from rosbags.rosbag2 import StoragePlugin

from sample_logs.building import MONDAY, THURSDAY, TUESDAY, building, patrol, things_of_the_week, walk
from sample_logs.drives import Drive, Rates
from sample_logs.laser import Mount, Scanner
from sample_logs.recorder import write_ros1_bag, write_ros2_folder
from sample_logs.truth import truth
from sample_logs.world import Walk

FIRST_NS = 1_709_542_800_000_000_000  # 2024-03-04 09:00 UTC, a Monday


@dataclass(frozen=True, slots=True)
class Day:
    """One patrol: when, how many rounds, with which scanner, who walked, and the file it becomes."""

    file: str
    begins: float
    rounds: int
    scanner: Scanner
    walks: tuple[Walk, ...]
    rates: Rates

    def drive(self) -> Drive:
        """The recording's contents."""
        start_ns = FIRST_NS + round(self.begins * 1e9)
        world = building(self.begins, self.walks)
        return Drive(world, patrol(self.rounds), self.scanner, self.rates, start_ns, seed=int(self.begins))


COUNT = 1 / 256  # [m]; ranges in binary counts are short when compressed

FRONT = Scanner(
    first_deg=-120.0, step_deg=1.0, beams=241, period=0.208, sweep_time=0.139, range_min=0.1, range_max=12.0,
    mount=Mount(0.18, 0.05, 0.25, 0.0), missing=0.01, resolution=COUNT,
)  # fmt: skip
UPSIDE_DOWN = Scanner(
    first_deg=-135.0, step_deg=1.0, beams=271, period=0.208, sweep_time=0.156, range_min=0.1, range_max=10.0,
    mount=Mount(-0.05, -0.12, 0.62, 10.0, upside_down=True), missing=0.01, resolution=COUNT, no_return=11.0,
)  # fmt: skip


def days() -> list[Day]:
    """Monday, Tuesday and Thursday."""
    monday = (
        walk("visitor", 20.0, 1.1, (11.5, 3.6), (0.5, 3.6)),
        walk("visitor", 168.0, 1.1, (0.5, 4.6), (11.5, 4.6)),
        walk("colleague", 200.0, 0.9, (0.5, 3.6), (9.0, 3.6), (9.0, 2.6), (10.5, 1.0), (10.5, 1.0),
             (9.0, 2.6), (9.0, 3.6), (11.5, 3.6)),
    )  # fmt: skip
    tuesday = (
        walk("colleague", 15.0, 1.0, (11.5, 3.6), (4.0, 3.6), (0.5, 3.6)),
        walk("courier", 36.0, 1.2, (0.5, 4.5), (4.9, 4.3), (4.9, 4.3), (0.5, 4.5)),
        walk("visitor", 246.0, 1.1, (0.5, 3.6), (11.5, 3.6)),
    )
    thursday = (
        walk("visitor", 66.0, 1.0, (11.5, 3.6), (0.5, 3.6)),
        walk("colleague", 245.0, 0.9, (0.5, 4.6), (4.0, 4.6), (4.0, 4.6), (11.5, 4.6)),
    )
    return [
        Day("patrol_monday.mcap", MONDAY, 3, FRONT, monday, Rates(10.0, 4.0)),
        Day("patrol_tuesday.bag", TUESDAY, 3, UPSIDE_DOWN, tuesday, Rates(10.0, 4.0, ahead=0.1)),
        Day("patrol_thursday", THURSDAY, 2, FRONT, thursday, Rates(10.0, 4.0)),
    ]


def make(folder: Path) -> None:
    """Write the recordings and `truth.json` into `folder`, in place of what is there."""
    for day in days():
        write(folder / day.file, day.drive())
    text = json.dumps(
        truth({day.file: day.drive() for day in days()}, things_of_the_week(), FIRST_NS), indent=1
    )
    (folder / "truth.json").write_text(text + "\n", encoding="utf-8")


def write(path: Path, drive: Drive) -> None:
    """Write one recording; its format follows from the ending of its name."""
    with tempfile.TemporaryDirectory(dir=path.parent) as beside:
        made = Path(beside) / path.stem
        if path.suffix == ".bag":
            made = made.with_suffix(".bag")
            write_ros1_bag(made, drive.events())
        elif path.suffix == ".mcap":
            write_ros2_folder(made, drive.events(), StoragePlugin.MCAP, compressed=True)
            made = made / path.name
        else:
            write_ros2_folder(made, drive.events(), StoragePlugin.SQLITE3)
        if path.is_dir():
            shutil.rmtree(path)
        made.replace(path)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path), default=Path(__file__).parent)
def main(folder: Path) -> None:
    """Write the sample recordings into FOLDER (default: beside this script)."""
    folder.mkdir(parents=True, exist_ok=True)
    make(folder)


if __name__ == "__main__":
    main()
