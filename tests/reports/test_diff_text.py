"""The comparison for people."""

from dataclasses import replace

from tests.reports.differences import APPEARED, MOVED, NEW, NOTHING_COMPARED, OLD, VANISHED, difference
from timemap_cli.changes.difference import Sector
from timemap_cli.reports.diff_text import diff_text


def test_table_reads_at_a_glance():
    told = diff_text(difference(VANISHED, MOVED, APPEARED, silent=(7,)), OLD, NEW)
    assert told == "\n".join(
        [
            "from  level long  at 2024-05-01T12:00:00Z     of house.timemap.mcap",
            "to    level mid   at 2024-05-01T12:00:00.25Z  of house.timemap.mcap",
            "",
            "3 changes: 1 appeared, 1 vanished, 1 moved (3 nodes, 770 angle bins compared; "
            "1 node known to one side only or not seen again).",
            "",
            "what      x, y [m]     size [m]     nodes  range at first [m]  support",
            "vanished  2.00, 0.00   0.05 x 0.60  1, 0   1.25 -> 4.50        0.81",
            "moved     5.00, 6.00   0.20 x 0.20  0      7.50 -> 7.75        0.70     "
            "by 1.00 m from 4.40, 6.80",
            "appeared  -4.00, 1.00  0.20 x 0.20  2      8.00 -> 7.00        0.60",
        ]
    )


def test_nothing_differs_is_said_with_how_much_was_compared():
    last = diff_text(difference(), OLD, NEW).splitlines()[-1]
    assert last == "Nothing differs: 3 nodes, 770 angle bins compared."


def test_nothing_compared_is_not_told_as_no_difference():
    last = diff_text(NOTHING_COMPARED, OLD, NEW).splitlines()[-1]
    assert last == (
        "Nothing could be compared: no node was seen for both sides; "
        "2 nodes known to one side only or not seen again."
    )


def test_clear_is_a_word_and_the_widest_view_comes_first():
    narrow = replace(VANISHED, sectors=(Sector(0, 351, 9, 2.0, float("inf")), Sector(1, 40, 44, 1.25, 4.5)))
    row = diff_text(difference(narrow), OLD, NEW).splitlines()[-1]
    assert "0, 1   2.00 -> clear" in row


def test_many_nodes_are_cut_short():
    sectors = tuple(Sector(node, 10, 20, 2.0, 3.0) for node in range(9))
    row = diff_text(difference(replace(VANISHED, sectors=sectors)), OLD, NEW).splitlines()[-1]
    assert "0, 1, 2, 3 and 5 more" in row
