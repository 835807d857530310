"""The small building of the sample recordings: its rooms, what stands in them from when to when, who walks.

Times are seconds since the first recording began (Monday 09:00).

        y=8  +-----------+======glass======+
             |  office   |      lounge     |
        y=5  +---  ------+-----  ----------+
             |          corridor           |
        y=3.2+-----  ------+------  -------+
             |   storage   |   workshop    |
        y=0  +-------------+---------------+
            x=0            6              x=12
"""

from dataclasses import replace

import numpy as np

from sample_logs.robot import Motion, drive
from sample_logs.world import Thing, Walk, World, box, disc, wall

WIDTH, DEPTH = 12.0, 8.0
SOUTH, NORTH = 3.2, 5.0  # the corridor's walls
SPEED, TURN_RATE = 0.6, 1.0

HOUR, DAY = 3600.0, 86400.0
MONDAY, TUESDAY, THURSDAY = 0.0, DAY + 5.5 * HOUR, 3 * DAY + HOUR / 6
CRATE_GONE = 9 * HOUR
PARCEL_LEFT, PARCEL_FETCHED = TUESDAY + 45.0, 2 * DAY - HOUR
REFURNISHED = 2 * DAY + 2 * HOUR

ROUND = (
    (1.0, 4.1), (3.0, 4.1), (3.0, 1.8), (4.6, 2.2), (3.0, 1.8), (3.0, 4.1),
    (9.0, 4.1), (9.0, 1.8), (10.2, 1.6), (7.6, 1.6), (9.0, 1.8), (9.0, 4.1), (11.0, 4.1),
    (8.0, 4.1), (8.0, 5.9), (10.3, 5.9), (7.4, 5.9), (8.0, 5.9), (8.0, 4.1),
    (2.0, 4.1), (2.0, 5.9), (3.6, 6.4), (1.6, 6.2), (2.0, 5.9), (2.0, 4.1), (1.0, 4.1),
)  # fmt: skip


def patrol(rounds: int) -> Motion:
    """The robot goes through all rooms, `rounds` times."""
    return drive([*(ROUND[:-1] * rounds), ROUND[-1]], SPEED, TURN_RATE)


def building(since: float, walks: tuple[Walk, ...]) -> World:
    """The building with its clock set to 0 at `since`; `walks` are by that clock."""
    walls = [
        wall((0, 0), (WIDTH, 0)), wall((0, 0), (0, DEPTH)), wall((WIDTH, 0), (WIDTH, DEPTH)),
        wall((0, DEPTH), (WIDTH, DEPTH), [(7.0, 11.0)]),
        wall((0, SOUTH), (WIDTH, SOUTH), [(2.5, 3.5), (8.5, 9.5)]),
        wall((0, NORTH), (WIDTH, NORTH), [(1.5, 2.5), (7.5, 8.5)]),
        wall((6, 0), (6, SOUTH)), wall((5, NORTH), (5, DEPTH)),
    ]  # fmt: skip
    things = [replace(t, since=t.since - since, until=t.until - since) for t in things_of_the_week()]
    return World(np.concatenate(walls), things, walks, glass=np.array([[7.0, DEPTH, 11.0, DEPTH]]))


def things_of_the_week() -> list[Thing]:
    """Everything that stands anywhere during the week; a thing that is moved is listed once per place."""
    return [
        Thing("long shelf", box(1.5, 0.35, 2.2, 0.5)),
        Thing("short shelf", box(0.3, 2.0, 0.4, 1.4)),
        Thing("bench", box(9.0, 0.4, 2.5, 0.6)),
        Thing("machine", box(11.3, 2.3, 0.9, 0.9)),
        Thing("desk", box(0.5, 6.9, 0.8, 1.6)),
        Thing("sofa", box(11.4, 6.5, 0.8, 2.0)),
        Thing("column", box(5.6, 6.6, 0.4, 0.4)),
        Thing("crate", box(6.8, 0.8, 0.7, 0.6, 15.0), until=CRATE_GONE),
        Thing("parcel", box(5.5, 4.65, 0.6, 0.45), since=PARCEL_LEFT, until=PARCEL_FETCHED),
        Thing("pallet", box(4.8, 0.9, 1.2, 0.8), since=REFURNISHED),
        Thing("cabinet", box(3.4, 7.68, 1.2, 0.5), until=REFURNISHED),
        Thing("barrel", disc(1.4, 2.3, 0.2), until=REFURNISHED),
        Thing("barrel", disc(1.4, 1.6, 0.2), since=REFURNISHED),
        Thing("table", box(9.0, 6.9, 1.4, 0.8), until=REFURNISHED),
        Thing("table", box(6.5, 6.9, 0.8, 1.4), since=REFURNISHED),
    ]


def walk(name: str, start: float, speed: float, *points: tuple[float, float]) -> Walk:
    """Somebody who comes at `start` [s] and walks from point to point; a point twice: a stop of 8 s."""
    positions = np.array(points, dtype=float)
    way = np.hypot(*np.diff(positions, axis=0).T)
    times = start + np.concatenate([[0.0], np.cumsum(np.where(way > 0, way / speed, 8.0))])
    return Walk(name, times, positions)
