"""Draw the building, its truth and one day's scans: `python -m benchmarks.changes.draw OUT.png [--day 6]`.

Needs matplotlib. The scans lie where the robot's localisation puts them.
"""

from collections.abc import Sequence
from pathlib import Path

import click
import matplotlib as mpl
import numpy as np

from benchmarks.changes.building import DAYS, DEPTH, WIDTH, things, walls
from benchmarks.changes.patrols import SCANNER, Patrol, patrols
from benchmarks.changes.truth import Outline, TrueChange, building_truth
from sample_logs.rays import Floats
from sample_logs.recorder import Event, ScanEvent, TransformEvent
from sample_logs.robot import Motion, compose

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

COLOURS = {"appeared": "#c1440e", "vanished": "#1f6fb2", "moved": "#7b3fa0"}


def draw(out: Path, day: int) -> None:
    """Write the picture: things that stay grey, changes in colour, the day's scans black, its way green."""
    patrol = patrols()[day - 1]
    figure, axes = plt.subplots(figsize=(15, 15 * DEPTH / WIDTH))
    for x1, y1, x2, y2 in walls():
        axes.plot([x1, x2], [y1, y2], color="0.55", lw=1)
    for thing in things():
        axes.add_patch(Polygon(thing.outline, fc="0.9", ec="none"))
    points = scan_points(patrol)
    axes.plot(points[:, 0], points[:, 1], ",", color="black", alpha=0.35)
    way = patrol.drive().motion.poses
    axes.plot(way[:, 0], way[:, 1], color="#2a9d5c", lw=1)
    for walk in patrol.walks:
        axes.plot(*walk.positions.T, ":", color="#d1a000", lw=1.5)
        axes.annotate(walk.name, walk.positions[0], color="#8a6a00", fontsize=9)
    for change in building_truth(DAYS).changes:
        _draw_change(axes, change)
    axes.set(
        xlim=(-0.3, WIDTH + 0.3), ylim=(-0.3, DEPTH + 0.3), aspect="equal", xlabel="x [m]", ylabel="y [m]",
        title=f"the truth of {DAYS} days, and the scans of day {day}",
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


def scan_points(patrol: Patrol) -> Floats:
    """Ends (n, 2) [m] of every fifth scan's beams, where the transforms of the recording put them."""
    events = list(patrol.drive().events())
    believed = [_poses(events, parent, patrol.start_ns) for parent in ("map", "odom")]
    scans = [event for event in events if isinstance(event, ScanEvent)][::5]
    points = []
    for scan in scans:
        times = np.full(SCANNER.beams, scan.stamp_ns - patrol.start_ns, np.float64) / 1e9
        times += np.arange(SCANNER.beams) * SCANNER.time_increment
        poses = compose(*(motion.at(times) for motion in believed))
        origins, bearings = SCANNER.rays(poses)
        ends = origins + scan.ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        points.append(ends[np.isfinite(scan.ranges)])
    return np.concatenate(points)


def _poses(events: Sequence[Event], parent: str, start_ns: int) -> Motion:
    """How the one child of a frame moves in it, by the clock of the patrol."""
    sent = [t for e in events if isinstance(e, TransformEvent) for t in e.transforms if t.parent == parent]
    times = np.array([t.stamp_ns - start_ns for t in sent]) / 1e9
    yaws = np.unwrap([2 * np.arctan2(t.rotation[2], t.rotation[3]) for t in sent])
    x, y = np.array([t.translation[:2] for t in sent]).T
    return Motion(times, np.stack([x, y, yaws], axis=1))


@click.command()
@click.argument("out", type=click.Path(path_type=Path))
@click.option("--day", type=click.IntRange(1, DAYS), default=6, show_default=True)
def main(out: Path, day: int) -> None:
    """Draw the building into OUT."""
    draw(out, day)


if __name__ == "__main__":
    main()
