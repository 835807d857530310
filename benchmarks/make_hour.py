"""Make a long recording of a 10 Hz, 1081-beam scanner: `python -m benchmarks.make_hour DIR [--minutes 5]`.

A robot goes round an office building while people walk up and down its corridors. Its transforms come as
those of a robot under nav2 do: odometry 50 times a second, amcl 10 times and stamped ahead, and the wheels'
joints 10 times, both in one message.
"""

from pathlib import Path

import click
import numpy as np
from rosbags.rosbag2 import StoragePlugin

from sample_logs.drives import Drive, Rates
from sample_logs.laser import Mount, Scanner
from sample_logs.recorder import write_ros2_folder
from sample_logs.robot import Motion, drive
from sample_logs.world import Thing, Walk, World, box, wall

LENGTH, DEPTH = 48.0, 26.0
LOWER, UPPER = (8.0, 10.4), (15.6, 18.0)  # the two long corridors, from y to y [m]
CROSSINGS = ((0.0, 2.4), (22.8, 25.2), (45.6, 48.0))
ROOM = 6.0
DOOR = 1.2
SPEED, TURN_RATE = 0.7, 0.8
START_NS = 1_709_542_800_000_000_000

SCANNER = Scanner(
    first_deg=-135.0, step_deg=0.25, beams=1081, period=0.1, sweep_time=0.075, range_min=0.06, range_max=30.0,
    mount=Mount(0.21, 0.0, 0.28, 0.0), missing=0.03,
)  # fmt: skip
RATES = Rates(odometry=50.0, localisation=10.0, wheels=10.0, ahead=1.0)


def building() -> World:
    """Two long corridors with three crossings, 16 rooms outside and 6 between, all furnished."""
    rooms = np.arange(0.0, LENGTH, ROOM)
    doors = [(x + 2.4, x + 2.4 + DOOR) for x in rooms]
    between = [(CROSSINGS[i][1], CROSSINGS[i + 1][0]) for i in (0, 1)]
    middle_doors = [(low + 3.0, low + 3.0 + DOOR) for low, _ in between]
    walls = [
        wall((0, 0), (LENGTH, 0)), wall((0, DEPTH), (LENGTH, DEPTH)),
        wall((0, 0), (0, DEPTH)), wall((LENGTH, 0), (LENGTH, DEPTH)),
        wall((0, LOWER[0]), (LENGTH, LOWER[0]), doors), wall((0, UPPER[1]), (LENGTH, UPPER[1]), doors),
        *(wall((float(x), 0), (float(x), LOWER[0])) for x in rooms[1:]),
        *(wall((float(x), UPPER[1]), (float(x), DEPTH)) for x in rooms[1:]),
    ]  # fmt: skip
    for (low, high), door in zip(between, middle_doors, strict=True):
        walls += [
            wall((low, LOWER[1]), (high, LOWER[1]), [door]),
            wall((low, UPPER[0]), (high, UPPER[0]), [door]),
        ]
        walls += [wall((x, LOWER[1]), (x, UPPER[0])) for x in (low, high)]
        walls += [wall((x, LOWER[1]), (x, UPPER[0])) for x in np.linspace(low, high, 4)[1:-1]]
    return World(np.concatenate(walls), furniture())


def furniture() -> list[Thing]:
    """Cupboards, desks and a column of boxes in every room, none where the robot drives."""
    rng = np.random.Generator(np.random.PCG64(7))
    things = []
    for x in np.arange(0.0, LENGTH, ROOM):
        for back, side in ((0.0, 1.0), (DEPTH, -1.0)):
            jitter = rng.uniform(-0.3, 0.3, 6)
            depth = back + side * np.array([0.4, 1.2, 2.8])
            things += [
                Thing("cupboard", box(x + 1.5 + jitter[0], depth[0], 1.6, 0.5)),
                Thing("desk", box(x + 4.6 + jitter[1], depth[1], 1.4, 0.7, 40 * jitter[2])),
                Thing("bin", box(x + 0.6, depth[2] + jitter[3], 0.35, 0.35)),
                Thing("shelf", box(x + 5.6, depth[2] + jitter[4], 0.4, 1.2)),
                Thing("chair", box(x + 4.3 + jitter[5], depth[1] + side * 0.8, 0.45, 0.45, 100 * jitter[5])),
            ]
    return things


def one_round() -> list[tuple[float, float]]:
    """Along the lower corridor, into every room on the way, back along the upper one in the same way."""
    lower, upper = sum(LOWER) / 2, sum(UPPER) / 2
    doors = np.arange(0.0, LENGTH, ROOM) + 2.4 + DOOR / 2
    route = [(1.2, lower)]
    for x in doors:
        route += [(x, lower), (x, 4.4), (x + 0.6, 3.0), (x, 4.4), (x, lower)]
        if abs(x - 21.0) < 1.0:
            route += [(24.0, lower), (24.0, upper), (24.0, lower)]
    route += [(46.8, lower), (46.8, upper)]
    for x in doors[::-1]:
        route += [(x, upper), (x, 21.6), (x + 0.6, 23.0), (x, 21.6), (x, upper)]
    return [*route, (1.2, upper), (1.2, lower)]


def people(duration: float) -> list[Walk]:
    """Four people who walk up and down the corridors all the time."""
    lanes = (
        (LOWER[0] + 0.5, 1.1, 0.0),
        (LOWER[1] - 0.5, 0.9, 30.0),
        (UPPER[0] + 0.5, 1.2, 10.0),
        (UPPER[1] - 0.5, 0.8, 0.0),
    )
    walks = []
    for i, (y, speed, wait) in enumerate(lanes):
        lap = (LENGTH - 4.0) / speed
        count = int(duration / lap) + 2
        ends = [((2.0, LENGTH - 2.0)[turn % 2], y) for turn in range(count)]
        walks.append(Walk(f"person {i}", wait + lap * np.arange(count, dtype=np.float64), np.array(ends)))
    return walks


def patrol(duration: float) -> Motion:
    """As many rounds as fit into `duration` [s], the last one cut off."""
    once = drive(one_round(), SPEED, TURN_RATE)
    rounds = int(duration / once.duration) + 1
    whole = drive([*one_round()[:-1]] * rounds + one_round()[-1:], SPEED, TURN_RATE)
    stop = int(np.searchsorted(whole.times, duration))
    return Motion(whole.times[:stop], whole.poses[:stop])


def make(folder: Path, minutes: float) -> Path:
    """Write the recording below `folder` unless it is there already; its path."""
    path = folder / f"patrol_{minutes:g}min"
    if (path / "metadata.yaml").exists():
        return path
    motion = patrol(minutes * 60)
    world = building()
    world = World(world.walls, world.things, people(motion.duration))
    folder.mkdir(parents=True, exist_ok=True)
    write_ros2_folder(
        path, Drive(world, motion, SCANNER, RATES, START_NS, seed=1).events(), StoragePlugin.MCAP
    )
    return path


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--minutes", default=60.0, show_default=True, help="Length of the recording.")
def main(folder: Path, minutes: float) -> None:
    """Write the recording into FOLDER and print its path."""
    click.echo(make(folder, minutes))


if __name__ == "__main__":
    main()
