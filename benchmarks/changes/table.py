"""The figures as text."""

from collections.abc import Mapping, Sequence
from statistics import median

from benchmarks.changes.days import Days
from benchmarks.changes.maps import MapScore, mean_score
from benchmarks.changes.places import Claim, Place
from benchmarks.changes.scores import MOST_HALF_LIVES, Adoption, Found, Score
from benchmarks.changes.truth import Recorded


def events_table(score: Score) -> str:
    """What the events are worth, then every place missed and every false claim."""
    found = score.found
    lines = [
        "events",
        f"  places told        {len(found.match)} of {len(found.places)}",
        f"  recall             {_share(found.recall)}",
        f"  precision          {_share(found.precision)}",
        f"  F1                 {found.f1:.2f}",
        f"  false              {len(found.false)} ({len(found.false) / score.patrols:.2f} per patrol), "
        f"{len(found.again)} of them told again",
        f"  false, quiet days  {score.quiet_false} ({score.quiet_patrols} patrols, {score.quiet_area:.2f} m2)",
        f"  false area         {score.area:.2f} m2",
        f"  people             {len(found.people)}, in no slow level",
        f"  flicker            {_share(score.flicker)} toggles too many per event",
        f"  told as moved      {score.moves[0]} of {score.moves[1]}",
        f"  told as recurring  {score.recurring[0]} of {score.recurring[1]}",
        *_adoption_lines(score.adoptions),
    ]
    return "\n".join([*lines, *_missed(found.missed), *_false(found)])


def _adoption_lines(adoptions: Sequence[Adoption]) -> list[str]:
    lines = []
    for level in dict.fromkeys(a.level for a in adoptions):
        mine = [a for a in adoptions if a.level == level]
        took = [a.half_lives for a in mine if a.adopted]
        overdue = sum(a.late and not a.adopted for a in mine)
        text = f"median {median(took):.2f}, most {max(took):.2f} half-lives at the estimate; " if took else ""
        lines.append(
            f"  adopted, {level:9} {len(took)} of {len(mine)}; {text}"
            f"{sum(a.late and a.adopted for a in mine)} late, {overdue} overdue (beyond {MOST_HALF_LIVES})"
        )
    return lines


def days_table(days: Sequence[Days], unknown: Mapping[str, float]) -> str:
    """What comparing days is worth, one line for each level, then what was missed and false."""
    lines = [
        "timemap diff from day to day",
        f"  {'level':8}{'told':>9}{'at once':>9}{'recall':>8}{'precision':>11}{'F1':>6}{'false':>7}{'again':>7}"
        f"{'quiet':>7}{'area m2':>9}{'compared':>10}{'unknown':>9}",
    ]
    for d in days:
        told = f"{len(d.found.match)}/{len(d.found.places)}"
        lines.append(
            f"  {d.level:8}{told:>9}{d.at_once:>9}{_share(d.found.recall):>8}{_share(d.found.precision):>11}"
            f"{d.found.f1:>6.2f}{len(d.found.false):>7}{len(d.found.again):>7}{d.quiet_false:>7}{d.area:>9.2f}"
            f"{d.compared:>10.1%}{unknown[d.level.rstrip('*')]:>9.1%}"
        )
    if any(d.level.endswith("*") for d in days):
        lines.append("  * only turns that last the level's half-life; the others are neither right nor false")
    for d in days:
        lines += [f"  {d.level}:", *_missed(d.found.missed), *_false(d.found)]
    return "\n".join(lines)


def maps_table(days: Mapping[int, Mapping[str, MapScore]], left: Mapping[str, int]) -> str:
    """Each level's map on some days and in the mean of them; `left` counts cells inside what vanished."""
    lines = [f"maps{'':22}{'precision':>11}{'recall':>8}{'ghosts m2':>11}{'in vanished':>13}"]
    for level, cells in left.items():
        scores = [day[level] for day in days.values()]
        rows = [(f"day {day}", score) for day, score in zip(days, scores, strict=True)]
        if len(rows) > 1:
            rows.append((f"mean of {', '.join(map(str, days))}", mean_score(scores)))
        for i, (when, score) in enumerate(rows):
            last = f"{cells:>13}" if i == len(rows) - 1 else ""
            lines.append(
                f"  {level:8}{when:16}{score.precision:>11.3f}{score.recall:>8.3f}{score.ghosts:>11.3f}{last}"
            )
    return "\n".join(lines)


def left_line(left: Mapping[str, int]) -> str:
    """Cells of each level's last map inside what vanished."""
    return "map cells inside vanished, adopted events: " + ", ".join(f"{k} {n}" for k, n in left.items())


def recordings_table(recordings: Sequence[Recorded]) -> str:
    """How many recordings of how many minutes."""
    minutes = sum(r.end_ns - r.start_ns for r in recordings) / 6e10
    return f"{len(recordings)} patrols, {minutes:.0f} minutes"


def _missed(places: Sequence[Place]) -> list[str]:
    return [f"    missed  {'/'.join(sorted(p.kinds)):18} {p.change.what:10} {at(p.bounds)}" for p in places]


def _false(found: Found) -> list[str]:
    again = found.again
    return [
        f"    {'again' if c in again else 'false':7} {c.kind:18} {c.event.name:10} {at(c.bounds)}"
        for c in found.false
    ]


def claim_line(claim: Claim) -> str:
    """One claim: kind, place and size [m], and the event that makes it."""
    x_min, y_min, x_max, y_max = claim.bounds
    size = f"{x_max - x_min:.2f} x {y_max - y_min:.2f}"
    return f"    {claim.kind:10} {at(claim.bounds)}  {size}  ({claim.event.name})"


def at(bounds: tuple[float, float, float, float]) -> str:
    """Bounds in words [m]: x, then y."""
    x_min, y_min, x_max, y_max = bounds
    return f"{x_min:6.2f}..{x_max:.2f}, {y_min:.2f}..{y_max:.2f}"


def _share(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"
