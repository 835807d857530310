"""Figures of open halls, from claims by hand."""

from dataclasses import replace

from benchmarks.changes.places import claims, places_of_changes
from benchmarks.changes.scenes.hall import Told, table, together
from benchmarks.changes.scores import find
from tests.benchmarks.changes.making import change, event, square, truth

TABLE = change("moved", square(4, 0), (190, None), origin=square(0, 0))
SOFA = replace(change("moved", square(4, 8), (190, None), origin=square(0, 8)), what="sofa")
TRUTH = truth(TABLE, SOFA)


def told(*events) -> Told:
    return Told("changes", find(claims(events), places_of_changes(TRUTH), TRUTH), 0.125)


def test_a_piece_is_told_by_either_of_its_places_and_wholly_by_both():
    both = (event("appeared", (4, 0, 5, 1), 210), event("vanished", (0, 0, 1, 1), 210))
    assert told(*both).by_piece == [2, 0]
    assert told(*both, event("vanished", (0, 8, 1, 9), 210)).by_piece == [2, 1]
    assert told().by_piece == [0, 0]


def test_the_table_counts_pieces_places_and_others():
    one = told(event("vanished", (0, 0, 1, 1), 210), event("appeared", (20, 20, 21, 21), 210))
    header, line, refused, other = table([one, "diff: refused"]).splitlines()
    assert header.split() == ["pieces", "wholly", "places", "others", "compared"]
    assert line.split() == ["changes", "1/2", "0/2", "1/4", "1", "12.5%"]
    assert refused.split() == ["diff:", "refused"]
    assert other.split()[:3] == ["changes,", "other:", "appeared"]


def test_all_layouts_together_tell_the_worst_of_them():
    good = told(event("appeared", (4, 0, 5, 1), 210), event("vanished", (0, 0, 1, 1), 210))
    bad = told(event("vanished", (20, 20, 21, 21), 210))
    header, changes, refused = together([[good, "diff: refused"], [bad, "diff: refused"]]).splitlines()
    assert header.split() == ["all", "layouts", "pieces", "fewest", "wholly", "others", "most"]
    assert changes.split() == ["changes", "1", "0", "1", "1", "1"]
    assert refused.split() == ["diff:", "refused"]
