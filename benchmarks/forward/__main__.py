"""How many scans of a robot that drives forward are lost, and what the others claim: `python -m benchmarks.forward`."""

import click

from benchmarks.forward.drives import Place, Setup, driven, places, setups
from benchmarks.forward.truth import Score, score

COLUMNS = (
    "place", "degrees", "Hz", "laser ahead m", "pose error m", "scans", "nodes", "not seen", "learnt %", "known",
    "wrong hits", "wrong clear", "behind walls",
)  # fmt: skip


def row(place: str, setup: Setup | None, found: list[Score]) -> str:
    """A row of the table; known and wrong angle bins are those of one scan, lost or not."""
    scans, not_seen, judged = (
        sum(getattr(s, name) for s in found) for name in ("scans", "not_seen", "judged")
    )
    wrong = ("known", "wrong_hits", "wrong_clear")
    known, hits, clear = (sum(getattr(s, name) for s in found) / judged for name in wrong)
    of = (setup.degrees, setup.rate, setup.ahead, setup.error_m) if setup else ("",) * 4
    cells = (
        place, *of, scans, sum(s.nodes for s in found), not_seen, f"{100 * (1 - not_seen / scans):.2f}",
        f"{known:.1f}", f"{hits:.3f}", f"{clear:.3f}", sum(s.behind_walls for s in found),
    )  # fmt: skip
    return "| " + " | ".join(map(str, cells)) + " |"


@click.command()
def main() -> None:
    """Drive through all places with all scanners, and print what became of the scans."""
    click.echo("| " + " | ".join(COLUMNS) + " |")
    click.echo("|" + "---|" * len(COLUMNS))
    every: list[Score] = []
    for place in places():
        here = [_told(place, setup) for setup in setups()]
        click.echo(row(place.name, None, here))
        every += here
    click.echo(row("all", None, every))


def _told(place: Place, setup: Setup) -> Score:
    found = score(place, driven(place, setup))
    click.echo(row(place.name, setup, [found]))
    return found


if __name__ == "__main__":
    main()
