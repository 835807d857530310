"""What the guard sets aside, of robots that are lost and of others: `python -m benchmarks.lost [LOG...]`.

Halls of pallets, of which many are moved every night, are learnt for ten days with right poses: nothing is to be set
aside. Runs of one place, in their order, are learnt three times over with poses that tremble; then the last one
follows once more, with wrong poses.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import click

from benchmarks.changes.recordings import make
from benchmarks.changes.worlds import pallet_hall
from benchmarks.lost.drives import (
    TRACKING,
    Drive,
    Wrong,
    added,
    another_each,
    believed,
    in_turn,
    recorded,
    shaken,
    shifted,
    straying,
)
from benchmarks.lost.trial import Map, learnt, off
from timemap_cli.config import Settings, load

ROOT = Path(__file__).resolve().parents[2]
DAY_NS, MINUTE_NS = 86_400_000_000_000, 60_000_000_000
TIMES = 3  # that all runs are learnt first


@dataclass(frozen=True, slots=True)
class Row:
    """How a robot is lost."""

    name: str
    wrong: Wrong
    runs: int = 1
    apart_ns: int = DAY_NS


def rows(along_deg: float) -> list[Row]:
    """The ways to be lost in a corridor that runs `along_deg` in the map."""
    askew = along_deg + 45
    return [
        Row("right", shaken(*TRACKING)),
        Row("0.5 m, askew to the corridor", shifted(0.5, askew)),
        Row("0.5 m along the corridor", shifted(0.5, along_deg)),
        Row("20°", shifted(0.0, 0.0, 20.0)),
        Row("0.5 m and 20°", shifted(0.5, askew, 20.0)),
        Row("0.5 m and 20°, another for each scan", added(another_each(0.5, 20.0), shaken(*TRACKING))),
        Row("0.5 m and 20°, straying", added(straying(0.5, 20.0), shaken(*TRACKING))),
        Row("0.5 m, five runs a minute apart", shifted(0.5, askew), 5, MINUTE_NS),
        Row("0.5 m, five runs a day apart", shifted(0.5, askew), 5),
        Row("8 m along the corridor, and turned about", shifted(8.0, along_deg, 180.0)),
    ]


def table(drives: Sequence[Drive], settings: Settings, along_deg: float) -> list[str]:
    """What becomes of the scans of each row, with the guard and without."""
    first = _first_ns(drives[0])
    lines, last = [], drives[-1]
    before = [
        _later(drive, first + i * DAY_NS, shaken(*TRACKING), i)
        for i, drive in enumerate(in_turn(drives, TIMES))
    ]
    outcomes, known = learnt(before, settings)
    scans, judged, lost = (sum(getattr(o, name) for o in outcomes) for name in ("scans", "judged", "lost"))
    lines.append(f"before: {scans} scans, {judged} judged, {lost} set aside")
    off_guard = replace(settings, gate=replace(settings.gate, max_contradiction=1.0))
    for row in rows(along_deg):
        begin = first + len(before) * DAY_NS
        runs = [_later(last, begin + i * row.apart_ns, row.wrong, 100 + i) for i in range(row.runs)]
        lines.append(_row(row, runs, known, settings, off_guard))
    return lines


def _row(row: Row, runs: list[Drive], known: Map, settings: Settings, off_guard: Settings) -> str:
    outcomes, with_guard = learnt(runs, settings, known)
    _, without = learnt(runs, off_guard, known)
    aside = ", ".join(f"{o.lost} of {o.judged}" for o in outcomes)
    levels = [level.name for level in settings.levels]
    shares = (f"{off(known, without, level):.2f}, {off(known, with_guard, level):.2f}" for level in levels)
    return f"| {row.name} | {aside} | " + " | ".join(shares) + " |"


def _first_ns(drive: Drive) -> int:
    return int(drive[0].stamps_ns[0])


def _later(drive: Drive, begin_ns: int, wrong: Wrong, seed: int) -> Drive:
    return believed(drive, wrong, seed, begin_ns - _first_ns(drive))


def hall(folder: Path, kind: str, settings: Settings) -> str:
    """What becomes of the scans of ten days in a hall: how many can be judged, and how many are set aside."""
    drives = [recorded(path, settings) for path in make(folder / kind, pallet_hall.drives(kind))]
    outcomes, _ = learnt(drives, settings)
    judged, lost = (sum(getattr(o, name) for o in outcomes) for name in ("judged", "lost"))
    return f"| {kind} | {judged} | {lost} |"


@click.command()
@click.argument("logs", nargs=-1, type=click.Path(exists=True, path_type=Path))
@click.option("--along", default=-5.0, show_default=True, help="Direction of the LOGs' corridor, in degrees.")
@click.option("--halls/--no-halls", default=True, help="Whether to learn the halls of pallets.")
@click.option(
    "--folder", type=click.Path(path_type=Path), default=ROOT / "build" / "halls", show_default=True
)
def main(logs: tuple[Path, ...], along: float, halls: bool, folder: Path) -> None:
    """Learn the halls; then the LOGs, and the last of them with wrong poses."""
    settings = load(None)
    for kind in pallet_hall.WORLDS if halls else ():
        click.echo(hall(folder, kind, settings))
    for line in table([recorded(log, settings) for log in logs], settings, along) if logs else ():
        click.echo(line)


if __name__ == "__main__":
    main()
