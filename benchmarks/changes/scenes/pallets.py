"""Halls whose pallets are redrawn every night: what is told of them from day to day, and the maps of the last day."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks.changes.days import day_by_day
from benchmarks.changes.maps import levels_of, maps_of_day, walls_left
from benchmarks.changes.places import APPEARED, VANISHED
from benchmarks.changes.recordings import folder_of, make, replayed, timemap_json
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.slots import SlotClaim, SlotScore, Turn, score_slots
from benchmarks.changes.table import maps_table
from benchmarks.changes.truth import Bounds, Truth, recorded
from benchmarks.changes.worlds import clearance, pallet_hall, patrols
from benchmarks.changes.worlds.pallet_hall import PLACES, Stay
from sample_logs.rays import Floats
from timemap_cli.results.reader import ResultReader

QUICK_WORLDS, QUICK_DAYS = ("wh50",), 4


def pallet_halls(work: Work) -> Iterator[str]:
    """Figures of each world."""
    worlds = QUICK_WORLDS if work.quick else pallet_hall.WORLDS
    days = QUICK_DAYS if work.quick else work.pallet_days
    made = folder_of(work.folder, "pallets", (pallet_hall, clearance, patrols))
    for world in worlds:
        yield _world(world, days, made / f"{world}_{days}", work)


def _world(world: str, days: int, made: Path, work: Work) -> str:
    drives = pallet_hall.drives(world, days)
    replay = replayed(make(made, drives), made / "all.timemap.mcap", again=work.again)
    result = replay.result
    with ResultReader(result) as reader:
        nodes = len(reader.nodes)
    truth = Truth(tuple(recorded(name, day, d) for day, (name, d) in enumerate(drives.items(), 1)), ())
    turns = turns_of(pallet_hall.stays(world, days), days)
    lines = [
        f"{world}, {days} days, {nodes} nodes, {replay.lost}",
        f"  {'diff from day to day':24}{'told':>9}{'at once':>9}{'recall':>8}{'F1':>6}"
        f"{'false':>7}{'again':>7}{'compared':>10}",
    ]
    for level in levels_of(result):
        scored, share = _of_level(result, level, truth, nodes, turns)
        lines.append(
            f"  {level:24}{f'{scored.told}/{scored.turns}':>9}{scored.at_once:>9}{scored.recall:>8.2f}"
            f"{scored.f1:>6.2f}{len(scored.false):>7}{scored.again:>7}{share:>10.1%}"
        )
    document = timemap_json("changes", str(result))
    left = {level: walls_left(result, document, level) for level in levels_of(result)}
    return "\n".join([*lines, maps_table({days: maps_of_day(result, list(drives.values()), days)}, left)])


def _of_level(
    result: Path, level: str, truth: Truth, nodes: int, turns: Sequence[Turn]
) -> tuple[SlotScore, float]:
    """How well a level's differences tell the turns, and the mean share of the bins that were compared."""
    events, shares = day_by_day(result, level, truth, nodes)
    day_of = {one.start_ns: one.day for one in truth.recordings}
    told = []
    for event in events:
        day = day_of[event.first_seen_ns]
        if event.moved_from:
            told.append(SlotClaim(VANISHED, event.moved_from, day))
        told.append(SlotClaim(VANISHED if event.kind == VANISHED else APPEARED, event.bounds, day))
    return score_slots(told, turns), sum(shares) / len(shares)


def turns_of(stays: Sequence[Stay], days: int) -> list[Turn]:
    """All that happens at the places after the first day, in the order of the places."""
    found = []
    for place in range(len(PLACES)):
        mine = [stay for stay in stays if stay.place == place]
        on = [next((stay for stay in mine if _there(stay, day)), None) for day in range(1, days + 1)]
        nights = [(day, a, b) for day, (a, b) in enumerate(pairwise(on), 2) if a is not b]
        changed = [day for day, _, _ in nights]
        toggled = [day for day, a, b in nights if a is None or b is None]
        for day, before, now in nights:
            kind = APPEARED if before is None else VANISHED if now is None else None
            outlines = [stay.outline for stay in (before, now) if stay is not None]
            later = [d for d in (toggled if kind else changed) if d > day]
            bounds = _bounds(np.concatenate(outlines))
            found.append(Turn(place, kind, bounds, day, later[0] if later else None))
    return found


def _there(stay: Stay, day: int) -> bool:
    return stay.first_day <= day and (stay.gone_day is None or day < stay.gone_day)


def _bounds(outline: Floats) -> Bounds:
    (x_min, y_min), (x_max, y_max) = outline.min(0).tolist(), outline.max(0).tolist()
    return x_min, y_min, x_max, y_max
