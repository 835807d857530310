"""Nodes that are given beforehand."""

import pytest

from timemap_cli.errors import UsageError
from timemap_cli.model.nodes import Node
from timemap_cli.results.given_nodes import read_nodes


@pytest.mark.parametrize(
    "text",
    [
        "x,y\n1.5,-2\n\n3,4\n",
        "1.5 -2\n3 4",
        " X , Y \n 1.5, -2.0\n3.0, 4.0001\n",
        "# surveyed in May\nx y\n1.5 -2 # the door\n#9 9\n3 4",
    ],
)
def test_places_are_read_from_lines(tmp_path, text):
    path = tmp_path / "nodes.csv"
    path.write_text(text)
    assert read_nodes(path, "map") == (Node(1.5, -2.0), Node(3.0, 4.0))


@pytest.mark.parametrize("line", ["1", "1,2,3", "a,b", "nan,1", "inf 2"])
def test_a_line_that_is_no_place_is_named(tmp_path, line):
    path = tmp_path / "nodes.csv"
    path.write_text(f"1,2\n{line}\n")
    with pytest.raises(UsageError, match=r"line 2: '.*' is not a place"):
        read_nodes(path, "map")


def test_two_nodes_at_one_place_are_refused_with_both_lines(tmp_path):
    path = tmp_path / "nodes.csv"
    path.write_text("x,y\n1,2\n3,4\n1.0001 2\n")
    with pytest.raises(UsageError, match="line 4: the node of line 2 stands there"):
        read_nodes(path, "map")


def test_a_missing_or_empty_file_is_an_error(tmp_path):
    with pytest.raises(UsageError, match="there is no file"):
        read_nodes(tmp_path / "nodes.csv", "map")
    (tmp_path / "nodes.csv").write_text("x,y\n")
    with pytest.raises(UsageError, match="holds no nodes"):
        read_nodes(tmp_path / "nodes.csv", "map")


def test_more_nodes_than_a_map_may_have_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("timemap_cli.results.given_nodes.MOST_NODES", 2)
    path = tmp_path / "nodes.csv"
    path.write_text("1,2\n3,4\n5,6\n")
    with pytest.raises(UsageError, match="holds 3 nodes, a map has 2 at most"):
        read_nodes(path, "map")
