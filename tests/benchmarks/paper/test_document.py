"""docs/paper.md: sections between markers."""

import pytest

from benchmarks.paper.document import document, markdown, plain
from benchmarks.paper.section import Figure, Scale, Section, Table

SECTION = Section(
    "Title", ("One.", "Two."), (Table(("", "a"), [("ours", "1")], "Head:"),), (Figure("f", "Cap.", print),)
)


def test_a_section_is_written_in_order():
    assert markdown(SECTION) == (
        "## Title\n\nOne.\n\nTwo.\n\nHead:\n\n|  | a |\n| --- | ---: |\n| ours | 1 |\n\n"
        "![Cap.](pictures/paper/f.svg)\n\n*Cap.*\n"
    )


def test_an_experiment_that_ran_replaces_its_own_section_and_no_other():
    old = document(("a", "b", "c"), "", {"a": "## A\n", "c": "## C\n"})
    new = document(("a", "b", "c"), old, {"b": "## B\n", "c": "## C2\n"})
    assert new == document(("a", "b", "c"), "", {"a": "## A\n", "b": "## B\n", "c": "## C2\n"})
    assert new.index("## A") < new.index("## B") < new.index("## C2")


def test_a_terminal_gets_aligned_columns():
    assert plain(SECTION).splitlines()[-3:] == ["Head:", "      a", "ours  1"]


def test_a_scale_picks_its_own_value():
    assert (Scale.full.pick(1, 2), Scale.quick.pick(1, 2)) == (1, 2)


def test_pictures_are_the_same_bytes_every_time():
    pytest.importorskip("matplotlib")
    from benchmarks.paper.pictures import svg

    figure = Figure("f", "", lambda canvas: canvas.subplots().plot([0, 1], [1, 0], label="x"))
    first = svg(figure)
    assert first == svg(figure)
    assert b"<dc:date>" not in first
