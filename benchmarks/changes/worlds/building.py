"""Five rooms and a corridor: walls, what stands where from when to when, and the robot's round.

Times are seconds since midnight before the first patrol; day 1 is the first.

        y=11 +---------------+--------------------+
             |    meeting    |       store        |
        y=6.7+-------  ------+------[door]--------+
             |              corridor              |
        y=4.4+-----  ---+-----  ----+-----  ------+
             |  office  |  kitchen  |  workshop   |
        y=0  +----------+-----------+-------------+
            x=0         6          11.5          x=18
"""

from dataclasses import replace

import numpy as np

from sample_logs.rays import Floats
from sample_logs.world import Thing, Walk, World, box, disc, wall

WIDTH, DEPTH = 18.0, 11.0
SOUTH, NORTH = 4.4, 6.7  # the corridor's walls
LANE = 5.2  # where the robot drives along the corridor
SPEED, TURN_RATE = 0.8, 1.2  # walking pace
DOORWAYS = {"office": 3.5, "kitchen": 8.7, "workshop": 15.0, "store": 13.0, "meeting": 4.5}  # middle x
DOORWAY = 1.1

DAY = 86400.0
DAYS = 12
NEVER = np.inf


def morning(day: int) -> float:
    """Seconds at which a day begins."""
    return (day - 1) * DAY


REFURNISHED = morning(4)
TABLE, DEVICE = (1.8, 0.9), (0.9, 0.7)


def door_open(day: int) -> bool:
    """Whether the store's sliding door is open, in the wall, on that day."""
    return day % 2 == 0


def things() -> list[Thing]:
    """Everything that stands anywhere in the twelve days; a thing that is moved is listed once per place."""
    return [*_furniture_that_stays(), *_furniture_that_changes(), *_door()]


def _furniture_that_stays() -> list[Thing]:
    return [
        Thing("desk", box(0.6, 1.1, 0.8, 1.6)),
        Thing("cupboard", box(3.2, 0.35, 1.8, 0.5)),
        Thing("counter", box(8.75, 0.4, 3.5, 0.6)),
        Thing("fridge", box(11.0, 3.7, 0.7, 0.7)),
        Thing("workbench", box(15.0, 0.4, 3.0, 0.6)),
        Thing("machine", box(17.3, 3.5, 1.0, 1.0)),
        Thing("long shelf", box(13.4, 10.6, 3.0, 0.5)),
        Thing("short shelf", box(17.6, 9.0, 0.5, 2.0)),
        Thing("sofa", box(0.6, 8.6, 0.8, 2.0)),
        Thing("column", box(9.4, 7.3, 0.4, 0.4)),
    ]


def _furniture_that_changes() -> list[Thing]:
    return [
        Thing("bookcase", box(5.6, 1.4, 0.5, 1.4), until=REFURNISHED),
        Thing("bookcase", box(5.6, 3.4, 0.5, 1.4), since=REFURNISHED),
        Thing("bin", disc(0.7, 3.3, 0.22), until=REFURNISHED),
        Thing("bin", disc(1.5, 3.7, 0.22), since=REFURNISHED),
        Thing("armchair", box(6.7, 3.5, 0.8, 0.8, 20.0), until=REFURNISHED),
        Thing("trolley", box(12.3, 0.9, 0.8, 0.5, 15.0), until=REFURNISHED),
        Thing("trolley", box(12.1, 3.3, 0.8, 0.5, 80.0), since=REFURNISHED),
        Thing("table", box(2.7, 10.2, *TABLE), until=REFURNISHED),
        Thing("table", box(7.0, 9.6, *TABLE[::-1]), since=REFURNISHED),
        Thing("crates", box(8.8, 10.3, *DEVICE), until=REFURNISHED),
        Thing("crates", box(16.3, 7.3, *DEVICE), since=REFURNISHED),
        Thing("cabinet", box(10.8, 10.6, 1.0, 0.5), since=REFURNISHED),
        Thing("pallet", box(10.6, 6.2, 1.2, 0.8), since=morning(6), until=morning(8)),
    ]


def _door() -> list[Thing]:
    """The leaf, as one thing for every stretch of days on which it is shut."""
    leaf = box(DOORWAYS["store"], NORTH, DOORWAY, 0.06)
    shut = [day for day in range(1, DAYS + 1) if not door_open(day)]
    return [
        Thing("door", leaf, since=-NEVER if day == 1 else morning(day), until=morning(day + 1))
        for day in shut
    ]


def walls() -> Floats:
    """Segments (m, 4) of the walls, open where the doorways are."""
    gaps = {room: (x - DOORWAY / 2, x + DOORWAY / 2) for room, x in DOORWAYS.items()}
    return np.concatenate([
        wall((0, 0), (WIDTH, 0)), wall((0, DEPTH), (WIDTH, DEPTH)),
        wall((0, 0), (0, DEPTH)), wall((WIDTH, 0), (WIDTH, DEPTH)),
        wall((0, SOUTH), (WIDTH, SOUTH), [gaps["office"], gaps["kitchen"], gaps["workshop"]]),
        wall((0, NORTH), (WIDTH, NORTH), [gaps["meeting"], gaps["store"]]),
        wall((6, 0), (6, SOUTH)), wall((11.5, 0), (11.5, SOUTH)), wall((8, NORTH), (8, DEPTH)),
    ])  # fmt: skip


def building(since: float, walks: tuple[Walk, ...] = ()) -> World:
    """The building with its clock set to 0 at `since`; `walks` are by that clock."""
    here = [replace(t, since=t.since - since, until=t.until - since) for t in things()]
    return World(walls(), here, walks)


def route(day: int) -> list[tuple[float, float]]:
    """From the west end of the corridor through the rooms and back; the store only where it is open."""
    points = [(1.0, LANE)]
    points += _visit("office", 3.2, (1.9, 2.4), (4.3, 1.7))
    points += _visit("kitchen", 3.2, (7.4, 2.0), (10.2, 2.0))
    points += _visit("workshop", 3.2, (13.3, 2.0), (16.4, 1.9))
    points += [(17.0, LANE)]
    if door_open(day):
        points += _visit("store", 7.9, (10.2, 8.8), (15.8, 8.8))
    points += _visit("meeting", 7.9, (2.4, 8.6), (6.0, 8.6))
    return [*points, (1.0, LANE)]


def _visit(room: str, inside_y: float, *corners: tuple[float, float]) -> list[tuple[float, float]]:
    x = DOORWAYS[room]
    return [(x, LANE), (x, inside_y), *corners, (x, inside_y), (x, LANE)]
