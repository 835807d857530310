"""Draw a world, its truth and one recording's scans: `python -m benchmarks.changes.draw OUT.png [WORLD] [--day 6]`.

Needs matplotlib. WORLD is building, lanes, far_lanes, hall with a layout's number (hall1) or a pallet hall
(wh50). The scans lie where the robot's localisation puts them.
"""

from collections.abc import Sequence
from pathlib import Path

import click
import matplotlib as mpl
import numpy as np

from benchmarks.changes.picture_of import WORLDS, Picture, picture_of
from benchmarks.changes.truth import Outline, TrueChange
from sample_logs.drives import Drive
from sample_logs.rays import Floats
from sample_logs.recorder import Event, ScanEvent, TransformEvent
from sample_logs.robot import Motion, compose

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

COLOURS = {"appeared": "#c1440e", "vanished": "#1f6fb2", "moved": "#7b3fa0"}


def draw(out: Path, picture: Picture) -> None:
    """Write the picture: what stands that day grey, changes in colour, the scans black, the way green."""
    drive = picture.drive
    walls = drive.world.walls
    low, high = walls.reshape(-1, 2).min(0), walls.reshape(-1, 2).max(0)
    figure, axes = plt.subplots(figsize=(15, 15 * (high[1] - low[1]) / (high[0] - low[0])))
    axes.plot(*walls.reshape(-1, 2, 2).transpose(2, 1, 0), color="0.55", lw=1)
    for thing in drive.world.things:
        if thing.since <= 0.0 < thing.until:
            axes.add_patch(Polygon(thing.outline, fc="0.85", ec="none"))
    points = scan_points(drive)
    axes.plot(points[:, 0], points[:, 1], ",", color="black", alpha=0.35)
    axes.plot(*drive.motion.poses[:, :2].T, color="#2a9d5c", lw=1)
    for walk in drive.world.walks:
        axes.plot(*walk.positions.T, ":", color="#d1a000", lw=1.5)
        axes.annotate(walk.name, walk.positions[0], color="#8a6a00", fontsize=9)
    for change in picture.changes:
        _draw_change(axes, change)
    axes.set(
        xlim=(low[0] - 0.3, high[0] + 0.3), ylim=(low[1] - 0.3, high[1] + 0.3), aspect="equal",
        xlabel="x [m]", ylabel="y [m]", title=picture.title,
    )  # fmt: skip
    figure.tight_layout()
    figure.savefig(out, dpi=80)


def _draw_change(axes: Axes, change: TrueChange) -> None:
    colour = COLOURS[change.kind]
    days = f" x{len(change.episodes)}" if change.recurring else ""
    here = _middle(change.outline)
    axes.add_patch(Polygon(change.outline, fc="none", ec=colour, lw=2))
    axes.annotate(f"{change.what} {change.kind}{days}", here, color=colour, fontsize=9, ha="center")
    if change.from_outline:
        axes.add_patch(Polygon(change.from_outline, fc="none", ec=colour, lw=2, ls="--"))
        axes.annotate(
            "", here, _middle(change.from_outline), arrowprops={"arrowstyle": "->", "color": colour}
        )


def _middle(outline: Outline) -> tuple[float, float]:
    x, y = np.mean(np.array(outline), axis=0)
    return float(x), float(y)


def scan_points(drive: Drive) -> Floats:
    """Ends (n, 2) [m] of every fifth scan's beams, where the transforms of the recording put them."""
    events = list(drive.events())
    scanner = drive.scanner
    believed = [_poses(events, parent, drive.start_ns) for parent in ("map", "odom")]
    scans = [event for event in events if isinstance(event, ScanEvent)][::5]
    points = []
    for scan in scans:
        times = np.full(scanner.beams, scan.stamp_ns - drive.start_ns, np.float64) / 1e9
        times += np.arange(scanner.beams) * scanner.time_increment
        poses = compose(*(motion.at(times) for motion in believed))
        origins, bearings = scanner.rays(poses)
        ends = origins + scan.ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        points.append(ends[np.isfinite(scan.ranges)])
    return np.concatenate(points)


def _poses(events: Sequence[Event], parent: str, start_ns: int) -> Motion:
    """How the one child of a frame moves in it, by the clock of the drive."""
    sent = [t for e in events if isinstance(e, TransformEvent) for t in e.transforms if t.parent == parent]
    times = np.array([t.stamp_ns - start_ns for t in sent]) / 1e9
    yaws = np.unwrap([2 * np.arctan2(t.rotation[2], t.rotation[3]) for t in sent])
    x, y = np.array([t.translation[:2] for t in sent]).T
    return Motion(times, np.stack([x, y, yaws], axis=1))


@click.command()
@click.argument("out", type=click.Path(path_type=Path))
@click.argument("world", type=click.Choice(WORLDS), default=WORLDS[0])
@click.option("--day", type=click.IntRange(1), default=1, show_default=True, help="Or the run in a hall.")
def main(out: Path, world: str, day: int) -> None:
    """Draw one day of a world into OUT."""
    draw(out, picture_of(world, day))


if __name__ == "__main__":
    main()
